//! The path of a parameter in a planet.

use std::fmt;

/// The path of a parameter: `layers[2].shape.octaves`.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ParamPath(Vec<Segment>);

/// One step of a [`ParamPath`].
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Segment {
    /// A field of a struct.
    Field(&'static str),
    /// An element of a list.
    Index(usize),
}

impl ParamPath {
    /// The steps from the planet down.
    pub fn segments(&self) -> &[Segment] {
        &self.0
    }

    /// Runs `inside` with the path extended by one step.
    pub fn within<R>(&mut self, segment: Segment, inside: impl FnOnce(&mut Self) -> R) -> R {
        self.0.push(segment);
        let result = inside(self);
        self.0.pop();
        result
    }

    /// The path extended by one field.
    pub fn join(&self, field: &'static str) -> Self {
        let mut path = self.clone();
        path.0.push(Segment::Field(field));
        path
    }

    /// The part of the planet that the path leads into; empty for the planet's own parameters.
    pub fn part(&self) -> &'static str {
        match self.0.as_slice() {
            [Segment::Field(part), _, ..] => part,
            _ => "",
        }
    }

    /// Whether `self` is `prefix` or lies below it.
    pub fn starts_with(&self, prefix: &ParamPath) -> bool {
        self.0.starts_with(&prefix.0)
    }
}

impl From<Vec<Segment>> for ParamPath {
    fn from(segments: Vec<Segment>) -> Self {
        Self(segments)
    }
}

impl fmt::Display for ParamPath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, segment) in self.0.iter().enumerate() {
            match segment {
                Segment::Field(name) if i == 0 => f.write_str(name)?,
                Segment::Field(name) => write!(f, ".{name}")?,
                Segment::Index(index) => write!(f, "[{index}]")?,
            }
        }
        Ok(())
    }
}
