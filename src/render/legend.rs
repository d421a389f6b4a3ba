//! What the colours of a debug view mean. The colours are those of `debug_colors.wgsl`; a test compares the two.

use super::debug_view::DebugView;
use super::scene::height_range_m;
use crate::planet::Population;
use crate::planet::printable::number_text;
use crate::tiles::Surface;
use crate::world::RAIN_COLORS;

/// A colour, linear.
pub type Color = [f64; 3];

/// What the colours of a debug view mean.
#[derive(Clone, Debug, PartialEq)]
pub enum Legend {
    /// Colours at even distances from one value to another.
    Ramp {
        /// The colours, of the lowest value first.
        colors: Vec<Color>,
        /// The values at the ends, with their unit.
        ends: [String; 2],
    },
    /// Single colours.
    Marks(Vec<(Color, String)>),
}

/// Deep blue, teal, green, sand, brown, white.
const RAMP: [Color; 6] = [
    [0.01, 0.02, 0.12],
    [0.02, 0.22, 0.30],
    [0.06, 0.28, 0.08],
    [0.52, 0.44, 0.20],
    [0.26, 0.13, 0.07],
    [0.95, 0.95, 0.95],
];
const TEMPERATURE: [Color; 5] =
    [[0.05, 0.03, 0.35], [0.10, 0.40, 0.80], [0.85, 0.85, 0.85], [0.85, 0.40, 0.06], [0.35, 0.01, 0.02]];
const MOISTURE: [Color; 3] = [[0.75, 0.55, 0.25], [0.10, 0.45, 0.10], [0.01, 0.08, 0.55]];
const SPACING: [Color; 4] = [[0.03, 0.08, 0.60], [0.05, 0.50, 0.10], [0.80, 0.65, 0.05], [0.65, 0.02, 0.02]];

/// Dark violet, blue, teal, green, yellow.
const DENSITY: [Color; 6] = [
    [0.058, 0.001, 0.089],
    [0.053, 0.058, 0.242],
    [0.023, 0.188, 0.270],
    [0.016, 0.392, 0.231],
    [0.195, 0.638, 0.082],
    [0.982, 0.799, 0.019],
];

impl Legend {
    /// The legend of the density of a population: from none to the most on a hectare.
    pub fn of_density(population: &Population) -> Self {
        let most = number_text(population.per_hectare);
        Self::Ramp { colors: DENSITY.to_vec(), ends: ["none".to_owned(), format!("{most} on a hectare")] }
    }

    /// The legend of a debug view of a surface; None where the colours have no values. That of a density is
    /// [`Legend::of_density`].
    pub fn of(view: DebugView, surface: &Surface) -> Option<Self> {
        let ramp = |colors: &[Color], ends: [String; 2]| Some(Self::Ramp { colors: colors.to_vec(), ends });
        match view {
            DebugView::Height => {
                let (low_m, high_m) = height_range_m(surface);
                ramp(&RAMP, [format!("{low_m:.0} m"), format!("{high_m:.0} m")])
            }
            DebugView::Slope => ramp(&RAMP, ["0°".to_owned(), "60°".to_owned()]),
            DebugView::Temperature => ramp(&TEMPERATURE, ["-40 °C".to_owned(), "40 °C".to_owned()]),
            DebugView::Moisture => ramp(&MOISTURE, ["dry".to_owned(), "wet".to_owned()]),
            DebugView::Error => {
                let marks = SPACING.iter().zip([1, 4, 16, 64]);
                Some(Self::Marks(marks.map(|(color, px)| (*color, format!("{px} px"))).collect()))
            }
            DebugView::Rain => Some(Self::Marks(
                RAIN_COLORS.iter().map(|(mm, color)| (*color, format!("{mm:.0} mm a year"))).collect(),
            )),
            DebugView::Biome => {
                let palette = &surface.terrain.planet().biomes.palette;
                Some(Self::Marks(palette.iter().map(|biome| (biome.color, biome.name.clone())).collect()))
            }
            DebugView::Lod | DebugView::TileBorders | DebugView::Wireframe => {
                let mut levels: Vec<u8> = surface.leaves.iter().map(|leaf| leaf.tile.id.level).collect();
                levels.sort_unstable();
                levels.dedup();
                Some(Self::Marks(levels.iter().map(|level| (level_color(*level), format!("level {level}"))).collect()))
            }
            _ => None,
        }
    }
}

/// `level_color` of the shader.
fn level_color(level: u8) -> Color {
    let hue = (f64::from(level) * 0.381_966).fract();
    [0.0, 0.6667, 0.3333].map(|shift: f64| {
        let away = ((hue + shift).fract() * 6.0 - 3.0).abs() - 1.0;
        0.15 + 0.75 * away.clamp(0.0, 1.0)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The colours `vec3f(..)` in a function of the shader, in order.
    fn colors(function: &str) -> Vec<Color> {
        let text = include_str!("../../shaders/debug_colors.wgsl");
        let begin = text.find(&format!("fn {function}(")).unwrap();
        let body = &text[begin..begin + text[begin..].find("\n}\n").unwrap()];
        let literals = body.split("vec3f(").skip(1).map(|rest| rest.split(')').next().unwrap_or_default());
        let numbers = literals.map(|literal| literal.split(',').filter_map(|n| n.trim().parse().ok()).collect());
        let triple = |numbers: Vec<f64>| match numbers.as_slice() {
            [grey] => Some([*grey; 3]),
            [r, g, b] => Some([*r, *g, *b]),
            _ => None,
        };
        numbers.filter_map(triple).collect()
    }

    #[test]
    fn legends_have_the_colours_of_the_shader() {
        assert_eq!(colors("ramp"), RAMP);
        assert_eq!(colors("temperature_color"), TEMPERATURE);
        assert_eq!(colors("moisture_color"), MOISTURE);
        assert_eq!(colors("spacing_color"), SPACING);
        assert_eq!(colors("density_color"), DENSITY);
        assert!(level_color(0).iter().zip([0.9, 0.15, 0.15]).all(|(a, b): (&f64, f64)| (a - b).abs() < 1e-3));
    }
}
