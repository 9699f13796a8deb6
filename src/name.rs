//! Names of problems and linkages, which become names of folders.

/// The most characters of a name.
pub const MAX_NAME: usize = 64;

/// What makes a text no name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NameError {
    /// No character at all, or only blanks.
    #[error("the name is empty")]
    Empty,
    /// More than [`MAX_NAME`] characters.
    #[error("the name has {0} characters, at most {MAX_NAME} are allowed")]
    TooLong(usize),
    /// It would be a hidden file, or the folder itself or the one above it.
    #[error("the name starts with a dot")]
    LeadingDot,
    /// It holds `/` or `\`.
    #[error("the name is a path")]
    Path,
    /// It starts or ends with a blank.
    #[error("the name starts or ends with a blank")]
    OuterBlank,
    /// A character that is not allowed.
    #[error("the name has {0:?} in it")]
    Character(char),
}

impl NameError {
    /// What to do about it.
    pub fn remedy(&self) -> &'static str {
        match self {
            NameError::Path => {
                "a name has no folder in it: write only its last part (--out says where results go)"
            }
            _ => "a name is 1 to 64 letters, digits, blanks and - _ . and does not start with a dot",
        }
    }
}

fn is_allowed(c: char) -> bool {
    c.is_alphanumeric() || matches!(c, ' ' | '-' | '_' | '.')
}

/// Whether a text may be a name: 1 to 64 letters, digits, blanks, `-`, `_`, `.`, not starting with a dot.
///
/// # Errors
/// [`NameError`], the first that applies.
pub fn check(name: &str) -> Result<(), NameError> {
    if name.trim().is_empty() {
        return Err(NameError::Empty);
    }
    if name.contains(['/', '\\']) {
        return Err(NameError::Path);
    }
    if name.starts_with('.') {
        return Err(NameError::LeadingDot);
    }
    if let Some(c) = name.chars().find(|&c| !is_allowed(c)) {
        return Err(NameError::Character(c));
    }
    if name.starts_with(' ') || name.ends_with(' ') {
        return Err(NameError::OuterBlank);
    }
    match name.chars().count() {
        count if count > MAX_NAME => Err(NameError::TooLong(count)),
        _ => Ok(()),
    }
}

/// A name made from the stem of a file's name: what is not allowed becomes `-`.
///
/// ```
/// assert_eq!(linkwright::name::from_file("shapes/heart (2).csv", "problem"), "heart -2-");
/// ```
pub fn from_file(file: &str, fallback: &str) -> String {
    let last = file.rsplit(['/', '\\']).next().unwrap_or(file);
    let stem = match last.rfind('.') {
        Some(dot) if dot > 0 => &last[..dot],
        _ => last,
    };
    let legal: String = stem
        .trim_start_matches('.')
        .chars()
        .map(|c| if is_allowed(c) { c } else { '-' })
        .take(MAX_NAME)
        .collect();
    let legal = legal.trim();
    if legal.is_empty() { fallback.to_owned() } else { legal.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_that_could_leave_their_folder_are_refused() {
        for name in ["", "  ", ".", "..", ".hidden", "a/b", "..\\x", "/etc", "a\nb", "a:b", "a ", "\u{1b}[1m"]
        {
            assert!(check(name).is_err(), "{name:?}");
        }
        assert_eq!(check(&"n".repeat(65)), Err(NameError::TooLong(65)));
        for name in ["eighteen-point", "Trayectoria el\u{ed}ptica 2", "v1.2_b", &"n".repeat(64)] {
            assert_eq!(check(name), Ok(()), "{name:?}");
        }
    }

    #[test]
    fn any_file_name_gives_a_legal_name() {
        for file in ["", ".", "..", "/", ".csv", "a:b.csv", " x .toml", "\u{1b}[1m.csv", &"n".repeat(300)] {
            assert_eq!(check(&from_file(file, "problem")), Ok(()), "{file:?}");
        }
        assert_eq!(from_file("dir/heart.v2.csv", "problem"), "heart.v2");
        assert_eq!(from_file(".csv", "problem"), "csv");
    }
}
