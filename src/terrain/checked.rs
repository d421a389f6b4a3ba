//! Queries that refuse a question without an answer: a direction that is none, slices of unequal length.

use super::Terrain;
use super::query::{Sample, Scratch, Wanted};
use glam::DVec3;
use thiserror::Error;

/// Why a query was refused. Nothing was written.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum InvalidQuery {
    /// A direction that is zero, infinite or NaN.
    #[error("direction {index} is {dir:?}: zero or not finite; use a vector of any other length")]
    Direction {
        /// Its place among those that were asked for.
        index: usize,
        /// The direction.
        dir: DVec3,
    },
    /// More or fewer directions than places for the answers.
    #[error("{directions} directions, but room for {answers} answers; give slices of one length")]
    Lengths {
        /// Number of directions.
        directions: usize,
        /// Number of answers.
        answers: usize,
    },
}

fn check(dirs_planet: &[DVec3], answers: usize) -> Result<(), InvalidQuery> {
    if dirs_planet.len() != answers {
        return Err(InvalidQuery::Lengths { directions: dirs_planet.len(), answers });
    }
    let is_none = |dir: &DVec3| !dir.is_finite() || *dir == DVec3::ZERO;
    match dirs_planet.iter().position(is_none) {
        Some(index) => Err(InvalidQuery::Direction { index, dir: dirs_planet[index] }),
        None => Ok(()),
    }
}

impl Terrain {
    /// [`Terrain::height_m`] of a direction that may be none.
    ///
    /// # Errors
    /// A direction that is zero, infinite or NaN.
    pub fn try_height_m(&self, dir_planet: DVec3) -> Result<f64, InvalidQuery> {
        check(&[dir_planet], 1).map(|()| self.height_m(dir_planet))
    }

    /// [`Terrain::heights_m`] of directions some of which may be none.
    ///
    /// # Errors
    /// The first direction that is zero, infinite or NaN.
    pub fn try_heights_m(&self, dirs_planet: &[DVec3]) -> Result<Vec<f64>, InvalidQuery> {
        check(dirs_planet, dirs_planet.len()).map(|()| self.heights_m(dirs_planet))
    }

    /// [`Terrain::height_m`] of many directions, on the calling thread and without allocating. `heights_m` has one
    /// number for each direction.
    ///
    /// # Errors
    /// Slices of unequal length; the first direction that is zero, infinite or NaN.
    pub fn heights_into(
        &self,
        dirs_planet: &[DVec3],
        heights_m: &mut [f64],
        scratch: &mut Scratch,
    ) -> Result<(), InvalidQuery> {
        check(dirs_planet, heights_m.len())?;
        self.heights_spaced_into(dirs_planet, 0.0, heights_m, scratch);
        Ok(())
    }

    /// [`Terrain::sample`] of a direction that may be none.
    ///
    /// # Errors
    /// A direction that is zero, infinite or NaN.
    pub fn try_sample(&self, dir_planet: DVec3) -> Result<Sample, InvalidQuery> {
        check(&[dir_planet], 1).map(|()| self.sample(dir_planet))
    }

    /// [`Terrain::samples`] of directions some of which may be none.
    ///
    /// # Errors
    /// The first direction that is zero, infinite or NaN.
    pub fn try_samples(&self, dirs_planet: &[DVec3], wanted: Wanted) -> Result<Vec<Sample>, InvalidQuery> {
        check(dirs_planet, dirs_planet.len()).map(|()| self.samples(dirs_planet, wanted))
    }

    /// As [`Terrain::samples`], on the calling thread and without allocating. `samples` has one for each direction.
    ///
    /// # Errors
    /// Slices of unequal length; the first direction that is zero, infinite or NaN.
    pub fn samples_into(
        &self,
        dirs_planet: &[DVec3],
        wanted: Wanted,
        samples: &mut [Sample],
        scratch: &mut Scratch,
    ) -> Result<(), InvalidQuery> {
        check(dirs_planet, samples.len())?;
        self.samples_spaced_into(dirs_planet, 0.0, wanted, samples, scratch);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::Planet;

    #[test]
    fn what_is_no_direction_and_slices_of_unequal_length_are_refused() {
        let text = r#"(version: 3, name: "Islet", radius_km: 40.0, layers: [(name: "Hills", shape: Fbm())])"#;
        let terrain = Terrain::try_new(Planet::from_text("islet.ron", text).unwrap().into()).unwrap();
        let scratch = &mut Scratch::default();
        for bad in [DVec3::ZERO, DVec3::new(0.0, f64::NAN, 1.0), DVec3::new(f64::INFINITY, 0.0, 0.0)] {
            assert!(terrain.try_height_m(bad).is_err() && terrain.try_sample(bad).is_err(), "{bad}");
            let dirs = [DVec3::X, bad];
            let (mut heights_m, mut samples) = ([7.0; 2], [Sample::default(); 2]);
            let refused = [
                terrain.try_heights_m(&dirs).unwrap_err(),
                terrain.try_samples(&dirs, Wanted::ALL).unwrap_err(),
                terrain.heights_into(&dirs, &mut heights_m, scratch).unwrap_err(),
                terrain.samples_into(&dirs, Wanted::ALL, &mut samples, scratch).unwrap_err(),
            ];
            assert!(refused.iter().all(|error| matches!(error, InvalidQuery::Direction { index: 1, .. })));
            assert_eq!((heights_m, samples), ([7.0; 2], [Sample::default(); 2]));
        }
        for answers in [0, 1, 3] {
            let wanted = InvalidQuery::Lengths { directions: 2, answers };
            let dirs = [DVec3::X, DVec3::Y];
            assert_eq!(terrain.heights_into(&dirs, &mut vec![0.0; answers], scratch), Err(wanted));
            let samples = &mut vec![Sample::default(); answers];
            assert_eq!(terrain.samples_into(&dirs, Wanted::HEIGHT, samples, scratch), Err(wanted));
        }
        // A direction may be as long or as short as numbers go.
        let dirs = [DVec3::X * 1e300, DVec3::X * 1e-300];
        assert_eq!(terrain.try_heights_m(&dirs), Ok(vec![terrain.height_m(DVec3::X); 2]));
        let told = InvalidQuery::Lengths { directions: 2, answers: 3 }.to_string();
        assert_eq!(told, "2 directions, but room for 3 answers; give slices of one length");
    }
}
