//! Names of the pictures of a set, from that of its colour picture: the word for its role gives way to another.
//!
//! `rock_diff_2k.png` leads to `rock_nor_gl_2k.exr`, and `Rock035_1K-PNG_Color.png` to `Rock035_1K-PNG_Roughness.png`.

use std::path::{Path, PathBuf};

/// A picture of a set beside that of its colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Role {
    /// Normals, x to the right. OpenGL: y up the picture. DirectX: y down.
    Normal { is_directx: bool },
    /// Roughness, white is rough.
    Roughness,
    /// Heights, white is high.
    Height,
    /// Share of the sky that the surface does not hide.
    Occlusion,
}

/// Words for the role of the colour picture. Longer ones come before those that they end with.
const COLOR: [&str; 7] = ["base_color", "basecolor", "albedo", "diffuse", "color", "diff", "col"];

/// Words for the other roles: in lower case, and capitalised. Of several pictures of one role the first counts.
const NORMAL_GL: [[&str; 2]; 6] = [
    ["normal", "Normal"],
    ["normal_gl", "Normal_GL"],
    ["normalgl", "NormalGL"],
    ["nor_gl", "Nor_GL"],
    ["nor", "Nor"],
    ["normal_opengl", "Normal_OpenGL"],
];
const NORMAL_DX: [[&str; 2]; 4] =
    [["normal_dx", "Normal_DX"], ["normaldx", "NormalDX"], ["nor_dx", "Nor_DX"], ["normal_directx", "Normal_DirectX"]];
const ROUGHNESS: [[&str; 2]; 2] = [["roughness", "Roughness"], ["rough", "Rough"]];
const HEIGHT: [[&str; 2]; 4] =
    [["height", "Height"], ["displacement", "Displacement"], ["disp", "Disp"], ["bump", "Bump"]];
const OCCLUSION: [[&str; 2]; 4] = [
    ["ao", "AO"],
    ["occlusion", "Occlusion"],
    ["ambientocclusion", "AmbientOcclusion"],
    ["ambient_occlusion", "Ambient_Occlusion"],
];

/// Endings that are tried after that of the colour picture.
const ENDINGS: [&str; 4] = ["png", "jpg", "jpeg", "exr"];

/// Case of the letters of a word.
#[derive(Clone, Copy)]
enum Case {
    Lower,
    Capitalised,
    Upper,
}

/// The name of a colour picture around the word for its role.
struct Parts<'a> {
    before: &'a str,
    case: Case,
    after: &'a str,
    ending: &'a str,
}

impl<'a> Parts<'a> {
    /// None if no word of the name says that it has colours.
    fn of(name: &'a str) -> Option<Self> {
        let (stem, ending) = name.rsplit_once('.')?;
        let is_edge = |letter: Option<char>| letter.is_none_or(|letter| !letter.is_alphanumeric());
        // ASCII letters alone change, so that places in both texts are the same.
        let small = stem.to_ascii_lowercase();
        let found = COLOR.iter().flat_map(|word| small.match_indices(word)).filter(|(at, word)| {
            is_edge(small[..*at].chars().next_back()) && is_edge(small[at + word.len()..].chars().next())
        });
        // The last word counts; of those that end there, the longest.
        let (at, word) = found.max_by_key(|(at, word)| (at + word.len(), word.len()))?;
        let (before, rest) = stem.split_at(at);
        let (word, after) = rest.split_at(word.len());
        let letters = || word.chars().filter(char::is_ascii_alphabetic);
        let case = match letters().all(|letter| letter.is_ascii_uppercase()) {
            true => Case::Upper,
            false if letters().next().is_some_and(|letter| letter.is_ascii_uppercase()) => Case::Capitalised,
            false => Case::Lower,
        };
        Some(Self { before, case, after, ending })
    }

    /// The names of another picture, the likeliest first.
    fn names(&self, words: &[[&str; 2]]) -> Vec<String> {
        let endings = || {
            let others = ENDINGS.into_iter().filter(|ending| !ending.eq_ignore_ascii_case(self.ending));
            [self.ending].into_iter().chain(others)
        };
        let cased = words.iter().map(|[lower, capitalised]| match self.case {
            Case::Lower => (*lower).to_owned(),
            Case::Capitalised => (*capitalised).to_owned(),
            Case::Upper => lower.to_ascii_uppercase(),
        });
        let all = cased.flat_map(|word| {
            endings().map(move |ending| format!("{}{word}{}.{ending}", self.before, self.after)).collect::<Vec<_>>()
        });
        all.collect()
    }
}

/// Where the other pictures of a set may be, for each role the likeliest place first. Nowhere if the name of the colour
/// picture has no word for its role.
pub(super) fn beside(color: &Path) -> [Vec<(PathBuf, Role)>; 4] {
    let Some(parts) = color.file_name().and_then(|name| name.to_str()).and_then(Parts::of) else {
        return Default::default();
    };
    let places = |role: Role, words: &[[&str; 2]]| -> Vec<(PathBuf, Role)> {
        parts.names(words).into_iter().map(|name| (color.with_file_name(name), role)).collect()
    };
    let normals =
        [(Role::Normal { is_directx: false }, &NORMAL_GL[..]), (Role::Normal { is_directx: true }, &NORMAL_DX)];
    [
        normals.into_iter().flat_map(|(role, words)| places(role, words)).collect(),
        places(Role::Roughness, &ROUGHNESS),
        places(Role::Height, &HEIGHT),
        places(Role::Occlusion, &OCCLUSION),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether a set with this colour picture looks for a file of this name as a picture of this role.
    fn finds(color: &str, other: &str, role: Role) -> bool {
        beside(&Path::new("textures").join(color)).concat().contains(&(Path::new("textures").join(other), role))
    }

    #[test]
    fn other_pictures_are_found_by_the_word_for_the_role() {
        use Role::{Height, Normal, Occlusion, Roughness};
        let (gl, dx) = (Normal { is_directx: false }, Normal { is_directx: true });
        for (color, other, role) in [
            ("rock_albedo.png", "rock_normal.png", gl),
            ("rock_albedo.png", "rock_normal_dx.png", dx),
            ("rock_albedo.jpg", "rock_height.exr", Height),
            ("rock_albedo.JPG", "rock_ao.JPG", Occlusion),
            ("rock_diff_2k.png", "rock_nor_gl_2k.exr", gl),
            ("rock_diff_2k.png", "rock_disp_2k.png", Height),
            ("rock_diff_2k.jpg", "rock_rough_2k.png", Roughness),
            ("Rock035_1K-PNG_Color.png", "Rock035_1K-PNG_NormalGL.png", gl),
            ("Rock035_1K-PNG_Color.png", "Rock035_1K-PNG_NormalDX.png", dx),
            ("Rock035_1K-PNG_Color.png", "Rock035_1K-PNG_AmbientOcclusion.jpg", Occlusion),
            ("Rock035_1K-PNG_Color.png", "Rock035_1K-PNG_Displacement.png", Height),
            ("rock_basecolor-1024.png", "rock_roughness-1024.png", Roughness),
            ("rock_base_color.png", "rock_ambient_occlusion.png", Occlusion),
            ("Rock_BaseColor.png", "Rock_Normal.png", gl),
            ("Rock_Base_Color.png", "Rock_Normal_OpenGL.png", gl),
            ("ROCK_COL.PNG", "ROCK_NORMAL_GL.PNG", gl),
            ("ROCK_DIFF.png", "ROCK_BUMP.png", Height),
            ("albedo.png", "rough.png", Roughness),
            ("2k.diffuse.png", "2k.occlusion.png", Occlusion),
            // The last word counts.
            ("color_chips_diff.png", "color_chips_nor.png", gl),
            ("Größe_Color.png", "Größe_Height.png", Height),
        ] {
            assert!(finds(color, other, role), "{color}: {other}");
        }
    }

    #[test]
    fn a_name_without_a_role_stands_alone() {
        for name in ["rock.png", "collage.png", "rock_color2.png", "discolor_rock.png", "albedo", "différent.png", ""]
        {
            assert!(beside(Path::new(name)).concat().is_empty(), "{name}");
        }
        for (color, other) in [
            ("rock_albedo.png", "rock_Normal.png"),
            ("Rock_Color.png", "Rock_normal.png"),
            ("rock_base_color.png", "rock_base_normal.png"),
        ] {
            let names: Vec<_> = beside(Path::new(color)).concat().into_iter().map(|(path, _)| path).collect();
            assert!(!names.contains(&PathBuf::from(other)), "{color}: {other}");
        }
    }

    #[test]
    fn the_ending_of_the_colours_comes_first_and_opengl_before_directx() {
        let [normals, ..] = beside(Path::new("a_col.jpg"));
        assert_eq!(normals[0], (PathBuf::from("a_normal.jpg"), Role::Normal { is_directx: false }));
        assert_eq!(normals[1].0, PathBuf::from("a_normal.png"));
        assert_eq!(normals.last().unwrap().1, Role::Normal { is_directx: true });
    }
}
