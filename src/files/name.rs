//! Names of problems and linkages, which become names of folders.

/// The largest number of characters of a name.
pub const MAX_NAME: usize = 64;

/// The reason why a text is not a name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NameError {
    /// The text has no character, or only blanks.
    #[error("the name is empty")]
    Empty,
    /// The text has more than [`MAX_NAME`] characters.
    #[error("the name has {0} characters, at most {MAX_NAME} are allowed")]
    TooLong(usize),
    /// The text starts with a dot: it would be a hidden file, or the folder itself or the one above it.
    #[error("the name starts with a dot")]
    LeadingDot,
    /// The text contains `/` or `\`.
    #[error("the name is a path")]
    Path,
    /// The text starts or ends with a blank.
    #[error("the name starts or ends with a blank")]
    OuterBlank,
    /// The text contains a character that is not allowed.
    #[error("the name has {0:?} in it")]
    Character(char),
    /// The text starts with `-`: commands would take it for an option.
    #[error("the name starts with -, so that commands take it for an option")]
    LeadingDash,
    /// The text ends with a dot, which Windows drops.
    #[error("the name ends with a dot, which Windows drops")]
    TrailingDot,
    /// The text is the name of a device on Windows, with or without an ending after a dot.
    #[error("{0} is the name of a device on Windows: no file or folder can be called so there")]
    Device(String),
}

impl NameError {
    /// Returns the remedy.
    pub fn remedy(&self) -> &'static str {
        match self {
            NameError::Path => {
                "a name has no folder in it: write only its last part (--out says where results go)"
            }
            NameError::Device(_) => {
                "write another word in front of it, such as `my-con`; an ending does not help"
            }
            NameError::LeadingDash => "begin the name with a letter, a digit or _",
            NameError::TrailingDot => "leave the dot at the end out",
            _ => "a name is 1 to 64 letters, digits, blanks and - _ . and does not start with a dot",
        }
    }
}

fn is_allowed(c: char) -> bool {
    c.is_alphanumeric() || matches!(c, ' ' | '-' | '_' | '.')
}

/// Returns whether a text is the name of a device on Windows, in upper or lower case: `CON`, `nul.v2`, `COM1`, `lpt9`.
/// Superscript digits count too (Microsoft, "Naming Files, Paths, and Namespaces").
fn is_device(name: &str) -> bool {
    let stem = name.split('.').next().unwrap_or(name).trim_end().to_ascii_lowercase();
    let port = |rest: &str| rest.chars().count() == 1 && "0123456789\u{b9}\u{b2}\u{b3}".contains(rest);
    matches!(stem.as_str(), "con" | "prn" | "aux" | "nul" | "conin$" | "conout$")
        || ["com", "lpt"].iter().any(|device| stem.strip_prefix(device).is_some_and(port))
}

/// Checks that a text is a name: 1 to 64 letters, digits, blanks, `-`, `_`, `.`, not starting with a dot or `-`, not
/// ending with a dot, and not the name of a device on Windows.
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
    if name.starts_with('-') {
        return Err(NameError::LeadingDash);
    }
    if name.ends_with('.') {
        return Err(NameError::TrailingDot);
    }
    if is_device(name) {
        return Err(NameError::Device(name.to_owned()));
    }
    if name.starts_with(' ') || name.ends_with(' ') {
        return Err(NameError::OuterBlank);
    }
    match name.chars().count() {
        count if count > MAX_NAME => Err(NameError::TooLong(count)),
        _ => Ok(()),
    }
}

/// Returns a name made from the stem of a file's name: each character that is not allowed becomes `-`.
///
/// ```
/// assert_eq!(linkwright::internals::files::name::from_file("shapes/heart (2).csv", "problem"), "heart -2-");
/// ```
pub fn from_file(file: &str, fallback: &str) -> String {
    let last = file.rsplit(['/', '\\']).next().unwrap_or(file);
    let stem = match last.rfind('.') {
        Some(dot) if dot > 0 => &last[..dot],
        _ => last,
    };
    let legal: String = stem
        .chars()
        .map(|c| if is_allowed(c) { c } else { '-' })
        .skip_while(|c| ".- ".contains(*c))
        .collect();
    let legal = if is_device(&legal) { format!("{fallback} {legal}") } else { legal };
    let legal: String = legal.chars().take(MAX_NAME).collect();
    let legal = legal.trim_end_matches(['.', ' ']);
    if legal.is_empty() { fallback.to_owned() } else { legal.to_owned() }
}

/// Returns the text itself if it is a name, otherwise a name made from it.
pub fn legal(name: &str, fallback: &str) -> String {
    match check(name) {
        Ok(()) => name.to_owned(),
        Err(_) => from_file(name, fallback),
    }
}

/// Returns a name with a suffix, such as `my-path-2`; the name is shortened if both together are too long.
///
/// ```
/// let long = linkwright::internals::files::name::with_suffix(&"n".repeat(64), "-snapped");
/// assert!(long.len() == 64 && long.ends_with("n-snapped"));
/// ```
pub fn with_suffix(name: &str, suffix: &str) -> String {
    let stem: String = name.chars().take(MAX_NAME.saturating_sub(suffix.chars().count())).collect();
    format!("{}{suffix}", stem.trim_end())
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
        for name in [
            "CON",
            "con",
            "nul",
            "NUL.v2",
            "aux .x",
            "PRN",
            "COM1",
            "com9.a",
            "LPT1",
            "lpt0",
            "COM\u{b9}",
            "-rf",
            "--help",
            "-",
            "end.",
            "end..",
        ] {
            assert!(check(name).is_err(), "{name:?}");
        }
        for name in ["CONTROL", "null", "com10", "COM", "lpt", "my-nul", "a-rf", "x.con", "_", "v1.2", "aux1"]
        {
            assert_eq!(check(name), Ok(()), "{name:?}");
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
        let cut = format!("{}.tail.csv", "n".repeat(63));
        for file in ["con.csv", "NUL", "-rf.toml", "--help", "a..csv", "- .", "com1.v2.csv", "?nul.csv", &cut]
        {
            assert_eq!(
                check(&from_file(file, "problem")),
                Ok(()),
                "{file:?}: {}",
                from_file(file, "problem")
            );
            assert_eq!(check(&legal(file, "problem")), Ok(()), "{file:?}");
        }
        for suffix in ["-1", "-buildable", "-cognate-2"] {
            for name in ["n", &"n".repeat(64), &format!("{}. x", "n".repeat(60))] {
                assert_eq!(check(&with_suffix(name, suffix)), Ok(()), "{name}{suffix}");
            }
        }
        assert_eq!(from_file("dir/heart.v2.csv", "problem"), "heart.v2");
        assert_eq!(from_file(".csv", "problem"), "csv");
    }
}
