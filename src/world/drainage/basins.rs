//! Basins: the land that drains to one mouth, or to one bottom without an outlet.

use super::Drainage;

/// The number of a cell that lies in no basin: in the sea.
const NONE: u32 = u32::MAX;

/// The basin of each cell of a drainage.
pub(crate) struct Basins(Vec<u32>);

impl Basins {
    pub(crate) fn new(drainage: &Drainage) -> Self {
        let Drainage { receiver, is_sea, order, .. } = drainage;
        let mut basin = vec![NONE; receiver.len()];
        // Each cell comes after its receiver.
        for &cell in order {
            let to = receiver[cell as usize];
            basin[cell as usize] = if to == cell || is_sea[to as usize] { cell } else { basin[to as usize] };
        }
        Self(basin)
    }

    /// The last land cell on the way of the water of a cell; none in the sea.
    pub(crate) fn of(&self, cell: usize) -> Option<u32> {
        self.0.get(cell).copied().filter(|basin| *basin != NONE)
    }

    /// The basins of all cells.
    pub(crate) fn all(&self) -> impl Iterator<Item = Option<u32>> + '_ {
        self.0.iter().map(|basin| Some(*basin).filter(|basin| *basin != NONE))
    }
}
