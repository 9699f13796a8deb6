//! How long tests look: `THOROUGH=1` for as long as `.ci/run` does where it has the time.

/// Whether tests are to look as long as `.ci/run` does: `THOROUGH=1`.
pub fn is_thorough() -> bool {
    std::env::var_os("THOROUGH").is_some()
}

/// Returns so many cases of a test of random ones: `all` of them with `THOROUGH=1`, else those of every day.
pub fn cases<T>(of_every_day: T, all: T) -> T {
    if is_thorough() { all } else { of_every_day }
}
