//! Edits of the palette and the biome table. Every key in the table stays a key of the palette.

use crate::planet::{Biome, Biomes, MAX_BIOMES, Planet, Table, TableRows};

/// Adds a biome with a free key. Gives its index, or None if the palette is full.
pub fn add(biomes: &mut Biomes) -> Option<usize> {
    if biomes.palette.len() >= MAX_BIOMES {
        return None;
    }
    let key =
        ('a'..='z').chain('A'..='Z').chain('0'..='9').chain("+-*/#@%&=?".chars()).find(|&key| is_free(biomes, key))?;
    let like = biomes.palette.last().cloned().unwrap_or_default();
    biomes.palette.push(Biome { key, name: format!("Biome {key}"), ..like });
    Some(biomes.palette.len() - 1)
}

/// Removes a biome; its cells, and its place in rules and populations, become those of `replacement`. The last biome
/// stays.
pub fn remove(planet: &mut Planet, index: usize, replacement: usize) -> bool {
    let palette = &planet.biomes.palette;
    let (Some(old), Some(new)) = (palette.get(index), palette.get(replacement)) else { return false };
    if index == replacement {
        return false;
    }
    let (old, new) = (old.key, new.key);
    planet.replace_biome_key(old, new);
    planet.biomes.palette.remove(index);
    true
}

/// Gives a biome another key, in the table, in the surface rules and in populations too.
///
/// # Errors
/// Why the biome cannot have that key; nothing changes then.
pub fn rekey(planet: &mut Planet, index: usize, key: char) -> Result<(), String> {
    if !key.is_ascii_graphic() || matches!(key, '"' | '\\') {
        return Err(format!("{key:?} cannot be a key; use a letter, a digit or a punctuation mark"));
    }
    if let Some(other) = planet.biomes.palette.iter().find(|biome| biome.key == key) {
        return Err(format!("{key:?} is the key of {}; use another", other.name));
    }
    let Some(biome) = planet.biomes.palette.get_mut(index) else { return Ok(()) };
    let old = std::mem::replace(&mut biome.key, key);
    planet.replace_biome_key(old, key);
    Ok(())
}

/// The table with another number of cells: each cell takes the biome that had its climate.
pub fn resized(table: &Table, columns: usize, rows: usize) -> Table {
    let columns = columns.clamp(Table::MIN_SIDE, Table::MAX_SIDE);
    let rows = rows.clamp(Table::MIN_SIDE, Table::MAX_SIDE);
    let (old_columns, old_rows) = (table.columns(), table.rows().len());
    let mut new = Table::uniform(table.key(0, 0).unwrap_or('a'), columns, rows);
    for row in 0..rows {
        for column in 0..columns {
            // The middle of the new cell, in the old table.
            let from_column = (2 * column + 1) * old_columns / (2 * columns);
            let from_row = (2 * row + 1) * old_rows / (2 * rows);
            if let Some(key) = table.key(from_column, from_row) {
                new.set_key(column, row, key);
            }
        }
    }
    new
}

/// The climate of a cell in words: moisture, and temperature or elevation.
pub fn cell_range(biomes: &Biomes, column: usize, row: usize) -> String {
    let (columns, rows) = (biomes.table.columns().max(1) as f64, biomes.table.rows().len().max(1) as f64);
    let (first, last, unit) = match biomes.rows {
        TableRows::Temperature => (biomes.hottest_c, biomes.coldest_c, "°C"),
        TableRows::Elevation => (biomes.highest_m, biomes.lowest_m, "m"),
    };
    let edge = |row: f64| first + (last - first) * row / rows;
    format!(
        "moisture {:.2} to {:.2}, {:.1} to {:.1} {unit}",
        column as f64 / columns,
        (column + 1) as f64 / columns,
        edge(row as f64 + 1.0),
        edge(row as f64),
    )
}

/// Moves a biome into the gap before index `gap`, or behind the last biome. Gives the new index of `selected`.
pub fn move_to_gap(biomes: &mut Biomes, index: usize, gap: usize, selected: usize) -> usize {
    if index >= biomes.palette.len() || gap > biomes.palette.len() {
        return selected;
    }
    let key = biomes.palette.get(selected).map(|biome| biome.key);
    let biome = biomes.palette.remove(index);
    biomes.palette.insert(if gap > index { gap - 1 } else { gap }, biome);
    key.and_then(|key| biomes.index_of(key)).unwrap_or(selected)
}

fn is_free(biomes: &Biomes, key: char) -> bool {
    biomes.index_of(key).is_none() && !biomes.table.rows().iter().any(|row| row.contains(key))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::Population;

    fn biomes() -> Biomes {
        let biome = |key| Biome { key, ..Biome::default() };
        let mut table = Table::uniform('a', 4, 2);
        table.set_key(3, 0, 'b');
        Biomes { palette: vec![biome('a'), biome('b')], table, ..Biomes::default() }
    }

    #[test]
    fn removing_replaces_and_rekeying_follows() {
        let life = vec![Population { biomes: "ab".to_owned(), ..Population::default() }];
        let mut planet = Planet { biomes: biomes(), life, ..Planet::default() };
        planet.biomes.snow_key = 'b';
        assert!(rekey(&mut planet, 1, 'a').unwrap_err().contains("is the key of Ground"));
        assert!(rekey(&mut planet, 1, '"').unwrap_err().contains("cannot be a key"));
        assert_eq!(rekey(&mut planet, 1, 'z'), Ok(()));
        assert_eq!((planet.biomes.snow_key, planet.life[0].biomes.as_str()), ('z', "az"));
        assert_eq!(planet.biomes.table.key(3, 0), Some('z'));
        assert!(!remove(&mut planet, 1, 1));
        assert!(remove(&mut planet, 1, 0));
        assert_eq!((planet.biomes.table.key(3, 0), planet.biomes.snow_key), (Some('a'), 'a'));
        assert_eq!((planet.biomes.palette.len(), planet.life[0].biomes.as_str()), (1, "a"));
    }

    #[test]
    fn a_new_biome_has_a_free_key_and_there_is_an_end() {
        let mut biomes = biomes();
        assert_eq!(add(&mut biomes), Some(2));
        assert_eq!(biomes.palette[2].key, 'c');
        while add(&mut biomes).is_some() {}
        assert_eq!(biomes.palette.len(), MAX_BIOMES);
    }

    #[test]
    fn resizing_keeps_the_climate_of_each_biome() {
        let table = resized(&biomes().table, 8, 4);
        assert_eq!(table.rows(), ["aaaaaabb", "aaaaaabb", "aaaaaaaa", "aaaaaaaa"]);
        assert_eq!(resized(&table, 4, 2), biomes().table);
        assert_eq!(resized(&table, 0, 999).rows().len(), Table::MAX_SIDE);
    }

    #[test]
    fn moving_a_biome_keeps_the_table_and_the_selection() {
        let mut biomes = biomes();
        let table = biomes.table.clone();
        assert_eq!(move_to_gap(&mut biomes, 0, 2, 0), 1);
        assert_eq!((biomes.palette[0].key, biomes.palette[1].key), ('b', 'a'));
        assert_eq!((move_to_gap(&mut biomes, 7, 0, 1), &biomes.table), (1, &table));
    }

    #[test]
    fn a_cell_tells_its_climate() {
        assert_eq!(cell_range(&biomes(), 3, 0), "moisture 0.75 to 1.00, 0.0 to 30.0 °C");
    }
}
