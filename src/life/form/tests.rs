//! Tests of all kinds of form: validity, budgets, levels that match, and the same bits everywhere.

use super::random::{Random, hash};
use super::{Form, LEVELS, Mesh, mesh, meshes, sight};
use crate::planet::life::{
    Bulbs, Cactus, Conifer, Crown, Crystal, Cushion, Fans, Mushroom, Palm, READY_POPULATIONS, Stone, Tendrils, Tree,
    Tuft, Wood,
};
use glam::Vec2;

/// The ready forms by their names.
fn ready() -> impl Iterator<Item = (&'static str, Form)> {
    READY_POPULATIONS.iter().map(|ready| (ready.name, ready.population().form))
}

/// Number of kinds.
const KINDS: u32 = 13;

/// Number in a range; the ends come up often.
fn real(r: &mut Random, low: f64, high: f64) -> f64 {
    match r.whole() % 6 {
        0 => low,
        1 => high,
        _ => low + (high - low) * f64::from(r.unit()),
    }
}

/// Whole number in a range.
fn whole(r: &mut Random, low: u32, high: u32) -> u32 {
    real(r, f64::from(low), f64::from(high)).round() as u32
}

/// Tree with parameters anywhere in their ranges.
fn tree(r: &mut Random) -> Form {
    let crowns = [Crown::Round, Crown::Cone, Crown::Column, Crown::Umbrella, Crown::Weeping];
    Form::Tree(Tree {
        crown: crowns[r.whole() as usize % 5],
        crown_width: real(r, 0.1, 2.0),
        trunk: real(r, 0.0, 0.8),
        trunk_width: real(r, 0.01, 0.2),
        leaves: real(r, 0.0, 1.0),
        leaf_size: real(r, 0.02, 0.15),
        irregular: real(r, 0.0, 1.0),
    })
}

/// Plant other than a tree.
fn plant(kind: u32, r: &mut Random) -> Form {
    match kind {
        1 => Form::Conifer(Conifer {
            crown_width: real(r, 0.1, 1.2),
            trunk: real(r, 0.0, 0.8),
            whorls: whole(r, 4, 24),
            droop: real(r, -0.6, 1.0),
            point: real(r, 0.0, 1.0),
            needles: real(r, 0.1, 1.0),
            irregular: real(r, 0.0, 1.0),
        }),
        2 => Form::Palm(Palm {
            fronds: whole(r, 5, 40),
            frond_length: real(r, 0.1, 0.9),
            arch: real(r, 0.0, 1.0),
            trunk_width: real(r, 0.01, 0.15),
            bend: real(r, 0.0, 0.6),
            leaflets: real(r, 0.1, 0.8),
        }),
        3 => Form::Tuft(Tuft {
            blades: whole(r, 3, 40),
            width: real(r, 0.01, 0.3),
            spread: real(r, 0.0, 1.0),
            arch: real(r, 0.0, 1.0),
            head: real(r, 0.0, 1.0),
            leaflets: r.unit() < 0.4,
        }),
        4 => Form::Cushion(Cushion {
            lumps: whole(r, 1, 30),
            width: real(r, 0.8, 8.0),
            lumpiness: real(r, 0.0, 1.0),
            roughness: real(r, 0.0, 1.0),
            leaves: real(r, 0.0, 1.0),
        }),
        _ => Form::Cactus(Cactus {
            ribs: whole(r, 5, 24),
            groove: real(r, 0.0, 0.5),
            arms: whole(r, 0, 8),
            girth: real(r, 0.05, 1.2),
            spines: real(r, 0.0, 1.0),
        }),
    }
}

/// Form of a kind with parameters anywhere in their ranges.
fn random_form(kind: u32, r: &mut Random) -> Form {
    match kind {
        0 => tree(r),
        1..=5 => plant(kind, r),
        6 => Form::Mushroom(Mushroom {
            cluster: whole(r, 1, 9),
            cap_width: real(r, 0.2, 2.0),
            cap_round: real(r, 0.0, 1.0),
            stem_width: real(r, 0.03, 0.5),
            lean: real(r, 0.0, 1.0),
        }),
        7 => Form::Stone(Stone {
            roundness: real(r, 0.0, 1.0),
            flatness: real(r, 0.0, 1.0),
            stretch: real(r, 1.0, 3.0),
            cuts: whole(r, 0, 20),
            layers: real(r, 0.0, 1.0),
            roughness: real(r, 0.0, 1.0),
        }),
        8 => Form::Crystal(Crystal {
            crystals: whole(r, 1, 24),
            width: real(r, 0.05, 0.6),
            lean: real(r, 0.0, 1.0),
            spread: real(r, 0.0, 1.0),
        }),
        9 => Form::Bulbs(Bulbs {
            stalks: whole(r, 1, 9),
            spheres: whole(r, 1, 12),
            size: real(r, 0.05, 0.5),
            fall: real(r, 0.0, 1.0),
            curl: real(r, 0.0, 1.0),
        }),
        11 => Form::Wood(Wood {
            length: real(r, 2.0, 30.0),
            pieces: whole(r, 1, 9),
            branches: real(r, 0.0, 1.0),
            flare: real(r, 0.0, 1.0),
            bend: real(r, 0.0, 1.0),
            moss: real(r, 0.0, 1.0),
        }),
        10 => Form::Fans(Fans {
            fans: whole(r, 1, 6),
            width: real(r, 0.2, 1.6),
            density: real(r, 0.0, 1.0),
            thickness: real(r, 0.0, 1.0),
            cup: real(r, 0.0, 1.0),
        }),
        _ => Form::Tendrils(Tendrils {
            tendrils: whole(r, 1, 12),
            width: real(r, 0.02, 0.3),
            curl: real(r, 0.0, 3.0),
            twist: real(r, 0.0, 2.0),
            spread: real(r, 0.0, 1.0),
        }),
    }
}

/// Largest number of triangles of a level.
fn budget(form: &Form, level: usize) -> usize {
    let table = match form {
        Form::Tuft(_) => [400, 40, 12, 4],
        Form::Tree(_) | Form::Conifer(_) | Form::Palm(_) => [12_000, 740, 150, 28],
        _ => [4000, 700, 140, 28],
    };
    table[level]
}

/// Check of one mesh.
fn check(form: &Form, level: usize, mesh: &Mesh) {
    let at = || format!("{form:?} at level {level}");
    assert!(mesh.triangles.len() <= budget(form, level), "{} triangles: {}", mesh.triangles.len(), at());
    assert!(mesh.triangles.len() >= 3, "{} triangles: {}", mesh.triangles.len(), at());
    assert!(mesh.vertices.len() < 65_536, "{}", at());
    for t in &mesh.triangles {
        assert!(t.iter().all(|&i| usize::from(i) < mesh.vertices.len()), "{}", at());
    }
    // What lies is longer than it is high.
    let reach = if matches!(form, Form::Wood(_)) { 45.0 } else { 20.0 };
    let mut top = f32::MIN;
    for v in &mesh.vertices {
        assert!(v.position.is_finite() && v.position.length() < reach, "{v:?}: {}", at());
        assert!((v.normal.length() - 1.0).abs() < 1e-3, "{v:?}: {}", at());
        assert!([v.part, v.light, v.sway].iter().all(|x| (0.0..=1.0).contains(x)), "{v:?}: {}", at());
        assert!(v.position.z >= -0.150_1, "{v:?}: {}", at());
        top = top.max(v.position.z);
    }
    assert!((top - 1.0).abs() < 1e-3, "height {top}: {}", at());
}

#[test]
fn random_parameters_give_valid_meshes() {
    for kind in 0..KINDS {
        let mut random = Random::new(7, kind);
        for _ in 0..if cfg!(debug_assertions) { 25 } else { 300 } {
            let form = random_form(kind, &mut random);
            let seed = random.whole();
            for (level, mesh) in meshes(&form, seed).iter().enumerate() {
                check(&form, level, mesh);
            }
        }
    }
}

#[test]
fn one_level_is_the_same_as_all() {
    for (_, form) in ready().step_by(5) {
        let all = meshes(&form, 11);
        for (level, one) in all.iter().enumerate() {
            assert_eq!(*one, mesh(&form, 11, level));
        }
    }
}

#[test]
fn levels_look_alike() {
    for (name, form) in ready() {
        for seed in 0..3 {
            let all = meshes(&form, seed);
            let near = sight::look_from(&all[0], 8, 64);
            for (level, mesh) in all.iter().enumerate().skip(1) {
                let far = sight::look_from(mesh, 8, 64);
                let most = if level == 3 { 0.25 } else { 0.15 };
                let off = (far.cover / near.cover - 1.0).abs();
                assert!(off < most, "{name} {seed} level {level}: {near:?} {far:?}");
                assert!((far.part - near.part).abs() < 0.15, "{name} {seed} level {level}: {near:?} {far:?}");
                assert!((far.light - near.light).abs() < 0.15, "{name} {seed} level {level}: {near:?} {far:?}");
            }
        }
    }
}

/// Conifers of many shapes.
fn conifers() -> Vec<Form> {
    let of = |change: &dyn Fn(&mut Conifer)| {
        let mut form = Conifer::default();
        change(&mut form);
        Form::Conifer(form)
    };
    vec![
        of(&|_| ()),
        of(&|form| form.crown_width = 0.2),
        of(&|form| form.crown_width = 1.0),
        of(&|form| form.point = 0.0),
        of(&|form| form.droop = -0.5),
        of(&|form| form.droop = 1.0),
        of(&|form| form.whorls = 6),
        of(&|form| form.whorls = 24),
        of(&|form| form.needles = 0.1),
        of(&|form| form.trunk = 0.5),
        of(&|form| form.irregular = 1.0),
    ]
}

/// Largest share by which a level of a form may cover more or less than the nearest one from above.
fn top_limit(name: &str, level: usize) -> f32 {
    match name {
        "Conifer" => 0.06,
        // Bare branches, stalks, thin blades and solids of a few corners have nothing that could lie flatter.
        "Dead tree" | "Palm" | "Reeds" | "Fern" | "Moss cushion" | "Mushrooms" | "Crystals" | "Twigs"
        | "Fallen trunk" => 0.32,
        "Column cactus" | "Alien bulbs" | "Alien tendrils" if level == 3 => 0.4,
        "Column cactus" | "Barrel cactus" | "Alien fans" | "Alien tendrils" => 0.12,
        _ => 0.08,
    }
}

#[test]
fn levels_cover_as_much_from_above() {
    let seeds = 4;
    for (name, form) in ready().chain(conifers().into_iter().map(|form| ("Conifer", form))) {
        let mut ratios = [Vec2::ZERO; LEVELS];
        for seed in 0..seeds {
            let covers = meshes(&form, seed)
                .map(|mesh| Vec2::new(sight::look_from(&mesh, 8, 64).cover, sight::look_down(&mesh, 96).cover));
            ratios.iter_mut().zip(covers).for_each(|(sum, cover)| *sum += cover / covers[0] / seeds as f32);
        }
        for (level, ratio) in ratios.iter().enumerate().skip(1) {
            let (off, most) = ((*ratio - 1.0).abs(), top_limit(name, level));
            assert!(off.x < most.min(0.1) && off.y < most, "{name} level {level}: {ratio} of {form:?}");
        }
    }
}

#[test]
fn meshes_are_the_same_on_every_machine() {
    let mut sum = 0_u32;
    let mut add = |bits: u32| sum = hash(sum ^ bits);
    for (_, form) in ready() {
        for mesh in meshes(&form, 5) {
            for v in &mesh.vertices {
                let numbers = [v.position.to_array(), v.normal.to_array(), [v.part, v.light, v.sway]];
                numbers.iter().flatten().for_each(|x| add(x.to_bits()));
            }
            mesh.triangles.iter().flatten().for_each(|&i| add(u32::from(i)));
        }
    }
    assert_eq!(sum, 4_097_908_174, "the ready forms' meshes have changed");
}

#[test]
fn variants_differ() {
    for (name, form) in ready() {
        assert_ne!(mesh(&form, 1, 0), mesh(&form, 2, 0), "{name}");
    }
}

#[test]
fn ready_forms_are_plausible() {
    for ready in READY_POPULATIONS {
        let population = ready.population();
        assert!(population.height_m > 0.0 && population.height_m < 60.0, "{}", ready.name);
        let colors = population.color.iter().chain(&population.leaf_color);
        assert!(colors.into_iter().all(|part| *part > 0.0 && *part < 0.9), "{}", ready.name);
    }
}

#[test]
fn solid_forms_face_outward() {
    let solid =
        ["Dead tree", "Column cactus", "Mushrooms", "Boulder", "Lava block", "Crystals", "Alien bulbs", "Fallen trunk"];
    for (name, form) in ready().filter(|(name, _)| solid.contains(name) || *name == "Alien tendrils") {
        for mesh in &meshes(&form, 3)[..3] {
            let mut volume = 0.0;
            let mut agree = 0;
            for t in &mesh.triangles {
                let [a, b, c] = t.map(|i| mesh.vertices[usize::from(i)]);
                volume += a.position.dot(b.position.cross(c.position)) / 6.0;
                let face = (b.position - a.position).cross(c.position - a.position);
                agree += u32::from(face.dot(a.normal + b.normal + c.normal) >= 0.0);
            }
            assert!(volume > 0.0, "{name}: volume {volume}");
            assert!(agree as f32 > 0.85 * mesh.triangles.len() as f32, "{name}: {agree} of {}", mesh.triangles.len());
        }
    }
}
