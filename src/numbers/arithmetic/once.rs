//! Values that are made once, in parallel, and used by all threads.

use std::sync::OnceLock;

/// Returns the value of a cell, which is made at the first call.
///
/// The value is made before the cell is locked. With `OnceLock::get_or_init` a thread of a pool that makes it in parallel
/// can, while it waits for the others, take up another task that asks for the same value: it would wait for itself. Threads
/// that ask at the same time may make the value more than once; all of them get the first that is ready.
pub fn once<T>(cell: &OnceLock<T>, make: impl FnOnce() -> T) -> &T {
    if let Some(made) = cell.get() {
        return made;
    }
    let made = make();
    cell.get_or_init(|| made)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_can_be_asked_for_while_it_is_made() {
        static CELL: OnceLock<u32> = OnceLock::new();
        let value = once(&CELL, || {
            assert_eq!(*once(&CELL, || 1), 1);
            2
        });
        assert_eq!((*value, *once(&CELL, || 3)), (1, 1));
    }
}
