//! Populations that share a seed: their objects stand at like places and have like names.

use super::{Population, population_path};
use crate::planet::Planet;
use crate::planet::param::ParamPath;

/// A seed that no population of a list has: the wanted one, or the next that is free.
pub fn free_seed(life: &[Population], wanted: u32) -> u32 {
    let is_free = |seed: &u32| life.iter().all(|population| population.seed != *seed);
    // A list is shorter than the numbers are many.
    (0..=u32::MAX).map(|step| wanted.wrapping_add(step)).find(is_free).unwrap_or(wanted)
}

impl Planet {
    /// Populations that are on and have the seed of one before: the path of the seed, and what to do.
    pub fn life_doubts(&self) -> Vec<(ParamPath, String)> {
        let doubt = |(index, population): (usize, &Population)| {
            let is_same = |other: &&Population| other.enabled && other.seed == population.seed;
            let other = self.life[..index].iter().find(is_same).filter(|_| population.enabled)?;
            let (seed, free) = (population.seed, free_seed(&self.life, population.seed));
            let message = format!(
                "{seed} is the seed of {:?}, too: their objects share ids and may stand at the same places; use \
                another, such as {free}",
                other.name
            );
            Some((population_path(index).join("seed"), message))
        };
        self.life.iter().enumerate().filter_map(doubt).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::{random, shipped};

    #[test]
    fn equal_seeds_of_populations_that_are_on_are_told_with_a_free_one() {
        let of = |seed: u32, enabled: bool| Population { seed, enabled, ..Population::default() };
        let life = vec![of(7, true), of(8, true), of(7, true), of(7, false), of(u32::MAX, true), of(0, true)];
        let planet = Planet { life, ..Planet::default() };
        let doubts: Vec<String> = planet.life_doubts().iter().map(|(path, why)| format!("{path}: {why}")).collect();
        assert_eq!(doubts.len(), 1, "{doubts:?}");
        assert!(doubts[0].starts_with("life[2].seed: 7 is the seed of") && doubts[0].ends_with("such as 9"));
        assert_eq!((free_seed(&planet.life, u32::MAX), free_seed(&planet.life, 3)), (1, 3));
    }

    #[test]
    fn neither_shipped_nor_random_planets_have_equal_seeds() {
        for preset in shipped::ALL {
            assert_eq!(preset.load().unwrap().life_doubts(), [], "{}", preset.file);
        }
        for seed in 0..40 {
            assert_eq!(random::random(seed).life_doubts(), [], "{seed}");
        }
    }
}
