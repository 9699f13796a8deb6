//! Recognition of a result's files by their contents: a user's file with the name of such a file is left alone.

use super::TIMING;
use crate::files::generator::FileKind;
use std::io::Read;
use std::path::Path;

/// The number of bytes of a file that are examined; linkage files are smaller.
const HEAD: u64 = 1 << 16;
/// The beginnings of the header rows of the tables, to which columns may be added.
const CANDIDATES: &[u8] = b"rank,accepted,";
const CURVE: &[u8] = b"crank_deg,t1,";
/// The beginning of drawings by versions that did not write a mark yet.
const UNMARKED_DRAWING: &[u8] =
    b"font-family=\"Inter, 'Helvetica Neue', Helvetica, Arial, 'DejaVu Sans', sans-serif\">";

/// Returns whether the file of this name contains what a run writes under it. An empty file counts: a crash of the
/// machine may have lost its contents. Records and files of an unfinished search are checked when they are read.
pub(super) fn is_of_a_run(path: &Path, name: &str) -> bool {
    let known: fn(&[u8]) -> bool = match name {
        TIMING => is_timing,
        "candidates.csv" => |head| head.starts_with(CANDIDATES),
        "report.html" => |head| FileKind::Html.is_written_by_us(head, b""),
        _ if name.starts_with("curve-") => |head| head.starts_with(CURVE),
        _ if name.starts_with("linkage-") => |head| FileKind::Linkage.is_written_by_us(head, b""),
        _ if name.ends_with(".svg") => is_drawing,
        _ => return true,
    };
    let mut head = Vec::new();
    match super::disk::open(path).and_then(|file| file.take(HEAD).read_to_end(&mut head)) {
        Ok(0) => true,
        Ok(_) => known(&head),
        // A file that has vanished was another run's; a file that cannot be read might be a user's.
        Err(e) => e.kind() == std::io::ErrorKind::NotFound,
    }
}

fn is_timing(head: &[u8]) -> bool {
    serde_json::from_slice::<serde_json::Value>(head).is_ok_and(|timing| timing["total_s"].is_number())
}

fn is_drawing(head: &[u8]) -> bool {
    let unmarked = head.windows(UNMARKED_DRAWING.len()).any(|window| window == UNMARKED_DRAWING);
    (head.starts_with(b"<svg") && unmarked) || FileKind::Svg.is_written_by_us(head, b"")
}
