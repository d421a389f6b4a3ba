//! Descriptions of parameters against content keys: on planets that together have every parameter, a change of each
//! changes the keys of the stages that its description names, and of those that read them, and no others.

use crate::sculpt::{every_tool, planet as sculpted};
use crate::support::edits::{full_planet, other};
use std::sync::Arc;
use tellus::planet::param::{ParamPath, Segment, Stage, Stages};
use tellus::planet::{Form, Giant, Planet, PlateByHand, Population, Rings, Structure};
use tellus::terrain::Revision;

/// A planet with a structure, edits with every tool, and rings.
fn whole_planet() -> Planet {
    let edits = sculpted(0.0, every_tool()).edits;
    let mut structure = Structure { grids: 1, ..Structure::default() };
    structure.plates.by_hand = vec![PlateByHand { plate: 2, turn_deg: 20.0, ..PlateByHand::default() }];
    let life = Form::all().into_iter().map(|form| Population { form, clumping: 0.4, ..Population::default() });
    Planet { structure: Some(structure), edits, life: life.collect(), rings: Some(Rings::default()), ..full_planet() }
}

/// Whether the keys that changed are those of the declared stages, but for what another parameter decides.
fn is_right(planet: &Planet, path: &ParamPath, declared: Stages, changed: Stages) -> bool {
    let name = path.to_string();
    let has_structure = planet.structure.is_some();
    // A tool decides whether its edit shapes the ground, or paints the climate, clouds or the structure. A mask may
    // leave copies where they were.
    if let [Segment::Field("edits"), Segment::Index(index), Segment::Field(name), ..] = path.segments() {
        let may_stay = *name == "name" || (*name == "mask" && planet.edits.get(*index).unwrap().is_scattered());
        return may_stay || !changed.is_empty();
    }
    // Beds of roads are as wide as their radius says, and limits of edits begin at the sea.
    let moves_beds = has_structure && ["radius_km", "water.level_m"].contains(&&*name);
    let changed = if moves_beds { changed.without(Stages::of(&[Stage::Life])) } else { changed };
    // Slope masks alone need noise; a layer that is off, and relief, may need other noise.
    if name.ends_with("masks[0]") || name.ends_with(".enabled") || name.ends_with(".relief_m") {
        return changed.without(Stages::of(&[Stage::Field])) == declared.without(Stages::of(&[Stage::Field]));
    }
    // Rain follows from the temperature, and rivers from rain and from the level of the sea.
    let feeds_rivers = ["climate.equator_c", "climate.pole_c", "climate.lapse_c_per_km", "water.level_m"];
    if has_structure && feeds_rivers.contains(&&*name) {
        return changed == Stages::of(&[Stage::Field]).with_consequences();
    }
    // Biomes that are painted have the climate of their place in the table.
    if has_structure && ["biomes.rows", "biomes.coldest_c", "biomes.hottest_c"].contains(&&*name) {
        return changed == Stages::of(&[Stage::Climate]);
    }
    // A giant has no ground.
    if planet.giant.is_some() {
        return changed.without(Stages::OF_TILES) == declared.without(Stages::OF_TILES);
    }
    changed == declared
}

#[test]
fn every_parameter_changes_the_keys_of_the_stages_it_declares() {
    let unkeyed = Stages::of(&[Stage::Uniform, Stage::Label]);
    let (mut wrong, mut tried) = (Vec::new(), 0);
    for planet in [full_planet(), whole_planet(), Planet { giant: Some(Giant::default()), ..Planet::default() }] {
        let before = Revision::try_new(Arc::new(planet.clone())).unwrap();
        let mut places: Vec<(ParamPath, Stages)> = Vec::new();
        planet.each_value(&mut |path, param, _| places.push((path.clone(), param.stages)));
        for (path, declared) in places {
            let mut edited = planet.clone();
            edited.each(&mut |at, param, mut value| {
                if *at == path {
                    let new = other(&planet, param, &value);
                    value.set(&new);
                }
            });
            // A reference to another name would not be valid, and what has no effect changes no key.
            if edited == planet || planet.idle(&path).is_some() {
                continue;
            }
            let Ok(after) = Revision::try_after(Arc::new(edited), Some(&before)) else { continue };
            let (changed, declared) = (after.changes_since(&before), declared.with_consequences().without(unkeyed));
            tried += 1;
            if !is_right(&planet, &path, declared, changed) {
                wrong.push(format!("{path}: declares {declared:?}, changes {changed:?}"));
            }
        }
    }
    assert!(wrong.is_empty() && tried > 400, "{tried} tried\n{}", wrong.join("\n"));
}
