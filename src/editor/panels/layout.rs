//! Where each tab stands: in one of the docks at the sides of the picture, or in a window of its own.

use super::PANELS;

/// The number of tabs.
const TABS: usize = PANELS.len();
/// The tab that is open at the start: the terrain.
pub const FIRST_TAB: usize = 1;
/// The version of the stored layout. Another one is not read.
const VERSION: &str = "4";

/// A place for tabs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Dock {
    /// The side panel.
    #[default]
    Right,
    /// The lower half of the side panel.
    Below,
    /// The panel at the left.
    Left,
    /// A window of its own.
    Window,
}

impl Dock {
    /// The docks that hold several tabs, of which one is open.
    pub const SIDES: [Dock; 3] = [Dock::Right, Dock::Below, Dock::Left];
    /// Every place, in the order of a menu.
    pub const ALL: [Dock; 4] = [Dock::Right, Dock::Below, Dock::Left, Dock::Window];

    /// Its letter in the stored layout.
    fn letter(self) -> char {
        match self {
            Dock::Right => 'r',
            Dock::Below => 'b',
            Dock::Left => 'l',
            Dock::Window => 'w',
        }
    }

    fn of_letter(letter: char) -> Option<Self> {
        Self::ALL.into_iter().find(|dock| dock.letter() == letter)
    }

    /// The name in menus.
    pub fn label(self) -> &'static str {
        match self {
            Dock::Right => "Dock at the right",
            Dock::Below => "Dock at the right, below",
            Dock::Left => "Dock at the left",
            Dock::Window => "Window of its own",
        }
    }
}

/// Where each tab stands, and which ones are open.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Layout {
    docks: [Dock; TABS],
    /// The open tab of each of [`Dock::SIDES`]; of no meaning for an empty dock.
    open: [usize; 3],
    /// The tab that was used last.
    active: usize,
}

impl Default for Layout {
    fn default() -> Self {
        Self { docks: [Dock::Right; TABS], open: [FIRST_TAB; 3], active: FIRST_TAB }
    }
}

impl Layout {
    /// The tabs in a dock, in the order of [`PANELS`].
    pub fn tabs(&self, dock: Dock) -> impl Iterator<Item = usize> + '_ {
        (0..TABS).filter(move |tab| self.docks[*tab] == dock)
    }

    /// The dock of a tab.
    pub fn dock(&self, tab: usize) -> Dock {
        self.docks.get(tab).copied().unwrap_or_default()
    }

    /// The tab that a dock shows; None if the dock is empty.
    pub fn open_tab(&self, dock: Dock) -> Option<usize> {
        let side = Dock::SIDES.iter().position(|side| *side == dock)?;
        let open = self.open[side];
        self.tabs(dock).find(|tab| *tab == open).or_else(|| self.tabs(dock).next())
    }

    /// The tabs on screen.
    pub fn visible(&self) -> impl Iterator<Item = usize> + '_ {
        (0..TABS).filter(|tab| self.docks[*tab] == Dock::Window || self.open_tab(self.docks[*tab]) == Some(*tab))
    }

    /// The tab that was used last.
    pub fn active(&self) -> usize {
        self.active
    }

    /// Opens a tab where it stands, and makes it the one that was used last.
    pub fn open(&mut self, tab: usize) {
        if tab >= TABS {
            return;
        }
        if let Some(side) = Dock::SIDES.iter().position(|side| *side == self.docks[tab]) {
            self.open[side] = tab;
        }
        self.active = tab;
    }

    /// Moves a tab to a dock, and opens it there.
    pub fn move_to(&mut self, tab: usize, dock: Dock) {
        if let Some(place) = self.docks.get_mut(tab) {
            *place = dock;
            self.open(tab);
        }
    }

    /// The layout as text, to be kept between runs.
    pub fn to_text(&self) -> String {
        let docks: String = self.docks.iter().map(|dock| dock.letter()).collect();
        let [right, below, left] = self.open;
        format!("{VERSION} {docks} {right} {below} {left}")
    }

    /// The layout of a text; None if the text is none of this version.
    pub fn from_text(text: &str) -> Option<Self> {
        let mut words = text.split(' ');
        (words.next()? == VERSION).then_some(())?;
        let letters: Option<Vec<Dock>> = words.next()?.chars().map(Dock::of_letter).collect();
        let docks = letters?.try_into().ok()?;
        let open: Option<Vec<usize>> = words.map(|word| word.parse().ok().filter(|tab| *tab < TABS)).collect();
        let open: [usize; 3] = open?.try_into().ok()?;
        let mut layout = Self { docks, open, active: open[0] };
        let first = layout.visible().next()?;
        layout.active = first;
        Some(layout)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tab_that_is_moved_opens_there_and_leaves_another_one_open() {
        let mut layout = Layout::default();
        layout.move_to(FIRST_TAB, Dock::Left);
        assert_eq!((layout.open_tab(Dock::Left), layout.open_tab(Dock::Right)), (Some(FIRST_TAB), Some(0)));
        assert_eq!(layout.active(), FIRST_TAB);
        layout.move_to(4, Dock::Window);
        assert_eq!(layout.visible().collect::<Vec<_>>(), [0, FIRST_TAB, 4]);
        assert_eq!(layout.open_tab(Dock::Below), None);
    }

    #[test]
    fn a_layout_is_read_back_and_nonsense_is_not() {
        let mut layout = Layout::default();
        layout.move_to(2, Dock::Below);
        layout.move_to(5, Dock::Window);
        layout.open(3);
        let read = Layout::from_text(&layout.to_text()).unwrap();
        assert_eq!((read.docks, read.open), (layout.docks, layout.open));
        for text in [
            "",
            "hidden",
            "3",
            "3 rrrrrrrrrr",
            "3 rrrrrrrrrr 1 1 10",
            "3 rrrrrrrrrx 1 1 1",
            "2 rrrrrrrrrr 1 1 1",
            "3 rr 1 1 1",
        ] {
            assert_eq!(Layout::from_text(text), None, "{text}");
        }
    }
}
