//! A curve over the globe that keeps neighbours together: the order in which many points are best asked. Points that
//! follow each other along it share what is built around them, such as rivers.

use super::raster::cube_point;
use glam::DVec3;

/// Cells along the side of a face, a power of two. On a planet of the Earth's size they are some 150 m wide.
const SIDE: u32 = 1 << 16;

/// The place of a unit direction on the curve: face by face, along the Z-order curve of each (Morton 1966).
pub(crate) fn place(dir: DVec3) -> u64 {
    let (face, x, y) = cube_point(dir, SIDE as usize);
    let cell = |w: f64| (w as u32).min(SIDE - 1);
    (face as u64) << 32 | spread(cell(x)) | spread(cell(y)) << 1
}

/// The 16 bits of a number with a gap after each.
fn spread(number: u32) -> u64 {
    let mut bits = u64::from(number);
    for (shift, mask) in [(8, 0x00ff_00ff), (4, 0x0f0f_0f0f), (2, 0x3333_3333), (1, 0x5555_5555)] {
        bits = (bits | bits << shift) & mask;
    }
    bits
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sphere::raster::cube_direction;

    #[test]
    fn each_square_of_a_face_is_one_stretch_of_the_curve() {
        for (face, side) in [(0, 8), (3, 64), (5, 1)] {
            let mut stretches: Vec<u64> = (0..side * side)
                .map(|i| {
                    let at = |x: f64, y: f64| place(cube_direction(face, side, x, y));
                    let (x, y) = ((i % side) as f64, (i / side) as f64);
                    let length = (1_u64 << 32) / (side * side) as u64;
                    let found = [(0.1, 0.1), (0.9, 0.1), (0.5, 0.9)].map(|(dx, dy)| at(x + dx, y + dy) / length);
                    assert_eq!(found, [found[0]; 3]);
                    found[0]
                })
                .collect();
            stretches.sort_unstable();
            let first = (face * side * side) as u64;
            assert!(stretches.into_iter().eq(first..first + (side * side) as u64));
        }
    }

    #[test]
    fn edges_and_corners_of_faces_have_places() {
        for dir in [DVec3::X, -DVec3::Z, DVec3::ONE.normalize(), DVec3::new(1.0, -1.0, 0.0).normalize()] {
            assert!(place(dir) < 6 << 32);
        }
    }
}
