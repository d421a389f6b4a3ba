//! Painted climate: strokes that change moisture and temperature, and those that paint a biome by the climate that it
//! has in the biome table. Painted clouds: strokes that change the log-odds of their cover. Paint of the structure is
//! in `structural`.

use super::Subject;
use super::index::Hash;
use super::life::PopulationId;
use super::mask::MaskId;
use super::structural::StructurePaint;
use crate::planet::{Biomes, Key, Planet, Table, TableRows};

/// Log-odds by which a full stroke changes the cover of clouds: all but overcast from a sky that is all but clear.
pub(super) const CLOUD_ODDS: f64 = 10.0;

/// What paint makes of a number of the climate: of `x` at sea level and `less` by which it falls up to the surface it
/// makes `keep * x + add + (at_surface - 1) * less` at the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Tint {
    keep: f64,
    add: f64,
    /// Share of values that were set at the surface.
    at_surface: f64,
}

impl Tint {
    /// No paint.
    pub(crate) const NONE: Self = Self { keep: 1.0, add: 0.0, at_surface: 0.0 };

    fn shift(&mut self, by: f64) {
        self.add += by;
    }

    /// A share of the way to a value at the surface.
    fn set(&mut self, to: f64, share: f64) {
        let left = 1.0 - share;
        *self = Self {
            keep: self.keep * left,
            add: self.add * left + to * share,
            at_surface: self.at_surface * left + share,
        };
    }

    /// The number at the surface, from that without paint.
    pub(crate) fn at_surface(&self, surface: f64, less: f64) -> f64 {
        self.keep * surface + self.add + (self.keep + self.at_surface - 1.0) * less
    }

    /// The number at sea level from which the fall to the surface leads to the painted one.
    pub(crate) fn at_sea(&self, sea: f64, less: f64) -> f64 {
        self.keep * sea + self.add + self.at_surface * less
    }

    /// The share of the fall with height that is left.
    pub(crate) fn falls(&self) -> f64 {
        1.0 - self.at_surface
    }
}

/// The paint at a point: of temperature in °C and of moisture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Painted {
    pub(crate) temperature: Tint,
    pub(crate) moisture: Tint,
}

impl Painted {
    /// No paint.
    pub(crate) const NONE: Self = Self { temperature: Tint::NONE, moisture: Tint::NONE };
}

/// The climate of a biome in the table: moisture, and the temperature at the surface where rows are temperatures.
pub(super) type BiomePlace = (f64, Option<f64>);

/// What a stroke paints.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Paint {
    Moisture {
        value: f64,
        sets: bool,
    },
    Temperature {
        value_c: f64,
        sets: bool,
    },
    Biome {
        key: char,
        strength: f64,
    },
    /// Change of the log-odds of the cover.
    Clouds {
        odds: f64,
    },
    /// A share of the way to full paint of a mask, or if negative to none.
    Mask {
        mask: MaskId,
        amount: f64,
    },
    /// A share of the way to a share of the greatest density of a population, or of all.
    Life {
        population: Option<PopulationId>,
        density: f64,
    },
    /// Objects of a population, or of the first: factor on their height, clockwise turn, and the most that copies are
    /// turned besides.
    Object {
        population: Option<PopulationId>,
        size: f64,
        turns_rad: [f64; 2],
    },
    /// Amount of uplift in m, of hardness, of rain in mm.
    Structure(StructurePaint, f64),
    /// The course of a river of the structure.
    Course,
}

impl Paint {
    /// Adds the paint to a key, by the number of its kind. Files of world maps hold keys of masks and of the structure.
    pub(super) fn hash(&self, hash: &mut Hash) {
        let (number, name, numbers) = match *self {
            Self::Moisture { value, sets } => (20, None, [value, f64::from(u8::from(sets)), 0.0]),
            Self::Temperature { value_c, sets } => (21, None, [value_c, f64::from(u8::from(sets)), 0.0]),
            Self::Biome { key, strength } => (22, None, [strength, f64::from(u32::from(key)), 0.0]),
            Self::Clouds { odds } => (23, None, [odds, 0.0, 0.0]),
            Self::Structure(kind, amount) => (24 + kind as u64, None, [amount, 0.0, 0.0]),
            Self::Course => (27, None, [0.0; 3]),
            Self::Mask { mask: MaskId(name), amount } => (28, Some(name), [amount, 0.0, 0.0]),
            Self::Life { population, density } => (29, population.map(|of| of.0), [density, 0.0, 0.0]),
            Self::Object { population, size, turns_rad: [turn_rad, random_rad] } => {
                (30, population.map(|of| of.0), [size, turn_rad, random_rad])
            }
        };
        name.into_iter().flat_map(Key::words).for_each(|word| hash.add(word));
        hash.add(number);
        numbers.into_iter().chain([0.0]).for_each(|number| hash.add_f64(number));
    }

    /// The subject that it changes. None for the course of a river.
    pub(super) fn subject(&self) -> Option<Subject> {
        match self {
            Self::Moisture { .. } | Self::Temperature { .. } | Self::Biome { .. } => Some(Subject::Climate),
            Self::Clouds { .. } => Some(Subject::Clouds),
            Self::Mask { .. } => Some(Subject::Masks),
            Self::Life { .. } | Self::Object { .. } => Some(Subject::Life),
            Self::Structure(..) => Some(Subject::Structure),
            Self::Course => None,
        }
    }

    /// Paints the climate with a weight.
    pub(super) fn apply(&self, painted: &mut Painted, weight: f64, place_of: impl Fn(char) -> Option<BiomePlace>) {
        let paint = |tint: &mut Tint, value: f64, sets: bool| match sets {
            true => tint.set(value, weight),
            false => tint.shift(value * weight),
        };
        match *self {
            Self::Moisture { value, sets } => paint(&mut painted.moisture, value, sets),
            Self::Temperature { value_c, sets } => paint(&mut painted.temperature, value_c, sets),
            Self::Biome { key, strength } => {
                let Some((moisture, temperature_c)) = place_of(key) else { return };
                painted.moisture.set(moisture, weight * strength);
                if let Some(temperature_c) = temperature_c {
                    painted.temperature.set(temperature_c, weight * strength);
                }
            }
            _ => {}
        }
    }
}

/// The climates of the biomes that strokes paint.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Places {
    table: Option<Table>,
    /// What the columns and rows of the table mean, in bits.
    ends: [u64; 3],
    /// In the order of their keys.
    pub(super) places: Vec<(char, Option<BiomePlace>)>,
}

impl Places {
    /// Climates of these biomes of a planet. Their keys are in order. Equal tables share the earlier climates.
    pub(super) fn next(&self, planet: &Planet, keys: Vec<char>) -> Self {
        let biomes = &planet.biomes;
        let by_temperature = biomes.rows == TableRows::Temperature;
        let ends = [u64::from(by_temperature), biomes.coldest_c.to_bits(), biomes.hottest_c.to_bits()];
        let is_same = self.ends == ends && self.table.as_ref() == Some(&biomes.table);
        if is_same && self.places.iter().map(|(key, _)| *key).eq(keys.iter().copied()) {
            return self.clone();
        }
        let place = |key: char| {
            let (moisture, row) = inmost(biomes, key)?;
            let temperature_c = biomes.hottest_c + (biomes.coldest_c - biomes.hottest_c) * row;
            Some((moisture, by_temperature.then_some(temperature_c)))
        };
        let places = keys.into_iter().map(|key| (key, place(key))).collect();
        Self { table: Some(biomes.table.clone()), ends, places }
    }

    pub(super) fn of(&self, key: char) -> Option<BiomePlace> {
        let at = self.places.binary_search_by_key(&key, |(key, _)| *key).ok()?;
        self.places[at].1
    }
}

/// The place of the table that is farthest from all other biomes, as shares from the left and from the top: noise that
/// moves the borders leaves it to its biome. None if no cell has the biome. The table goes on beyond its edges.
fn inmost(biomes: &Biomes, key: char) -> Option<(f64, f64)> {
    let (columns, rows) = (biomes.table.columns(), biomes.table.rows().len());
    let cells = || (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row)));
    let (own, others): (Vec<_>, Vec<_>) =
        cells().partition(|(column, row)| biomes.table.key(*column, *row) == Some(key));
    let mut best: Option<(f64, f64, (f64, f64))> = None;
    for (column, row) in own {
        // The middle of the cell, and its sides on an edge of the table.
        let along = |at: usize, count: usize| {
            let middle = at as f64 + 0.5;
            let sides = [(at == 0).then_some(0.0), (at + 1 == count).then_some(count as f64)];
            std::iter::once(middle).chain(sides.into_iter().flatten())
        };
        for x in along(column, columns) {
            for y in along(row, rows) {
                let gap = |at: f64, cell: usize| (cell as f64 - at).max(at - cell as f64 - 1.0).max(0.0);
                let away = others.iter().map(|(c, r)| gap(x, *c).max(gap(y, *r))).fold(f64::MAX, f64::min);
                // Of equal ones, the one nearest to the middle of its cell.
                let off = (x - column as f64 - 0.5).abs() + (y - row as f64 - 0.5).abs();
                if best.is_none_or(|(most, least_off, _)| away > most || (away == most && off < least_off)) {
                    best = Some((away, off, (x / columns as f64, y / rows as f64)));
                }
            }
        }
    }
    best.map(|(_, _, place)| place)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paint_at_the_surface_and_paint_at_sea_level_agree() {
        let mut tint = Tint::NONE;
        assert_eq!((tint.at_surface(7.0, 3.0), tint.at_sea(10.0, 3.0)), (7.0, 10.0));
        tint.shift(2.0);
        tint.set(-5.0, 0.25);
        tint.shift(1.0);
        let surface = tint.at_surface(7.0, 3.0);
        assert!((surface - (0.75 * 9.0 - 0.25 * 5.0 + 1.0)).abs() < 1e-12, "{surface}");
        assert!((tint.at_sea(10.0, 3.0) - 3.0 - surface).abs() < 1e-12);
        assert_eq!(tint.falls(), 0.75);
    }

    #[test]
    fn a_biome_is_painted_by_the_place_farthest_from_all_others() {
        let mut biomes = Biomes { table: Table::uniform('a', 6, 4), ..Biomes::default() };
        assert_eq!(inmost(&biomes, 'b'), None);
        biomes.table.set_key(2, 1, 'b');
        assert_eq!(inmost(&biomes, 'b'), Some((2.5 / 6.0, 1.5 / 4.0)));
        for (column, row) in [(4, 0), (5, 0), (4, 1), (5, 1)] {
            biomes.table.set_key(column, row, 'b');
        }
        assert_eq!(inmost(&biomes, 'b'), Some((1.0, 0.0)), "the corner");
    }
}
