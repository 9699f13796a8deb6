//! The contents of a result's files: a file of a user under one of their names is told from them and stays.

use crate::generator::FileKind;
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// So much of a file is looked at; linkage files are smaller.
const HEAD: u64 = 1 << 16;
/// The beginnings of the tables, whose columns may become more.
const CANDIDATES: &[u8] = b"rank,accepted,";
const CURVE: &[u8] = b"crank_deg,t1,";
/// The drawings of versions that wrote no mark yet.
const UNMARKED_DRAWING: &[u8] =
    b"font-family=\"Inter, 'Helvetica Neue', Helvetica, Arial, 'DejaVu Sans', sans-serif\">";

/// Whether the file of this name holds what a run writes under it. An empty file is one that a machine has lost; records
/// and files of a search half done are judged where they are read.
pub(super) fn is_of_a_run(path: &Path, name: &str) -> bool {
    let known: fn(&[u8]) -> bool = match name {
        "timing.json" => is_timing,
        "candidates.csv" => |head| head.starts_with(CANDIDATES),
        "report.html" => |head| FileKind::Html.is_written_by_us(head, b""),
        _ if name.starts_with("curve-") => |head| head.starts_with(CURVE),
        _ if name.starts_with("linkage-") => |head| FileKind::Linkage.is_written_by_us(head, b""),
        _ if name.ends_with(".svg") => is_drawing,
        _ => return true,
    };
    let mut head = Vec::new();
    match File::open(path).and_then(|file| file.take(HEAD).read_to_end(&mut head)) {
        Ok(0) => true,
        Ok(_) => known(&head),
        // One that has vanished is a neighbour's; one that cannot be read cannot be told from a user's.
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
