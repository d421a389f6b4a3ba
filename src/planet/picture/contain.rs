//! Turns panics of decoders into errors, so that a broken file does not end the program.
//!
//! OpenEXR decoders read numbers that no header guarantees, and some panic on them. The panic is caught where the
//! decoder was called, on any thread. A host built with `panic = "abort"` has no such protection.

use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};

thread_local! {
    static CONTAINED: Cell<bool> = const { Cell::new(false) };
}

/// Whether a panic of this thread will be caught and reported as a problem of a picture. A panic hook should stay
/// silent then, as the program's does.
pub fn is_contained() -> bool {
    CONTAINED.get()
}

/// The result of `decode`, or an error if it panics. Values that `decode` was changing must not be used after an error.
pub(in crate::planet) fn contained<T>(decode: impl FnOnce() -> Result<T, String>) -> Result<T, String> {
    let before = CONTAINED.replace(true);
    let result = catch_unwind(AssertUnwindSafe(decode));
    CONTAINED.set(before);
    result.unwrap_or_else(|_| Err("is broken: its numbers contradict each other; save it anew".to_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_is_an_error_and_others_are_not_hidden() {
        assert_eq!(contained(|| Ok(is_contained())), Ok(true));
        assert!(contained(|| -> Result<(), String> { panic!("a decoder") }).is_err());
        assert!(!is_contained());
    }
}
