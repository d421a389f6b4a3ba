//! The rivers, lakes and basins of a planet as a description: for maps, for placing towns and roads.

use super::Terrain;
use crate::sphere::LatLon;
use crate::world::carved::Carved;
use crate::world::drainage::{Basins, Drainage};
use crate::world::grid::{arc_rad, areas_sr, node};
use crate::world::rivers::CourseEnd;
use std::collections::BTreeMap;

/// The rivers, lakes and basins of a planet, on the finest grid that is solved. Smaller tributaries are not in it:
/// queries of points find them.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Rivers {
    /// The greatest discharge at the mouth first; of equal ones the lowest id.
    pub courses: Vec<Course>,
    /// The largest first; of equal ones the lowest id.
    pub lakes: Vec<Lake>,
    /// The greatest discharge first; of equal ones the lowest id.
    pub basins: Vec<Basin>,
}

/// A river from source to mouth. It follows the branch that carries most water; the others are rivers that join it.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Course {
    /// The id that [`super::River`] has along it.
    pub id: u64,
    /// From source to mouth: two or more. Beds never rise and the discharge never falls.
    pub points: Vec<CoursePoint>,
    /// What it flows into.
    pub mouth: Mouth,
    /// Length along the points.
    pub length_km: f64,
}

/// A point of a river's centre line.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct CoursePoint {
    /// The location.
    pub place: LatLon,
    /// Height of the bed above the reference sphere, without the layers over the structure. Across a lake it lies as
    /// far below the surface as the river is deep.
    pub height_m: f64,
    /// Width of the water; across a lake, that of the river that leaves it.
    pub width_m: f64,
    /// Water that flows by in a second.
    pub discharge_m3_s: f64,
}

/// What a river flows into.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mouth {
    /// The sea.
    Sea,
    /// The lake with this id. No river that is listed leaves it as a part of the same course.
    Lake(u32),
    /// The river with this id.
    River(u64),
    /// Dry ground, where all of it evaporates.
    Ground,
}

/// A lake.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Lake {
    /// The id that a sample in the lake has.
    pub id: u32,
    /// Height of the surface above the reference sphere.
    pub level_m: f64,
    /// Area of the surface.
    pub area_km2: f64,
    /// Where it overflows; none for an endorheic lake, from which water only evaporates.
    pub outlet: Option<LatLon>,
    /// Middles of the cells that it covers.
    pub cells: Vec<LatLon>,
}

impl Lake {
    /// Whether it has no outlet.
    pub fn is_endorheic(&self) -> bool {
        self.outlet.is_none()
    }
}

/// The land that drains to one mouth.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Basin {
    /// The id that a sample in the basin has.
    pub id: u32,
    /// Area of the land.
    pub area_km2: f64,
    /// Water that reaches the mouth in a second.
    pub discharge_m3_s: f64,
    /// Where its water leaves the land, or its lowest place if it has no outlet.
    pub mouth: LatLon,
    /// Whether it has no outlet to a sea.
    pub is_endorheic: bool,
}

impl Terrain {
    /// The rivers and basins that carry at least this much water at their mouths, and all lakes. Each river begins
    /// where it carries so much. Below 1 m³/s a river is a dry valley and never listed. Empty for a planet without a
    /// structure.
    pub fn rivers(&self, min_discharge_m3_s: f64) -> Rivers {
        let Some(carved) = self.world().carved.map() else { return Rivers::default() };
        let least_m3_s = min_discharge_m3_s.max(1.0);
        let radius_km = self.planet().radius_km;
        Rivers {
            courses: courses(carved, least_m3_s, radius_km),
            lakes: lakes(&carved.drainage, radius_km),
            basins: basins(&carved.drainage, carved.basins(), least_m3_s, radius_km),
        }
    }
}

fn courses(carved: &Carved, least_m3_s: f64, radius_km: f64) -> Vec<Course> {
    let found = carved.rivers.courses(least_m3_s).into_iter().map(|course| {
        let arcs_rad = course.points.windows(2).map(|pair| arc_rad(pair[0].dir, pair[1].dir));
        let length_km = arcs_rad.sum::<f64>() * radius_km;
        let mouth = match course.end {
            CourseEnd::Sea => Mouth::Sea,
            CourseEnd::Lake(lake) => Mouth::Lake(lake),
            CourseEnd::River(id) => Mouth::River(id),
            CourseEnd::Ground => Mouth::Ground,
        };
        let points = course.points.iter().map(|point| CoursePoint {
            place: LatLon::from_direction(point.dir),
            height_m: point.bed_m,
            width_m: point.width_m,
            discharge_m3_s: point.discharge_m3_s,
        });
        Course { id: course.id, points: points.collect(), mouth, length_km }
    });
    let mut courses: Vec<Course> = found.collect();
    let at_mouth = |course: &Course| course.points.last().map_or(0.0, |point| point.discharge_m3_s);
    courses.sort_by(|a, b| at_mouth(b).total_cmp(&at_mouth(a)).then(a.id.cmp(&b.id)));
    courses
}

fn lakes(drainage: &Drainage, radius_km: f64) -> Vec<Lake> {
    let place = |cell: usize| LatLon::from_direction(node(drainage.side, cell, drainage.seed));
    let mut cells = vec![Vec::new(); drainage.lakes.len()];
    for (cell, lake) in drainage.lake.iter().enumerate() {
        if let Some(cells) = lake.checked_sub(1).and_then(|index| cells.get_mut(index as usize)) {
            cells.push(place(cell));
        }
    }
    let all = (1..).zip(&drainage.lakes).zip(cells).map(|((id, lake), cells)| Lake {
        id,
        level_m: lake.level_m,
        area_km2: lake.area_sr * radius_km * radius_km,
        outlet: lake.outlet.map(|cell| place(cell as usize)),
        cells,
    });
    let mut lakes: Vec<Lake> = all.filter(|lake| !lake.cells.is_empty()).collect();
    lakes.sort_by(|a, b| b.area_km2.total_cmp(&a.area_km2).then(a.id.cmp(&b.id)));
    lakes
}

fn basins(drainage: &Drainage, basins: &Basins, least_m3_s: f64, radius_km: f64) -> Vec<Basin> {
    let mut areas = BTreeMap::new();
    for (basin, area_sr) in basins.all().zip(areas_sr(drainage.side)) {
        if let Some(basin) = basin {
            *areas.entry(basin).or_insert(0.0) += area_sr;
        }
    }
    let all = areas.into_iter().map(|(id, area_sr)| {
        let cell = id as usize;
        Basin {
            id,
            area_km2: area_sr * radius_km * radius_km,
            discharge_m3_s: f64::from(drainage.discharge_m3_s[cell]),
            mouth: LatLon::from_direction(node(drainage.side, cell, drainage.seed)),
            is_endorheic: drainage.receiver[cell] as usize == cell,
        }
    });
    let mut basins: Vec<Basin> = all.filter(|basin| basin.discharge_m3_s >= least_m3_s).collect();
    basins.sort_by(|a, b| b.discharge_m3_s.total_cmp(&a.discharge_m3_s).then(a.id.cmp(&b.id)));
    basins
}
