//! Files, texts, command line, reports: what a user reads and types.

mod advice;
mod analysis_sheets;
mod analyze;
mod bad_input;
mod balance;
mod batches;
mod building;
mod certifying;
mod command_line;
mod command_line_faults;
#[path = "../common/mod.rs"]
mod common;
mod compare;
mod continuation;
mod corpora;
mod documents;
mod exports;
mod faults;
mod front;
mod loads;
mod long_runs;
mod numbers_document;
mod overwriting;
mod player_golden;
mod problem_file_document;
mod proving;
#[path = "../common/random.rs"]
mod random;
mod record_schema;
#[path = "../reference/mod.rs"]
mod reference;
mod remedies;
mod report;
mod report_page;
mod rooms;
mod seeds_document;
mod shipped_problems;
mod shop;
#[cfg(feature = "studio")]
mod studio;
#[cfg(feature = "studio")]
mod studio_hostile;
#[cfg(feature = "studio")]
mod studio_interface;
#[cfg(feature = "studio")]
mod studio_jobs;
mod svg_in;
mod sweep;
mod text_in;
