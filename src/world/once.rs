//! Values that are made when they are first asked for.

use std::sync::OnceLock;

/// The value of a lock, made if it is not there. Makers use all cores, so the lock is not held meanwhile: a core that
/// helps the maker may take up other work, and that work may ask for the same value. Two threads may make it at once;
/// both values are equal.
pub(super) fn made<T>(lock: &OnceLock<T>, make: impl FnOnce() -> T) -> &T {
    match lock.get() {
        Some(made) => made,
        None => {
            let made = make();
            lock.get_or_init(|| made)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_maker_may_ask_for_the_value_that_it_makes() {
        let lock = OnceLock::new();
        assert_eq!(*made(&lock, || *made(&lock, || 7)), 7);
    }
}
