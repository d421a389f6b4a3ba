//! What a whole file holds: a planet, or a system of them. Reading, writing and explaining errors is the same for both.

use super::param::{Look, ParamPath, Params, Part, PartType};
use super::{Planet, VERSION, locate, migrate};
use serde::Serialize;
use serde::de::DeserializeOwned;

/// The type of a whole file.
pub(crate) trait Root: PartType + Params {
    /// The file as it is written: the version, then the fields.
    type File: DeserializeOwned + Serialize;
    /// The version that is written.
    const VERSION: u32;
    /// What the file holds, for messages: "planet".
    const THING: &'static str;
    /// What the file is called in messages: "preset".
    const NOUN: &'static str;

    /// A field that shows that the text is a file of another kind, and the message about it.
    fn other(text: &str) -> Option<(&'static str, &'static str)>;

    /// Every part, at any depth.
    fn parts() -> Vec<&'static Part> {
        let mut parts = Vec::new();
        <Self as PartType>::each_part(&mut |part| parts.push(part));
        parts
    }

    /// Calls `look` for each parameter in the order of the file.
    fn look(&self, look: &mut Look<'_>) {
        Params::each_value(self, &mut ParamPath::default(), look);
    }
}

impl Root for Planet {
    type File = migrate::CurrentFile;
    const VERSION: u32 = VERSION;
    const THING: &'static str = "planet";
    const NOUN: &'static str = "preset";

    fn other(text: &str) -> Option<(&'static str, &'static str)> {
        locate::find(text, "bodies")?;
        Some((
            "bodies",
            "this is a system file, not a preset; name the preset of one of its planets, or one of its bodies (--body)",
        ))
    }
}
