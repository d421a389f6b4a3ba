//! The panes from one start of the editor to the next, as a line of text: how many, what each shows, whether it shares
//! its camera. Cameras begin anew.

use super::{Pane, PaneLayout, Shows, Viewport};

/// First word of the text.
const VERSION: &str = "1";

/// What is kept of the panes.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Kept {
    layout: PaneLayout,
    active: usize,
    /// By place: what it shows, and whether it shares its camera.
    panes: Vec<(Shows, bool)>,
}

impl Kept {
    /// Fields have a tab between them.
    fn to_text(&self) -> String {
        let mut text = format!("{VERSION}\t{}\t{}", self.layout.panes(), self.active);
        for (shows, linked) in &self.panes {
            text.push('\t');
            text.push(if *linked { '+' } else { '-' });
            text.push_str(shows.label());
        }
        text
    }

    /// None if the text is none of this version, or names what there is no longer.
    fn from_text(text: &str) -> Option<Self> {
        let mut fields = text.split('\t');
        (fields.next()? == VERSION).then_some(())?;
        let count: usize = fields.next()?.parse().ok()?;
        let layout = PaneLayout::ALL.into_iter().find(|layout| layout.panes() == count)?;
        let active: usize = fields.next()?.parse().ok()?;
        let pane = |field: &str| {
            let (linked, label) = field
                .strip_prefix('+')
                .map(|label| (true, label))
                .or_else(|| Some((false, field.strip_prefix('-')?)))?;
            Some((Shows::all(true, true).find(|shows| shows.label() == label)?, linked))
        };
        let panes: Vec<(Shows, bool)> = fields.map(pane).collect::<Option<_>>()?;
        let is_planet = matches!(panes.get(active)?.0, Shows::Planet(_));
        (panes.len() == count && is_planet).then_some(Self { layout, active, panes })
    }
}

impl Viewport {
    /// The panes as a text for [`Viewport::restore_panes`].
    pub fn panes_text(&self) -> String {
        let pane = |place: usize| {
            let other = self.panes.others.get(place).and_then(Option::as_ref);
            Some((self.shows(place)?, other.map_or(self.panes.linked, |pane| pane.linked)))
        };
        let panes = (0..self.panes.layout.panes()).filter_map(pane).collect();
        Kept { layout: self.panes.layout, active: self.panes.active, panes }.to_text()
    }

    /// Opens the panes of a text. One that cannot be read, or of one pane, changes nothing.
    pub fn restore_panes(&mut self, text: &str) {
        let Some(kept) = Kept::from_text(text).filter(|kept| kept.layout != PaneLayout::One) else { return };
        self.set_layout(kept.layout);
        let mut others: Vec<Pane> = std::mem::take(&mut self.panes.others).into_iter().flatten().collect();
        self.panes.active = kept.active;
        self.panes.others = Vec::new();
        for (place, (shows, linked)) in kept.panes.into_iter().enumerate() {
            let other = if place == kept.active { None } else { others.pop() };
            match (other, shows) {
                (Some(mut pane), shows) => {
                    (pane.shows, pane.linked) = (shows, linked);
                    self.panes.others.push(Some(pane));
                }
                (None, Shows::Planet(view)) => {
                    (self.settings.debug_view, self.panes.linked) = (view, linked);
                    self.panes.others.push(None);
                }
                (None, Shows::Map(_)) => {}
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::MapKind;
    use super::*;
    use crate::render::DebugView;

    #[test]
    fn panes_are_read_as_they_were_written_and_other_texts_are_not() {
        let panes = vec![
            (Shows::Map(MapKind::Flat), true),
            (Shows::Planet(DebugView::Height), false),
            (Shows::Planet(DebugView::Shaded), true),
            (Shows::Planet(DebugView::Biome), true),
        ];
        let kept = Kept { layout: PaneLayout::Four, active: 2, panes };
        let text = kept.to_text();
        assert_eq!(Kept::from_text(&text), Some(kept));
        for (from, to) in
            [("1\t4", "2\t4"), ("\t4", "\t2"), ("\t2\t", "\t0\t"), ("\t2\t", "\t9\t"), ("Biome", "Bio"), ("-", "")]
        {
            let wrong = text.replacen(from, to, 1);
            assert!(wrong != text && Kept::from_text(&wrong).is_none(), "{wrong}");
        }
        assert_eq!(Kept::from_text(""), None);
        let labels: Vec<&str> = Shows::all(true, true).map(Shows::label).collect();
        let unique: std::collections::BTreeSet<&str> = labels.iter().copied().collect();
        assert_eq!(unique.len(), labels.len(), "{labels:?}");
    }
}
