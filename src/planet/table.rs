//! The biome table: a grid of one-letter keys, written as rows of text so that a change is a readable diff.

use super::param::{Form, Look, ParamPath, Params, PartType, Visit};
use serde::{Deserialize, Serialize};

/// Rows of keys, all of equal length. Row 0 is the hottest (or highest), column 0 the driest.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Table {
    rows: Vec<String>,
}

impl Table {
    /// Fewest rows and columns.
    pub const MIN_SIDE: usize = 1;
    /// Most rows and columns.
    pub const MAX_SIDE: usize = 64;

    /// A table with `key` in every cell.
    pub fn uniform(key: char, columns: usize, rows: usize) -> Self {
        Self { rows: vec![std::iter::repeat_n(key, columns).collect(); rows] }
    }

    /// A table of rows as they stand in a file.
    pub(super) fn from_rows(rows: Vec<String>) -> Self {
        Self { rows }
    }

    /// The rows as text, first the hottest (or highest).
    pub fn rows(&self) -> &[String] {
        &self.rows
    }

    /// Number of columns (letters of the first row).
    pub fn columns(&self) -> usize {
        self.rows.first().map_or(0, |row| row.chars().count())
    }

    /// The key in a cell, if there is such a cell.
    pub fn key(&self, column: usize, row: usize) -> Option<char> {
        self.rows.get(row)?.chars().nth(column)
    }

    /// Puts `key` into a cell; outside the table nothing happens.
    pub fn set_key(&mut self, column: usize, row: usize, key: char) {
        if let Some(text) = self.rows.get_mut(row) {
            *text = text.chars().enumerate().map(|(i, old)| if i == column { key } else { old }).collect();
        }
    }

    /// Replaces every `old` key by `new`.
    pub fn replace_key(&mut self, old: char, new: char) {
        for row in &mut self.rows {
            *row = row.chars().map(|key| if key == old { new } else { key }).collect();
        }
    }
}

/// The table is one value without a slider: the painter edits it, `validate` checks it.
impl Params for Table {
    fn each_param(&mut self, _path: &mut ParamPath, _visit: &mut Visit<'_>) {}
    fn each_value(&self, _path: &mut ParamPath, _look: &mut Look<'_>) {}
}

impl PartType for Table {
    const FORM: Form = Form::Table;

    fn every_kind() -> Vec<Self> {
        vec![Self::uniform('a', 1, 1)]
    }
}
