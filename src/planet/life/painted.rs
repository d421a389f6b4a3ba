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

    /// The name that it may name a population by.
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
    /// Edits follow populations that were changed: those that name a population which got another name take it over,
    /// those of one that is gone go, too.
    pub fn follow_populations(&mut self, before: &[Population], after: &[Population]) {
        let has = |name: &str| after.iter().any(|population| population.name == name);
        let strangers: Vec<usize> = (0..self.len())
            .filter(|index| {
                let name = self.get(*index).and_then(GroundEdit::painted_population);
                name.is_some_and(|name| !has(name))
            })
            .collect();
        for index in strangers.into_iter().rev() {
            let name = self.get(index).and_then(GroundEdit::painted_population);
            let place = |name: &str| before.iter().position(|population| population.name == name);
            // While its name is typed anew, a population has none for a moment.
            let at = name.and_then(|name| place(name).or_else(|| place("")));
            let renamed = at.filter(|_| before.len() == after.len()).and_then(|at| after.get(at));
            match (renamed, self.get_mut(index).and_then(GroundEdit::population_mut)) {
                (Some(renamed), Some(name)) if !renamed.name.is_empty() => name.clone_from(&renamed.name),
                (Some(_), _) => {}
                (None, _) => drop(self.remove(index)),
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
        // Strokes of another planet.
        edits.push(stroke("Palm"));
        edits.follow_populations(&named(&["Fern"]), &named(&["Fern"]));
        assert_eq!(painted(&edits), ["all", "Fern"]);
    }
}
