//! Rivers on disk: what evaluation reads of them, without what only a finer grid would be solved from.

use super::route::Routes;
use super::{Drainage, Lake};
use crate::world::bytes::{Reader, Writer};
use crate::world::cells::Cells;

/// Stands for a receiver that is the cell itself; else the place in the list of neighbours.
const ITSELF: u8 = 8;
/// Stands for a cell in the sea.
const SEA: u8 = 9;

const NO_OUTLET: u32 = u32::MAX;

impl Drainage {
    /// Writes what [`Drainage::read`] needs: about 9 bytes a cell on land, 5 in the sea.
    pub(crate) fn write(&self, to: &mut Writer) {
        let cells = Cells::of(self.side);
        let count = self.receiver.len();
        let way = |cell: usize| {
            if self.is_sea[cell] {
                return SEA;
            }
            let receiver = self.receiver[cell];
            (0_u8..).zip(cells.around(cell)).find(|(_, other)| *other == receiver).map_or(ITSELF, |(k, _)| k)
        };
        to.u32(self.seed);
        to.bytes((0..count).map(way));
        to.f32s(self.height_m.iter().copied());
        to.f32s((0..count).filter(|&cell| !self.is_sea[cell]).map(|cell| self.discharge_m3_s[cell]));
        // Few cells of the sea have a river, and few cells of land a lake.
        let mouths: Vec<usize> =
            (0..count).filter(|&cell| self.is_sea[cell] && self.discharge_m3_s[cell] != 0.0).collect();
        to.u32(mouths.len() as u32);
        for cell in mouths {
            to.u32(cell as u32);
            to.f32s([self.discharge_m3_s[cell]]);
        }
        to.u32(self.lakes.len() as u32);
        for lake in &self.lakes {
            to.f64s([lake.level_m, lake.area_sr]);
            to.u32(lake.outlet.unwrap_or(NO_OUTLET));
        }
        let under_lakes = || (0..count).filter(|&cell| self.lake[cell] != 0);
        to.u32(under_lakes().count() as u32);
        for cell in under_lakes() {
            to.u32(cell as u32);
            to.u32(self.lake[cell]);
        }
    }

    /// Rivers on a grid that were written.
    pub(crate) fn read(side: usize, from: &mut Reader<'_>) -> Option<Self> {
        let cells = Cells::of(side);
        let count = 6 * side * side;
        let seed = from.u32()?;
        let ways = from.bytes(count)?;
        let is_sea: Vec<bool> = ways.iter().map(|way| *way == SEA).collect();
        let to = |(cell, way): (usize, &u8)| match *way {
            SEA | ITSELF => Some(cell as u32),
            way => cells.around(cell).get(usize::from(way)).copied(),
        };
        let receiver = ways.iter().enumerate().map(to).collect::<Option<Vec<u32>>>()?;
        let land: Vec<u32> = (0..count).filter(|&cell| !is_sea[cell]).map(|cell| cell as u32).collect();
        let height_m = from.f32s(count)?;
        let mut discharge_m3_s = vec![0.0; count];
        for (&cell, value) in land.iter().zip(from.f32s(land.len())?) {
            discharge_m3_s[cell as usize] = value;
        }
        for _ in 0..from.u32()? {
            let (cell, value) = (from.u32()?, *from.f32s(1)?.first()?);
            *discharge_m3_s.get_mut(cell as usize)? = value;
        }
        let is_cell = |cell: &u32| (*cell as usize) < count;
        let mut lakes = Vec::new();
        for _ in 0..from.u32()? {
            let &[level_m, area_sr] = from.f64s(2)?.as_slice() else { return None };
            let outlet = Some(from.u32()?).filter(|outlet| *outlet != NO_OUTLET);
            outlet.is_none_or(|outlet| is_cell(&outlet)).then_some(())?;
            lakes.push(Lake { level_m, outlet, area_sr });
        }
        let mut lake = vec![0; count];
        for _ in 0..from.u32()? {
            let (cell, number) = (from.u32()?, from.u32()?);
            *lake.get_mut(cell as usize)? = Some(number).filter(|number| *number as usize <= lakes.len())?;
        }
        let Routes { receiver, order, .. } = Routes::ordered(receiver, &land, &is_sea);
        // Every way must end: a ring of cells has no outlet.
        let is_whole = order.len() == land.len();
        is_whole.then(|| Self {
            side,
            seed,
            height_m,
            receiver,
            discharge_m3_s,
            lake,
            lakes,
            is_sea,
            order,
            ..Self::default()
        })
    }
}
