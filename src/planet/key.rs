//! Content keys: equal content has equal keys, in every process and on every machine.

use super::Planet;
use std::fmt::{self, Write as _};

/// A 128-bit hash of compiled content.
///
/// The hash reads what `Debug` prints. Compiled types derive `Debug`, so a field added to one is part of its keys, and
/// the digits printed for an `f64` name it exactly. A type that prints less than it holds must print a hash of the rest
/// (pictures do).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Key(u128);

impl Key {
    /// The key of some content.
    pub fn of(content: &(impl fmt::Debug + ?Sized)) -> Self {
        let mut hash = Fnv(OFFSET_BASIS);
        // Hashing never fails, and derived `Debug` fails only where its writer does.
        let _ = write!(hash, "{content:?}");
        Self(hash.0)
    }

    /// The key of everything in a preset but the editor's own section, with the pixels of its pictures and texture sets
    /// and the triangles of its meshes. The same on every machine, wherever the preset is.
    pub fn of_planet(planet: &Planet) -> Self {
        let bare = Planet { editor: None, ..planet.clone() };
        let pictures: Vec<_> = bare.pictures().map(|(_, file, extent)| file.picture(extent)).collect();
        let meshes: Vec<_> = bare.meshes().map(|(_, file)| file.mesh()).collect();
        let sets: Vec<_> = bare.texture_sets().map(|(_, file)| file.set()).collect();
        // A planet without meshes and sets keeps the key that it had before there were any.
        match (meshes.is_empty(), sets.is_empty()) {
            (true, true) => Self::of(&(bare.to_text(), pictures)),
            (false, true) => Self::of(&(bare.to_text(), pictures, meshes)),
            (_, false) => Self::of(&(bare.to_text(), pictures, meshes, sets)),
        }
    }

    /// The hash as a number.
    pub(crate) fn bits(self) -> u128 {
        self.0
    }

    /// The key of a number that was written down.
    #[cfg(any(feature = "bake", feature = "render"))]
    pub(crate) fn from_bits(bits: u128) -> Self {
        Self(bits)
    }
}

/// FNV-1a with 64 bits (Fowler, Noll, Vo 1991): equal bytes give equal names in every build, unlike the standard
/// hasher.
pub(crate) fn fnv1a(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3))
}

/// FNV-1a with 128 bits (Fowler, Noll, Vo; IETF draft-eastlake-fnv): start value and prime.
const OFFSET_BASIS: u128 = 0x6c62_272e_07bb_0142_62b8_2175_6295_c58d;
const PRIME: u128 = 0x0000_0000_0100_0000_0000_0000_0000_013b;

struct Fnv(u128);

impl fmt::Write for Fnv {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        for byte in text.bytes() {
            self.0 = (self.0 ^ u128::from(byte)).wrapping_mul(PRIME);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_tell_neighbouring_numbers_apart_and_never_change() {
        assert_eq!(Key::of(&(1.5, "a")), Key::of(&(1.5, "a")));
        assert_ne!(Key::of(&0.1_f64), Key::of(&0.1_f64.next_up()));
        assert_ne!(Key::of(&0.0), Key::of(&-0.0));
        // The hash of `7`; keys outlive a process once maps are kept on disk.
        assert_eq!(Key::of(&7), Key(0xd228_cb69_3d1a_8caf_7891_2b70_4e4a_4bde));
    }
    #[test]
    fn the_key_of_a_planet_is_of_its_surface_and_not_of_its_place() {
        let planet = Planet { layers: vec![crate::planet::Layer::default()], ..Planet::default() };
        let key = Key::of_planet(&planet);
        let mut other = planet.clone();
        other.editor = Some(crate::planet::EditorNotes::default());
        other.set_folder(std::path::Path::new("/somewhere/else"));
        assert_eq!(Key::of_planet(&other), key);
        other.layers[0].amplitude_m += 1.0;
        assert_ne!(Key::of_planet(&other), key);
    }
}
