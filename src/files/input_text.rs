//! Reading of an input file as text: bounded in size, with a remedy for each way in which it can fail.

use crate::files::diagnostic::Diagnostic;
use std::fs::File;
use std::io::{ErrorKind, Read};
use std::path::Path;

/// The largest input file, in bytes: 16 MB.
pub const MAX_BYTES: u64 = 16 << 20;

/// Returns the text of a file, without its byte order mark.
///
/// # Errors
/// The file is missing, a folder, not readable, larger than [`MAX_BYTES`] (found before it is read) or not
/// UTF-8.
pub fn read(path: &Path) -> Result<String, Box<Diagnostic>> {
    let file = path.display().to_string();
    let refuse =
        |message: String, help: &str| Box::new(Diagnostic::new(file.clone(), "", message).with_help(help));
    let unreadable = |error: std::io::Error| match error.kind() {
        ErrorKind::NotFound => {
            refuse("there is no such file".into(), "check the spelling and the folder you are in")
        }
        ErrorKind::PermissionDenied => {
            refuse("you may not read this file".into(), "change the permissions of the file or of its folder")
        }
        _ => refuse(format!("it cannot be read: {error}"), "check that the path leads to a text file"),
    };
    let metadata = std::fs::metadata(path).map_err(unreadable)?;
    if metadata.is_dir() {
        let help = "name a file in it (for a folder of results: `linkwright verify` or `compare`)";
        return Err(refuse("this is a folder, not a file".into(), help));
    }
    let too_large = |size: String| {
        let help = "leave out points: a few hundred describe any path that a four-bar can trace";
        refuse(format!("the file {size}; at most 16 MB are read"), help)
    };
    if metadata.len() > MAX_BYTES {
        return Err(too_large(format!("has {} MB", metadata.len().div_ceil(1 << 20))));
    }
    // A pipe or a device states no length, so the limit is also checked while reading.
    let mut bytes = Vec::new();
    File::open(path).and_then(|f| f.take(MAX_BYTES + 1).read_to_end(&mut bytes)).map_err(unreadable)?;
    if bytes.len() as u64 > MAX_BYTES {
        return Err(too_large("has more than 16 MB".into()));
    }
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        let help = "save it again as UTF-8 (spreadsheets call it \"CSV UTF-8\")";
        return Err(refuse("the file is in UTF-16, which is not read".into(), help));
    }
    let text = String::from_utf8(bytes).map_err(|error| {
        let (at, bytes) = (error.utf8_error().valid_up_to(), error.as_bytes());
        let line = bytes[..at].iter().filter(|b| **b == b'\n').count() + 1;
        let message = format!("line {line} holds the byte 0x{:02x}, which is not UTF-8 text", bytes[at]);
        refuse(message, "save the file as UTF-8 in your editor or spreadsheet")
    })?;
    Ok(without_mark(&text).to_owned())
}

/// Returns the text without a byte order mark.
pub(crate) fn without_mark(text: &str) -> &str {
    text.strip_prefix('\u{feff}').unwrap_or(text)
}
