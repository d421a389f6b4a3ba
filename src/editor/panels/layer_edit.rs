//! Edits of the list of layers. Names stay unique, and masks follow the layers they refer to.

use crate::planet::{Layer, MAX_LAYERS, Planet, Shape, locks};

/// Adds a layer of a landform (an index into [`Shape::LABELS`]) behind index `after`. Gives its index, or None if there
/// are too many.
pub fn add(planet: &mut Planet, kind: usize, after: Option<usize>, seed: u32) -> Option<usize> {
    let shape = Shape::of_kind(kind)?;
    let name = unique_name(planet, Shape::LABELS.get(kind).copied().unwrap_or("Layer"));
    let amplitude_m = shape.usual_amplitude_m();
    insert(planet, Layer { name, seed, amplitude_m, shape, ..Layer::default() }, after)
}

/// Adds a copy behind the layer. Gives its index.
pub fn duplicate(planet: &mut Planet, index: usize) -> Option<usize> {
    let mut layer = planet.layers.get(index)?.clone();
    layer.name = unique_name(planet, &layer.name);
    insert(planet, layer, Some(index))
}

/// Adds layers behind index `after`. A name that is taken gets a number, also in the masks among the new layers; masks
/// on layers that are not there are left out. Gives the index of the first, or None if there would be too many.
pub fn paste(planet: &mut Planet, layers: &[Layer], after: Option<usize>) -> Option<usize> {
    if planet.layers.len() + layers.len() > MAX_LAYERS {
        return None;
    }
    let first = after.map_or(planet.layers.len(), |i| (i + 1).min(planet.layers.len()));
    let mut renamed = Vec::new();
    for (number, layer) in layers.iter().enumerate() {
        let name = unique_name(planet, &layer.name);
        renamed.push((layer.name.clone(), name.clone()));
        planet.layers.insert(first + number, Layer { name, ..layer.clone() });
    }
    let names: Vec<String> = planet.layers.iter().map(|layer| layer.name.clone()).collect();
    for layer in &mut planet.layers[first..first + layers.len()] {
        for mask in &mut layer.masks {
            let new = renamed.iter().find(|(old, _)| mask.layer() == Some(old.as_str()));
            if let Some((_, new)) = new {
                mask.set_layer(new);
            }
        }
        layer.masks.retain(|mask| mask.layer().is_none_or(|name| names.iter().any(|other| other == name)));
    }
    Some(first)
}

/// Removes a layer and every mask that refers to it.
pub fn remove(planet: &mut Planet, index: usize) {
    if index < planet.layers.len() {
        let removed = planet.layers.remove(index);
        for layer in &mut planet.layers {
            layer.masks.retain(|mask| mask.layer() != Some(removed.name.as_str()));
        }
    }
}

/// Removes layers, and every mask that refers to them.
pub fn remove_all(planet: &mut Planet, indices: &[usize]) {
    let mut indices = indices.to_vec();
    indices.sort_unstable();
    indices.dedup();
    indices.iter().rev().for_each(|index| remove(planet, *index));
}

/// Adds copies of layers behind the last of them. Gives the indices of the copies, or None if there would be too many.
pub fn duplicate_all(planet: &mut Planet, indices: &[usize]) -> Option<Vec<usize>> {
    if let [index] = indices {
        return duplicate(planet, *index).map(|copy| vec![copy]);
    }
    let layers: Vec<Layer> = indices.iter().filter_map(|index| planet.layers.get(*index)).cloned().collect();
    let first = paste(planet, &layers, indices.iter().max().copied())?;
    Some((first..first + layers.len()).collect())
}

/// Moves layers up (`-1`) or down (`1`) together. Gives their new indices; the same if one of them is at the end.
pub fn shift_all(planet: &mut Planet, indices: &[usize], by: isize) -> Vec<usize> {
    let count = planet.layers.len();
    let moved: Option<Vec<usize>> =
        indices.iter().map(|index| index.checked_add_signed(by).filter(|to| *to < count)).collect();
    let Some(moved) = moved else { return indices.to_vec() };
    let mut order = indices.to_vec();
    // The foremost goes first, so that none steps over another one.
    order.sort_unstable_by_key(|index| *index as isize * -by);
    for index in order {
        shift(planet, index, by);
    }
    moved
}

/// The name of an edit of some layers: "Remove layer", "Remove 3 layers".
pub fn counted(verb: &str, count: usize) -> String {
    if count == 1 { format!("{verb} layer") } else { format!("{verb} {count} layers") }
}

/// Renames a layer, also in the masks and locks that refer to it. A name that is empty or taken changes nothing.
pub fn rename(planet: &mut Planet, index: usize, name: &str) -> bool {
    let taken = planet.layers.iter().enumerate().any(|(i, layer)| i != index && layer.name == name);
    let Some(layer) = planet.layers.get_mut(index) else { return false };
    if taken || name.trim().is_empty() || layer.name == name {
        return false;
    }
    let old = std::mem::replace(&mut layer.name, name.to_owned());
    for mask in planet.layers.iter_mut().flat_map(|layer| &mut layer.masks) {
        if mask.layer() == Some(old.as_str()) {
            mask.set_layer(name);
        }
    }
    locks::rename_layer(planet, &old, name);
    true
}

/// Moves a layer up (`-1`) or down (`1`). Gives its new index.
pub fn shift(planet: &mut Planet, index: usize, by: isize) -> usize {
    match index.checked_add_signed(by) {
        Some(to) if to < planet.layers.len() && index < planet.layers.len() => {
            let gap = if by > 0 { to + 1 } else { to };
            move_to_gap(planet, index, gap)
        }
        _ => index,
    }
}

/// Moves a layer into the gap before index `gap`, or behind the last layer. Gives its new index.
pub fn move_to_gap(planet: &mut Planet, index: usize, gap: usize) -> usize {
    if index >= planet.layers.len() || gap > planet.layers.len() {
        return index;
    }
    let to = if gap > index { gap - 1 } else { gap };
    let layer = planet.layers.remove(index);
    planet.layers.insert(to, layer);
    to
}

fn insert(planet: &mut Planet, layer: Layer, after: Option<usize>) -> Option<usize> {
    if planet.layers.len() >= MAX_LAYERS {
        return None;
    }
    let at = after.map_or(planet.layers.len(), |i| (i + 1).min(planet.layers.len()));
    planet.layers.insert(at, layer);
    Some(at)
}

/// The name, or the name with the first number that no layer has.
fn unique_name(planet: &Planet, name: &str) -> String {
    let free = |name: &String| planet.layers.iter().all(|layer| layer.name != *name);
    let stem: String = name.trim_end_matches(|c: char| c.is_ascii_digit()).trim_end().chars().take(40).collect();
    std::iter::once(name.to_owned()).chain((2..).map(|n| format!("{stem} {n}"))).find(free).unwrap_or(stem)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::param::Choice;
    use crate::planet::{LayerMask, Mask};

    fn planet() -> Planet {
        let layer = |name: &str| Layer { name: name.to_owned(), ..Layer::default() };
        let mut planet = Planet { layers: vec![layer("A"), layer("B"), layer("C")], ..Planet::default() };
        planet.layers[2].masks.push(Mask::Layer(LayerMask { layer: "A".to_owned(), ..LayerMask::default() }));
        planet
    }

    #[test]
    fn masks_follow_a_rename_and_go_with_their_layer() {
        let mut planet = planet();
        assert!(rename(&mut planet, 0, "Land"));
        assert_eq!(planet.layers[2].masks[0].layer(), Some("Land"));
        assert!(!rename(&mut planet, 0, "B") && !rename(&mut planet, 0, " "));
        remove(&mut planet, 0);
        assert!(planet.layers[1].masks.is_empty());
    }

    #[test]
    fn names_stay_unique() {
        let mut planet = planet();
        assert_eq!(duplicate(&mut planet, 0), Some(1));
        assert_eq!(duplicate(&mut planet, 1), Some(2));
        let names: Vec<_> = planet.layers.iter().map(|layer| layer.name.as_str()).collect();
        assert_eq!(names, ["A", "A 2", "A 3", "B", "C"]);
        assert_eq!(add(&mut planet, 1, None, 9), Some(5));
        assert_eq!(planet.layers[5].shape.index(), 1);
        while add(&mut planet, 0, None, 1).is_some() {}
        assert_eq!(planet.layers.len(), MAX_LAYERS);
    }

    #[test]
    fn layers_move_within_the_list() {
        let mut planet = planet();
        assert_eq!(shift(&mut planet, 0, -1), 0);
        assert_eq!(shift(&mut planet, 0, 1), 1);
        assert_eq!(planet.layers[1].name, "A");
        assert_eq!(shift(&mut planet, 2, 1), 2);
        let names = |planet: &Planet| planet.layers.iter().map(|layer| layer.name.clone()).collect::<String>();
        assert_eq!((move_to_gap(&mut planet, 0, 3), names(&planet)), (2, "ACB".to_owned()));
        assert_eq!((move_to_gap(&mut planet, 2, 0), names(&planet)), (0, "BAC".to_owned()));
        assert_eq!((move_to_gap(&mut planet, 1, 2), names(&planet)), (1, "BAC".to_owned()));
    }
}
