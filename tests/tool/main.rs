//! Files, texts, command line, reports: what a user reads and types.

mod analysis_sheets;
mod analyze;
mod bad_input;
mod batches;
mod building;
mod command_line;
#[path = "../common/mod.rs"]
mod common;
mod continuation;
mod corpora;
mod documents;
mod faults;
mod problem_file_document;
#[path = "../reference/mod.rs"]
mod reference;
mod report;
mod rooms;
mod seeds_document;
mod shipped_problems;
mod svg_in;
mod text_in;
