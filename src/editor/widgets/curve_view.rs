//! What the rows of curves show behind them: how often the planet has each of the numbers that a curve bends.

use crate::planet::param::{ParamPath, Segment};
use crate::sphere::spread;
use crate::terrain::{CurveInput, CurveInputs, Terrain};
use std::cell::Cell;
use std::f64::consts::PI;

/// Number of directions over the planet: the error of a column is about a tenth of its height.
const DIRECTIONS: usize = 4096;

/// What the curves of a planet bend.
pub fn inputs_of(terrain: &Terrain) -> CurveInputs {
    let dirs: Vec<_> = spread(DIRECTIONS).collect();
    terrain.curve_inputs(&dirs, (4.0 * PI / DIRECTIONS as f64).sqrt())
}

/// What the curves of the planet bend, and whether any is on screen.
#[derive(Default)]
pub struct CurveView<'a> {
    inputs: Option<&'a CurveInputs>,
    is_shown: Cell<bool>,
}

impl<'a> CurveView<'a> {
    /// For the newest inputs that are known.
    pub fn new(inputs: Option<&'a CurveInputs>) -> Self {
        Self { inputs, is_shown: Cell::new(false) }
    }

    /// What the curve of the parameter at `path` bends; None if that is not known.
    pub fn of(&self, path: &ParamPath) -> Option<&'a [CurveInput]> {
        let found = match path.segments() {
            [Segment::Field("height_curve")] => self.inputs.map(|inputs| &inputs.heights),
            [Segment::Field("layers"), Segment::Index(index), Segment::Field("curve")] => {
                self.inputs.and_then(|inputs| inputs.layers.get(*index))
            }
            _ => return None,
        };
        self.is_shown.set(true);
        found.map(Vec::as_slice)
    }

    /// Whether the row of a curve was shown whose inputs can be found.
    pub fn is_shown(&self) -> bool {
        self.is_shown.get()
    }
}

/// Shares of the inputs in columns of equal widths from `-span` to `span`, over that of the fullest column.
pub fn columns(inputs: &[CurveInput], span: f64, count: usize) -> Vec<f32> {
    let mut columns = vec![0.0; count];
    for input in inputs {
        let at = (0.5 + 0.5 * input.number / span) * count as f64;
        if at >= 0.0
            && let Some(column) = columns.get_mut(at as usize)
        {
            *column += input.weight;
        }
    }
    let most = columns.iter().copied().fold(0.0, f64::max);
    columns.into_iter().map(|share| if most > 0.0 { (share / most) as f32 } else { 0.0 }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_hold_weights_over_the_fullest_and_leave_out_what_is_beyond_the_axis() {
        let input = |number: f64, weight: f64| CurveInput { number, weight };
        let inputs = [input(-0.9, 1.0), input(-0.6, 1.0), input(0.1, 0.5), input(3.0, 9.0), input(-3.0, 9.0)];
        assert_eq!(columns(&inputs, 1.0, 4), [1.0, 0.0, 0.25, 0.0]);
        assert_eq!(columns(&[], 1.0, 2), [0.0, 0.0]);
    }

    #[test]
    fn rows_ask_for_the_curves_of_layers_and_of_the_height() {
        let known = CurveInputs { heights: vec![CurveInput { number: 5.0, weight: 1.0 }], layers: vec![Vec::new()] };
        let view = CurveView::new(Some(&known));
        let path = |segments: &[Segment]| ParamPath::from(segments.to_vec());
        assert!(view.of(&path(&[Segment::Field("rings"), Segment::Field("profile")])).is_none());
        assert!(!view.is_shown());
        let layer = |index| path(&[Segment::Field("layers"), Segment::Index(index), Segment::Field("curve")]);
        assert_eq!(view.of(&layer(0)).map(<[_]>::len), Some(0));
        assert_eq!(view.of(&layer(7)), None, "a layer that is newer than the survey");
        assert_eq!(view.of(&path(&[Segment::Field("height_curve")])).map(<[_]>::len), Some(1));
        assert!(view.is_shown());
    }
}
