//! The painter's tools as functions on a biome table. Positions are in cells: (0, 0) is the upper left corner of the
//! table, (0.5, 0.5) the middle of its first cell.
//!
//! A table holds keys, which a soft brush cannot mix. The brush covers a share of each cell, and paints the cell if
//! that share exceeds the cell's threshold. The thresholds are fixed during a stroke, so that a soft edge is dithered
//! however long the pointer stays; the next stroke has other thresholds.

use crate::planet::Table;

/// A tool for the table.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Tool {
    #[default]
    Brush,
    Line,
    Rectangle,
    Fill,
    Pick,
    Select,
}

impl Tool {
    /// All of them, in the order shown.
    pub const ALL: [Tool; 6] = [Tool::Brush, Tool::Line, Tool::Rectangle, Tool::Fill, Tool::Pick, Tool::Select];

    /// The name on its button.
    pub fn label(self) -> &'static str {
        match self {
            Tool::Brush => "Brush",
            Tool::Line => "Line",
            Tool::Rectangle => "Rectangle",
            Tool::Fill => "Fill",
            Tool::Pick => "Eyedropper",
            Tool::Select => "Select",
        }
    }

    /// Its effect.
    pub fn tooltip(self) -> &'static str {
        match self {
            Tool::Brush => "Paint by dragging. Shift and click draws a straight line from the last stroke.",
            Tool::Line => "Drag a straight line as wide as the brush. Shift keeps it level, upright or diagonal.",
            Tool::Rectangle => "Drag a filled rectangle. Shift draws its outline alone.",
            Tool::Fill => "Fill all neighbouring cells of one biome. Shift fills every cell of that biome.",
            Tool::Pick => {
                "Choose the biome under the pointer, in the table or on the planet. In the table Ctrl does so \
                 with any tool."
            }
            Tool::Select => "Drag a selection: it lights up on the planet, and tools paint within it. A click ends it.",
        }
    }

    /// The name of its undo step.
    pub fn step(self) -> &'static str {
        match self {
            Tool::Line => "Draw line",
            Tool::Rectangle => "Draw rectangle",
            Tool::Fill => "Fill biome",
            Tool::Brush | Tool::Pick | Tool::Select => "Paint biomes",
        }
    }
}

/// Column and row.
pub type Cell = [usize; 2];

/// A position in the table, in cells.
pub type CellPos = [f32; 2];

/// A block of cells, both ends included.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub struct Block {
    pub first: Cell,
    pub last: Cell,
}

impl Block {
    /// The block between two cells.
    pub fn between(a: Cell, b: Cell) -> Self {
        let pick = |choose: fn(usize, usize) -> usize| [choose(a[0], b[0]), choose(a[1], b[1])];
        Self { first: pick(usize::min), last: pick(usize::max) }
    }

    /// Whether a cell lies in it.
    pub fn contains(&self, [column, row]: Cell) -> bool {
        (self.first[0]..=self.last[0]).contains(&column) && (self.first[1]..=self.last[1]).contains(&row)
    }
}

/// The brush.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Brush {
    /// Diameter in cells.
    pub size: usize,
    /// Width of the soft edge, from 0 (a hard edge) to 1 (soft from the middle on).
    pub softness: f32,
}

impl Default for Brush {
    fn default() -> Self {
        Self { size: 1, softness: 0.0 }
    }
}

impl Brush {
    /// Largest diameter in cells.
    pub const LARGEST: usize = 16;

    /// The share of a cell that a dab covers, 0 to 1.
    fn coverage(&self, at: CellPos, [column, row]: Cell) -> f32 {
        let radius = self.size as f32 * 0.5;
        // A brush of odd size is centred on a cell, one of even size on a corner between cells.
        let snap = |x: f32| if self.size % 2 == 1 { x.floor() + 0.5 } else { x.round() };
        let away = (column as f32 + 0.5 - snap(at[0])).hypot(row as f32 + 0.5 - snap(at[1]));
        if away > radius + 0.01 {
            return 0.0;
        }
        let hard = radius * (1.0 - self.softness);
        if away <= hard {
            return 1.0;
        }
        1.0 - (away - hard) / (radius + 0.5 - hard)
    }
}

/// A gesture under way: the table before it, and the cells that it has covered.
#[derive(Clone, Debug)]
pub struct Gesture {
    tool: Tool,
    key: char,
    brush: Brush,
    within: Option<Block>,
    before: Table,
    from: CellPos,
    to: CellPos,
    /// For each cell, the largest share that a dab of the stroke covered.
    covered: Vec<f32>,
    /// Number of the stroke, which sets the thresholds.
    number: u32,
}

impl Gesture {
    /// Begins at a position. Paints `key`, within a selection if there is one.
    pub fn new(
        tool: Tool,
        key: char,
        brush: Brush,
        within: Option<Block>,
        table: &Table,
        at: CellPos,
        number: u32,
    ) -> Self {
        let covered = vec![0.0; table.columns() * table.rows().len()];
        let mut gesture = Self { tool, key, brush, within, before: table.clone(), from: at, to: at, covered, number };
        gesture.cover(at, at);
        gesture
    }

    /// The tool of the gesture.
    pub fn tool(&self) -> Tool {
        self.tool
    }

    /// The position now.
    pub fn at(&self) -> CellPos {
        self.to
    }

    /// The block between the cells of its begin and its end.
    pub fn block(&self) -> Block {
        Block::between(cell_at(&self.before, self.from), cell_at(&self.before, self.to))
    }

    /// Goes on to a position. `constrained`: Shift is held, which makes lines straight, and outlines of rectangles.
    pub fn go_to(&mut self, at: CellPos, constrained: bool) {
        match self.tool {
            Tool::Brush => self.cover(self.to, at),
            Tool::Line => {
                self.covered.fill(0.0);
                let end = if constrained { straight(self.from, at) } else { at };
                self.cover(self.from, end);
            }
            Tool::Rectangle | Tool::Fill | Tool::Pick | Tool::Select => {}
        }
        self.to = at;
    }

    /// The table after the gesture.
    pub fn table(&self, constrained: bool) -> Table {
        let mut table = self.before.clone();
        for cell in self.cells(constrained) {
            table.set_key(cell[0], cell[1], self.key);
        }
        table
    }

    /// The cells that the gesture paints.
    pub fn cells(&self, constrained: bool) -> Vec<Cell> {
        let block = self.block();
        let key = |[column, row]: Cell| self.before.key(column, row);
        let at = cell_at(&self.before, self.to);
        let all = all_cells(&self.before).filter(|&cell| self.within.is_none_or(|within| within.contains(cell)));
        match self.tool {
            Tool::Brush | Tool::Line => {
                let columns = self.before.columns();
                all.filter(|&[column, row]| {
                    self.covered[row * columns + column] > threshold([column, row], self.number)
                })
                .collect()
            }
            Tool::Rectangle => {
                let edge = |[column, row]: Cell| {
                    [block.first[0], block.last[0]].contains(&column) || [block.first[1], block.last[1]].contains(&row)
                };
                all.filter(|&cell| block.contains(cell) && (!constrained || edge(cell))).collect()
            }
            Tool::Fill if constrained => all.filter(|&cell| key(cell) == key(at)).collect(),
            Tool::Fill => flood(&self.before, at, self.within),
            Tool::Pick | Tool::Select => Vec::new(),
        }
    }

    /// Covers cells by dabs along a line, three for each cell of its length.
    fn cover(&mut self, from: CellPos, to: CellPos) {
        let length = (to[0] - from[0]).hypot(to[1] - from[1]);
        let dabs = (length * 3.0).ceil().max(1.0);
        for i in 0..=dabs as usize {
            let share = i as f32 / dabs;
            let at = [from[0] + (to[0] - from[0]) * share, from[1] + (to[1] - from[1]) * share];
            for (covered, cell) in self.covered.iter_mut().zip(all_cells(&self.before)) {
                *covered = covered.max(self.brush.coverage(at, cell));
            }
        }
    }
}

/// The cell at a position; beside the table, the nearest cell.
pub fn cell_at(table: &Table, [x, y]: CellPos) -> Cell {
    let index = |x: f32, cells: usize| (x.max(0.0) as usize).min(cells.saturating_sub(1));
    [index(x, table.columns()), index(y, table.rows().len())]
}

fn all_cells(table: &Table) -> impl Iterator<Item = Cell> + use<> {
    let (columns, rows) = (table.columns(), table.rows().len());
    (0..rows).flat_map(move |row| (0..columns).map(move |column| [column, row]))
}

/// The end of a line from `from` towards `to` at a multiple of 45°.
fn straight(from: CellPos, to: CellPos) -> CellPos {
    let [dx, dy] = [to[0] - from[0], to[1] - from[1]];
    let most = dx.abs().max(dy.abs());
    let step = |d: f32| if d.abs() > 0.414 * most { most * d.signum() } else { 0.0 };
    [from[0] + step(dx), from[1] + step(dy)]
}

/// The cells of one biome that are connected to `from` by their sides.
fn flood(table: &Table, from: Cell, within: Option<Block>) -> Vec<Cell> {
    let columns = table.columns();
    let keys: Vec<Vec<char>> = table.rows().iter().map(|row| row.chars().collect()).collect();
    let key = |[column, row]: Cell| keys.get(row).and_then(|keys| keys.get(column)).copied();
    let mut seen = vec![false; columns * keys.len()];
    let (mut open, mut found) = (vec![from], Vec::new());
    while let Some(cell @ [column, row]) = open.pop() {
        let allowed = within.is_none_or(|within| within.contains(cell));
        if key(cell).is_none() || key(cell) != key(from) || !allowed || seen[row * columns + column] {
            continue;
        }
        seen[row * columns + column] = true;
        found.push(cell);
        open.extend([[column + 1, row], [column, row + 1]]);
        open.extend(column.checked_sub(1).map(|column| [column, row]));
        open.extend(row.checked_sub(1).map(|row| [column, row]));
    }
    found
}

/// The share of a cell that must be exceeded to paint it: a hash of cell and stroke, from 0 to below 1. The multipliers
/// are those of xxHash32 and MurmurHash3.
fn threshold([column, row]: Cell, stroke: u32) -> f32 {
    let mut h = (column as u32).wrapping_mul(0x9E37_79B1) ^ (row as u32).wrapping_mul(0x85EB_CA77);
    h = (h ^ stroke.wrapping_mul(0xC2B2_AE3D)).wrapping_mul(0x27D4_EB2F);
    h = (h ^ (h >> 15)).wrapping_mul(0x85EB_CA6B);
    ((h ^ (h >> 13)) >> 8) as f32 / 16_777_216.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(table: &Table) -> String {
        table.rows().join("/")
    }

    fn gesture(tool: Tool, brush: Brush, table: &Table, at: CellPos) -> Gesture {
        Gesture::new(tool, 'x', brush, None, table, at, 1)
    }

    #[test]
    fn a_brush_covers_what_it_passes_over() {
        let table = Table::uniform('.', 6, 3);
        let mut stroke = gesture(Tool::Brush, Brush::default(), &table, [0.5, 0.5]);
        stroke.go_to([3.5, 0.5], false);
        stroke.go_to([3.5, 2.5], false);
        assert_eq!(text(&stroke.table(false)), "xxxx../...x../...x..");
        let dab = |size| text(&gesture(Tool::Brush, Brush { size, softness: 0.0 }, &table, [2.4, 1.4]).table(false));
        assert_eq!(dab(2), ".xx.../.xx.../......");
        assert_eq!(dab(3), ".xxx../.xxx../.xxx..");
    }

    #[test]
    fn a_soft_edge_is_dithered_and_dwelling_changes_nothing() {
        let table = Table::uniform('.', 32, 32);
        let brush = Brush { size: 16, softness: 1.0 };
        let mut stroke = gesture(Tool::Brush, brush, &table, [16.0, 16.0]);
        let count = |table: &Table| text(table).matches('x').count();
        let once = stroke.table(false);
        let hard = count(&gesture(Tool::Brush, Brush { softness: 0.0, ..brush }, &table, [16.0, 16.0]).table(false));
        assert!((hard / 6..hard * 2 / 3).contains(&count(&once)), "{} of {hard}", count(&once));
        for _ in 0..20 {
            stroke.go_to([16.0, 16.0], false);
        }
        assert_eq!(stroke.table(false), once);
        let other = Gesture::new(Tool::Brush, 'x', brush, None, &table, [16.0, 16.0], 2);
        assert_ne!(other.table(false), once);
    }

    #[test]
    fn lines_and_rectangles_follow_the_pointer_back_too() {
        let table = Table::uniform('.', 5, 3);
        let mut line = gesture(Tool::Line, Brush::default(), &table, [0.5, 0.5]);
        line.go_to([4.5, 2.5], false);
        line.go_to([4.5, 0.8], true);
        assert_eq!(text(&line.table(true)), "xxxxx/...../.....");
        let mut rectangle = gesture(Tool::Rectangle, Brush::default(), &table, [3.5, 2.5]);
        rectangle.go_to([1.5, 0.5], false);
        assert_eq!(text(&rectangle.table(false)), ".xxx./.xxx./.xxx.");
        assert_eq!(text(&rectangle.table(true)), ".xxx./.x.x./.xxx.");
        rectangle.go_to([99.0, 2.5], false);
        assert_eq!(text(&rectangle.table(false)), "...../...../...xx");
    }

    #[test]
    fn fill_stops_at_other_biomes_and_at_the_selection() {
        let mut table = Table::uniform('.', 5, 3);
        (0..3).for_each(|row| table.set_key(2, row, 'o'));
        let fill = gesture(Tool::Fill, Brush::default(), &table, [0.5, 1.5]);
        assert_eq!(text(&fill.table(false)), "xxo../xxo../xxo..");
        assert_eq!(text(&fill.table(true)), "xxoxx/xxoxx/xxoxx");
        let within = Some(Block::between([1, 1], [4, 0]));
        let fill = Gesture::new(Tool::Fill, 'x', Brush::default(), within, &table, [1.5, 1.5], 1);
        assert_eq!(text(&fill.table(false)), ".xo../.xo../..o..");
        assert_eq!(text(&fill.table(true)), ".xoxx/.xoxx/..o..");
    }
}
