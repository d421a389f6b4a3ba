//! The layers of a random planet: which landforms suit a world, and how they build on each other.
//!
//! Each kind of world has a base, mountains where the base allows them, its own landforms (dunes, canyons, ice,
//! craters), and hills everywhere. Sizes that scale with the planet are shares of its radius. Sizes that depend on
//! gravity and weather are kilometres.

use super::Kind;
use super::dice::{Dice, three_digits};
use crate::planet::{
    Billow, Canyons, CellStyle, Cells, Continents, Craters, Damped, Dunes, Fbm, Gullies, HeightMask, LatitudeMask,
    Layer, LayerMask, Mask, Ridged, Shape, Terraces, Warped,
};

/// The layers of a kind of world. With a sea, its coasts are at height 0.
pub(super) fn layers(kind: Kind, sea: bool, radius_km: f64, dice: &mut Dice) -> Vec<Layer> {
    let relief = steepness(radius_km) * dice.between(0.75, 1.3);
    let mut lands = Lands { dice, radius_km, relief, layers: Vec::new() };
    match kind {
        Kind::Cold => lands.ice(),
        Kind::Bare => lands.moon(),
        _ if sea => lands.continents(),
        _ => lands.desert(),
    }
    lands.layers
}

/// Heights relative to those of a planet of the Earth's size: mountains are higher on smaller planets, up to a limit.
pub(super) fn steepness(radius_km: f64) -> f64 {
    libm::pow(6371.0 / radius_km, 0.3)
}

/// The layers over a structure.
pub(super) fn detail(radius_km: f64, dice: &mut Dice) -> Vec<Layer> {
    let mut lands = Lands { dice, radius_km, relief: 1.0, layers: Vec::new() };
    let (wavelength_km, height_m) = (lands.km(36.0, 60.0), lands.metres(200.0, 420.0));
    let ridges = Ridged { wavelength_km, octaves: 7, gain: 0.45, ..Ridged::default() };
    let (low_m, high_m) = (lands.metres(60.0, 150.0), lands.metres(400.0, 800.0));
    let layer = lands.add("Fold ridges", height_m, Shape::Ridged(ridges));
    (layer.bias, layer.folding, layer.masks) = (0.3, 3.5, vec![where_height(low_m, high_m)]);
    lands.hills(6.0, 12.0, 35.0, 70.0);
    lands.layers
}

struct Lands<'a> {
    dice: &'a mut Dice,
    radius_km: f64,
    /// Heights relative to an average world.
    relief: f64,
    layers: Vec<Layer>,
}

/// A mask by another layer's noise, between two of its values.
fn where_layer(layer: &str, from: f64, to: f64) -> Mask {
    Mask::Layer(LayerMask { layer: layer.to_owned(), from, to, invert: false })
}

fn where_height(from_m: f64, to_m: f64) -> Mask {
    Mask::Height(HeightMask { from_m: three_digits(from_m), to_m: three_digits(to_m), invert: false })
}

fn where_latitude(from_deg: f64, to_deg: f64) -> Mask {
    Mask::Latitude(LatitudeMask { from_deg, to_deg, both: true, invert: false })
}

impl Lands<'_> {
    /// A size that scales with the planet.
    fn across(&mut self, low: f64, high: f64) -> f64 {
        three_digits(self.radius_km * self.dice.between(low, high))
    }

    /// A size in kilometres, limited on planets that are too small for it.
    fn km(&mut self, low: f64, high: f64) -> f64 {
        let most = self.radius_km * 0.1;
        three_digits(self.dice.rounded_log(low, high).min(most))
    }

    fn metres(&mut self, low: f64, high: f64) -> f64 {
        three_digits(self.relief * self.dice.between(low, high))
    }

    fn share(&mut self, low: f64, high: f64) -> f64 {
        self.dice.rounded(low, high)
    }

    fn add(&mut self, name: &str, amplitude_m: f64, shape: Shape) -> &mut Layer {
        let layer = Layer { name: name.to_owned(), seed: self.dice.seed(), amplitude_m, shape, ..Layer::default() };
        let at = self.layers.len();
        self.layers.push(layer);
        &mut self.layers[at]
    }

    /// A layer that serves only as a mask.
    fn hide(&mut self, name: &str, shape: Shape) {
        self.add(name, 1000.0, shape).enabled = false;
    }

    /// A wet world: continents or islands with shelves, mountain chains, and erosion.
    fn continents(&mut self) {
        let islands = self.dice.chance(0.25);
        let shape = Continents {
            wavelength_km: if islands { self.across(0.3, 0.5) } else { self.across(0.8, 1.3) },
            octaves: 10,
            gain: self.share(0.54, 0.6),
            warp: self.share(0.2, 0.45),
            land: if islands { self.share(0.06, 0.16) } else { self.share(0.25, 0.5) },
            shelf: self.share(0.1, 0.3),
            ..Continents::default()
        };
        let depth_m = self.metres(3600.0, 5200.0);
        // Most land is low.
        self.add("Continents", depth_m, Shape::Continents(shape)).curve =
            vec![[-1.0, -1.0], [-0.05, -0.04], [0.0, 0.0], [0.06, 0.03], [0.2, 0.09], [0.5, 0.19], [1.0, 0.36]];
        self.chains("Continents", -0.08, 0.12);
        if islands || self.dice.chance(0.3) {
            self.volcanoes(60.0, 120.0, 4000.0, 6500.0);
        }
        let sea_floor = Ridged { wavelength_km: self.across(0.12, 0.25), octaves: 5, ..Ridged::default() };
        let height_m = self.metres(500.0, 1000.0);
        self.add("Sea floor", height_m, Shape::Ridged(sea_floor)).masks = vec![where_layer("Continents", -0.3, -0.8)];
        self.uplands("Continents", 0.0, 0.2);
        if self.dice.chance(0.6) {
            self.canyons(80.0, 160.0, 500.0, 900.0, vec![where_height(150.0, 600.0), where_layer("Chains", 0.1, -0.2)]);
        }
        if self.dice.chance(0.6) {
            let belt = vec![
                where_latitude(12.0, 17.0),
                where_latitude(36.0, 30.0),
                where_layer("Continents", 0.01, 0.05),
                where_layer("Chains", -0.1, -0.4),
            ];
            self.dunes(0.8, 1.6, belt);
        }
        self.hills(8.0, 16.0, 90.0, 160.0);
    }

    /// A dry world: basins and swells, volcanoes, canyons between mesas, sand in the lowlands.
    fn desert(&mut self) {
        let base_m = self.metres(2200.0, 3600.0);
        match self.dice.pick(&[0, 1, 2]) {
            0 => {
                let (wavelength_km, warp, land) =
                    (self.across(1.2, 2.0), self.share(0.15, 0.35), self.share(0.35, 0.6));
                let shape = Continents { wavelength_km, octaves: 8, gain: 0.48, warp, land, ..Continents::default() };
                self.add("Basins", base_m, Shape::Continents(shape)).curve =
                    vec![[-1.0, -0.8], [-0.8, -0.7], [-0.05, 0.1], [0.06, 0.5], [0.2, 0.7], [0.5, 0.85], [1.0, 1.1]];
            }
            1 => {
                let (wavelength_km, warp_km) = (self.across(0.5, 0.9), self.across(0.12, 0.3));
                let warp_wavelength_km = self.across(0.3, 0.6);
                let shape =
                    Warped { wavelength_km, octaves: 10, gain: 0.46, warp_km, warp_wavelength_km, ..Warped::default() };
                self.add("Basins", base_m, Shape::Warped(shape));
            }
            _ => {
                let cells = Cells {
                    cell_km: self.across(0.25, 0.5),
                    width: self.share(0.15, 0.35),
                    octaves: 2,
                    gain: 0.4,
                    ..Cells::default()
                };
                self.add("Basins", three_digits(base_m * 0.7), Shape::Cells(cells));
                let (wavelength_km, height_m) = (self.across(0.4, 0.8), self.metres(800.0, 1500.0));
                self.add(
                    "Swell",
                    height_m,
                    Shape::Fbm(Fbm { wavelength_km, octaves: 8, gain: 0.45, ..Fbm::default() }),
                );
            }
        }
        let volcanoes = self.dice.chance(0.65);
        if volcanoes {
            let (low, high) = (self.radius_km * 0.12, self.radius_km * 0.28);
            self.volcanoes(low, high, 5000.0, 11_000.0);
        }
        if self.dice.chance(0.5) {
            self.old_craters(0.02, 0.05, 1500.0, 3000.0, Vec::new());
        }
        self.chains("Basins", -0.2, 0.3);
        let wall = vec![where_layer("Chains", 0.3, 0.0)];
        let (low, high) = (self.radius_km * 0.06, self.radius_km * 0.2);
        self.canyons(low, high, 1200.0, 3200.0, wall);
        let (wavelength_km, step_m) = (self.km(10.0, 30.0), self.metres(120.0, 320.0));
        let terraces = Terraces {
            sharpness: self.share(0.6, 0.9),
            waviness: self.share(0.5, 1.5),
            wavelength_km,
            ..Terraces::default()
        };
        self.add("Mesas", step_m, Shape::Terraces(terraces)).masks = vec![where_layer("Canyons", 0.0, -0.12)];
        let low = vec![
            where_layer("Chains", -0.1, -0.4),
            where_layer("Canyons", -0.15, 0.0),
            where_layer("Basins", 0.15, -0.15),
        ];
        self.dunes(1.0, 2.4, low);
        self.hills(8.0, 18.0, 70.0, 140.0);
    }

    /// A world of ice: domes, plates between cracks, peaks above the ice, drifted snow.
    fn ice(&mut self) {
        let shape = Continents {
            wavelength_km: self.across(0.6, 1.1),
            octaves: 9,
            gain: self.share(0.52, 0.58),
            land: self.share(0.4, 0.7),
            shelf: 0.3,
            ..Continents::default()
        };
        let depth_m = self.metres(1800.0, 2800.0);
        self.add("Shields", depth_m, Shape::Continents(shape)).curve =
            vec![[-1.0, -0.8], [0.0, 0.0], [0.2, 0.22], [0.5, 0.4], [1.0, 0.65]];
        let (wavelength_km, height_m) = (self.km(70.0, 150.0), self.metres(250.0, 450.0));
        let domes = Billow { wavelength_km, octaves: 7, gain: self.share(0.38, 0.45), ..Billow::default() };
        self.add("Domes", height_m, Shape::Billow(domes)).masks = vec![where_layer("Shields", -0.02, 0.1)];
        if self.dice.chance(0.4) {
            let plates = Cells {
                cell_km: self.across(0.06, 0.14),
                width: self.share(0.08, 0.2),
                octaves: 2,
                gain: 0.35,
                ..Cells::default()
            };
            let height_m = self.metres(250.0, 600.0);
            self.add("Plates", height_m, Shape::Cells(plates));
        }
        let cracks = Cells {
            cell_km: self.across(0.15, 0.35),
            style: CellStyle::Cracks,
            width: self.share(0.04, 0.08),
            octaves: 3,
            gain: 0.6,
            lacunarity: self.share(2.2, 3.0),
            ..Cells::default()
        };
        let height_m = self.metres(1000.0, 2200.0);
        // A rim on either side, as of ice that was pushed up.
        self.add("Cracks", height_m, Shape::Cells(cracks)).curve =
            vec![[-1.0, -1.0], [-0.6, -0.5], [-0.25, 0.25], [0.0, 0.0]];
        self.chains("Shields", 0.0, 0.1);
        let (wavelength_km, height_m) = (self.km(8.0, 18.0), self.metres(100.0, 180.0));
        let ridges = Ridged { wavelength_km, octaves: 6, gain: 0.45, feedback: 2.6, ..Ridged::default() };
        self.add("Pressure ridges", height_m, Shape::Ridged(ridges)).bias = 0.5;
        let snow = Dunes {
            wavelength_km: self.km(0.03, 0.08),
            octaves: 1,
            wind_deg: self.share(0.0, 180.0),
            waviness: 0.9,
            ..Dunes::default()
        };
        self.add("Sastrugi", 1.5, Shape::Dunes(snow));
        self.hills(5.0, 9.0, 40.0, 80.0);
    }

    /// A world without air: maria, highlands, and craters of all sizes and ages on both.
    fn moon(&mut self) {
        let maria = Fbm { wavelength_km: self.across(1.0, 1.8), octaves: 8, gain: 0.45, ..Fbm::default() };
        let height_m = self.metres(2800.0, 4200.0);
        self.add("Maria", height_m, Shape::Fbm(maria)).curve =
            vec![[-1.0, -0.45], [-0.4, -0.38], [-0.24, -0.33], [-0.1, -0.02], [0.3, 0.2], [1.0, 0.6]];
        let (wavelength_km, height_m) = (self.across(0.06, 0.12), self.metres(500.0, 900.0));
        let damping = self.share(0.05, 0.2);
        let highlands = Damped { wavelength_km, octaves: 9, damping, ..Damped::default() };
        self.add("Highlands", height_m, Shape::Damped(highlands)).masks = vec![where_layer("Maria", -0.24, -0.05)];
        if self.dice.chance(0.35) {
            let rilles = Cells {
                cell_km: self.across(0.2, 0.5),
                style: CellStyle::Cracks,
                width: self.share(0.01, 0.03),
                octaves: 2,
                ..Cells::default()
            };
            let height_m = self.metres(500.0, 1200.0);
            self.add("Rilles", height_m, Shape::Cells(rilles));
        }
        self.old_craters(0.1, 0.25, 4500.0, 7500.0, vec![where_layer("Maria", -0.5, -0.1)]);
        let (diameter_km, height_m) = (self.across(0.012, 0.03), self.metres(1400.0, 2600.0));
        let craters = Craters {
            diameter_km,
            octaves: 5,
            density: self.share(0.4, 0.7),
            power: self.share(2.0, 2.6),
            age: self.share(0.7, 0.95),
            fresh: self.share(0.1, 0.2),
            ..Craters::default()
        };
        self.add("Craters", height_m, Shape::Craters(craters));
        let pits = Craters {
            diameter_km: self.km(0.4, 0.8),
            octaves: 4,
            power: 2.0,
            floor: 0.0,
            peak: 0.0,
            age: 0.9,
            ..Craters::default()
        };
        self.add("Pits", 90.0, Shape::Craters(pits));
        self.hills(6.0, 12.0, 35.0, 60.0);
    }

    /// A hidden layer with the regions of mountains, which other layers mask by, too, and the mountains: chains carved
    /// by water, or rough peaks.
    fn chains(&mut self, base: &str, from: f64, to: f64) {
        let (wavelength_km, gain) = (self.across(0.3, 0.5), self.share(0.38, 0.45));
        let chains = Ridged { wavelength_km, octaves: 4, gain, feedback: 1.6, ..Ridged::default() };
        let height_m = self.metres(1400.0, 2400.0);
        let layer = self.add("Chains", height_m, Shape::Ridged(chains));
        layer.curve = vec![[-1.0, 0.0], [-0.25, 0.0], [0.1, 0.15], [0.6, 0.8], [1.0, 1.1]];
        layer.masks = vec![where_layer(base, from, to)];
        let masks = vec![where_layer("Chains", -0.1, 0.6), where_layer(base, from, to)];
        let wavelength_km = self.km(28.0, 48.0);
        let height_m = self.metres(2200.0, 3600.0);
        let shape = match self.dice.pick(&[0, 0, 0, 1]) {
            0 => Shape::Gullies(Gullies {
                wavelength_km,
                octaves: 3,
                gully_km: three_digits(wavelength_km / 4.5),
                gully_octaves: 4,
                depth: self.share(0.9, 1.4),
                ..Gullies::default()
            }),
            _ => {
                Shape::Damped(Damped { wavelength_km, octaves: 9, damping: self.share(0.1, 0.3), ..Damped::default() })
            }
        };
        let layer = self.add("Mountains", height_m, shape);
        (layer.bias, layer.masks) = (0.65, masks);
    }

    /// Shield volcanoes with a crater on top, in the regions of a hidden layer.
    fn volcanoes(&mut self, low_km: f64, high_km: f64, low_m: f64, high_m: f64) {
        let hot_spots = Ridged { wavelength_km: self.across(0.4, 0.8), octaves: 3, gain: 0.4, ..Ridged::default() };
        self.hide("Hot spots", Shape::Ridged(hot_spots));
        let (cell_km, height_m) = (three_digits(self.dice.between(low_km, high_km)), self.metres(low_m, high_m));
        let shields = Cells { cell_km, style: CellStyle::Bumps, ..Cells::default() };
        let layer = self.add("Volcanoes", height_m, Shape::Cells(shields));
        layer.curve = vec![[0.0, 0.0], [0.4, 0.1], [0.7, 0.42], [0.92, 1.0], [0.95, 0.98], [1.0, 0.86]];
        layer.masks = vec![where_layer("Hot spots", 0.1, 0.7)];
    }

    /// Rolling ground of one landform or another.
    fn uplands(&mut self, base: &str, from: f64, to: f64) {
        let wavelength_km = self.km(60.0, 160.0);
        let shape = match self.dice.pick(&[0, 0, 1, 2]) {
            0 => {
                Shape::Damped(Damped { wavelength_km, octaves: 8, damping: self.share(0.1, 0.3), ..Damped::default() })
            }
            1 => Shape::Billow(Billow { wavelength_km, octaves: 8, ..Billow::default() }),
            _ => Shape::Warped(Warped {
                wavelength_km,
                octaves: 8,
                gain: 0.46,
                warp_km: three_digits(wavelength_km * 0.3),
                warp_wavelength_km: wavelength_km,
                warp_octaves: 2,
                ..Warped::default()
            }),
        };
        let height_m = self.metres(350.0, 600.0);
        let layer = self.add("Uplands", height_m, shape);
        (layer.bias, layer.masks) = (0.35, vec![where_layer(base, from, to)]);
    }

    fn canyons(&mut self, low_km: f64, high_km: f64, low_m: f64, high_m: f64, masks: Vec<Mask>) {
        let wavelength_km = three_digits(self.dice.between(low_km, high_km).min(self.radius_km * 0.2));
        let canyons = Canyons {
            wavelength_km,
            octaves: 3,
            gain: self.share(0.5, 0.65),
            width_km: three_digits(wavelength_km * self.dice.between(0.05, 0.09)),
            steepness: self.share(0.25, 0.5),
            meander: self.share(0.4, 0.9),
            ..Canyons::default()
        };
        let depth_m = self.metres(low_m, high_m);
        self.add("Canyons", depth_m, Shape::Canyons(canyons)).masks = masks;
    }

    fn dunes(&mut self, low_km: f64, high_km: f64, masks: Vec<Mask>) {
        let wavelength_km = self.km(low_km, high_km);
        let dunes = Dunes {
            wavelength_km,
            wind_deg: self.share(0.0, 359.0),
            asymmetry: self.share(0.6, 0.9),
            waviness: self.share(0.4, 0.9),
            ..Dunes::default()
        };
        // Sand is never steeper than about 33°.
        let layer = self.add("Dunes", three_digits(wavelength_km * 38.0), Shape::Dunes(dunes));
        (layer.bias, layer.masks) = (0.4, masks);
    }

    /// The largest craters, some of them nearly eroded.
    fn old_craters(&mut self, low: f64, high: f64, low_m: f64, high_m: f64, masks: Vec<Mask>) {
        let craters = Craters {
            diameter_km: self.across(low, high),
            octaves: 4,
            gain: self.share(0.55, 0.62),
            density: self.share(0.3, 0.6),
            power: self.share(1.8, 2.2),
            floor: self.share(0.5, 0.7),
            peak: self.share(0.1, 0.4),
            age: self.share(0.7, 0.9),
            fresh: self.share(0.05, 0.15),
            ..Craters::default()
        };
        let depth_m = self.metres(low_m, high_m);
        self.add("Old craters", depth_m, Shape::Craters(craters)).masks = masks;
    }

    fn hills(&mut self, low_km: f64, high_km: f64, low_m: f64, high_m: f64) {
        let (wavelength_km, gain) = (self.km(low_km, high_km), self.share(0.44, 0.5));
        let height_m = self.metres(low_m, high_m);
        self.add("Hills", height_m, Shape::Fbm(Fbm { wavelength_km, octaves: 12, gain, ..Fbm::default() }));
    }
}
