//! Populations that edits name: they must be there, and their edits follow them.

use super::Population;
use crate::planet::edits::edit_path;
use crate::planet::param::ParamPath;
use crate::planet::validate::one_of;
use crate::planet::{GroundEdit, GroundEdits, Planet, Tool};
use std::collections::HashSet;

impl GroundEdit {
    /// The name of the population that it paints or places. None if it names none.
    pub fn painted_population(&self) -> Option<&str> {
        let name = match &self.tool {
            Tool::Life(paint) => &paint.population,
            Tool::Object(object) => &object.population,
            _ => return None,
        };
        (!name.is_empty()).then_some(name)
    }

    /// The field that names a population; None if the tool has none.
    fn population_mut(&mut self) -> Option<&mut String> {
        match &mut self.tool {
            Tool::Life(paint) => Some(&mut paint.population),
            Tool::Object(object) => Some(&mut object.population),
            _ => None,
        }
    }
}

impl Planet {
    /// Edits that name a population that is not there.
    pub(crate) fn painted_life_problems(&self) -> Vec<(ParamPath, String)> {
        let names: Vec<&str> = self.life.iter().map(|population| population.name.as_str()).collect();
        let known: HashSet<&str> = names.iter().copied().collect();
        let problem = |(index, edit): (usize, &GroundEdit)| {
            let name = edit.painted_population().filter(|name| !known.contains(name))?;
            let right = match &*names {
                [] => "there is none: add a population, or remove the edit".to_owned(),
                some => {
                    let none = if matches!(edit.tool, Tool::Life(_)) { "all" } else { "the first" };
                    format!("use {}, or an empty text for {none}", one_of(some))
                }
            };
            let path = edit_path(index).join("tool").join("population");
            Some((path, format!("there is no population called {name:?}; {right}")))
        };
        self.edits.iter().enumerate().filter_map(problem).collect()
    }
}

impl GroundEdits {
    /// Removes edits that name populations which are not there.
    pub(crate) fn drop_strangers(&mut self, life: &[Population]) {
        let names: HashSet<&str> = life.iter().map(|population| population.name.as_str()).collect();
        for index in (0..self.len()).rev() {
            let name = self.get(index).and_then(GroundEdit::painted_population);
            if name.is_some_and(|name| !names.contains(name)) {
                self.remove(index);
            }
        }
    }

    /// Edits follow populations that were changed: those that name a population which got another name take it over,
    /// those of one that is gone go, too. While a name is typed it may be empty or that of another population for a
    /// moment: then its edits keep the name that they have, and take over the next one.
    pub fn follow_populations(&mut self, before: &[Population], after: &[Population]) {
        let count = |list: &[Population], name: &str| list.iter().filter(|population| population.name == name).count();
        let is_name = |list: &[Population], name: &str| !name.is_empty() && count(list, name) == 1;
        let changed = || before.iter().zip(after).position(|(old, new)| old.name != new.name);
        let changed = if before.len() == after.len() { changed() } else { None };
        let is_typed = before.iter().any(|population| !is_name(before, &population.name));
        for index in (0..self.len()).rev() {
            let Some(name) = self.get(index).and_then(GroundEdit::painted_population) else { continue };
            // Edits of one whose name is being typed are known to neither list.
            let is_lost = count(before, name) == 0 && count(after, name) == 0;
            let own = changed.filter(|at| {
                before[*at].name == name && is_name(before, name) || is_lost && !is_name(before, &before[*at].name)
            });
            let new = own.and_then(|at| after.get(at)).map(|population| population.name.clone());
            match (new, self.get_mut(index).and_then(GroundEdit::population_mut)) {
                (Some(new), Some(name)) if is_name(after, &new) => *name = new,
                (Some(_), _) => {}
                (None, Some(name)) if count(after, name) == 0 && !(is_lost && is_typed) => drop(self.remove(index)),
                (None, _) => {}
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::edits::LifePaint;

    fn named(names: &[&str]) -> Vec<Population> {
        names.iter().map(|name| Population { name: (*name).to_owned(), ..Population::default() }).collect()
    }

    fn painted(edits: &GroundEdits) -> Vec<&str> {
        edits.iter().map(|edit| edit.painted_population().unwrap_or("all")).collect()
    }

    #[test]
    fn strokes_follow_a_population_that_is_renamed_letter_by_letter_and_go_with_it() {
        let stroke = |name: &str| {
            let paint = LifePaint { population: name.to_owned(), ..LifePaint::default() };
            GroundEdit { tool: Tool::Life(paint), ..GroundEdit::default() }
        };
        let mut edits: GroundEdits = ["Oak", "", "Fern", "Oak"].map(stroke).into_iter().collect();
        let steps: Vec<Vec<Population>> =
            ["Oak", "Oa", "", "E", "Elm"].map(|name| named(&[name, "Fern"])).into_iter().collect();
        for step in steps.windows(2) {
            edits.follow_populations(&step[0], &step[1]);
            assert_eq!(edits.len(), 4);
        }
        assert_eq!(painted(&edits), ["Elm", "all", "Fern", "Elm"]);
        edits.follow_populations(&steps[4], &named(&["Fern"]));
        assert_eq!(painted(&edits), ["all", "Fern"]);
        // A name that is another's for a moment takes no strokes over, nor does a list that changes meanwhile.
        let mut edits: GroundEdits = ["Elm", "Elm 2"].map(stroke).into_iter().collect();
        for step in
            [["Elm", "Elm 2"], ["Elm", "Elm "], ["Elm", "Elm"], ["Elm", "Ash"]].map(|names| named(&names)).windows(2)
        {
            edits.follow_populations(&step[0], &step[1]);
        }
        assert_eq!(painted(&edits), ["Elm", "Ash"]);
        edits.follow_populations(&named(&["Elm", "Ash"]), &named(&["Elm", ""]));
        edits.follow_populations(&named(&["Elm", ""]), &named(&["Elm", "", "Fern"]));
        edits.follow_populations(&named(&["Elm", "", "Fern"]), &named(&["Elm", "Fir", "Fern"]));
        assert_eq!(painted(&edits), ["Elm", "Fir"]);
        // Strokes of another planet.
        let mut edits: GroundEdits = ["", "Fern"].map(stroke).into_iter().collect();
        edits.push(stroke("Palm"));
        edits.follow_populations(&named(&["Fern"]), &named(&["Fern"]));
        assert_eq!(painted(&edits), ["all", "Fern"]);
    }
}
