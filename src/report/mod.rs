//! Reports of a run: text, drawings and tables, all pure functions of a [`Record`](crate::record::Record).
//!
//! The same record gives the same bytes: nothing here reads a clock, a host or a terminal. A record may come from
//! anywhere, so names in it are arbitrary text (cleaned for the terminal, escaped for XML) and its lists may be empty
//! or of unequal lengths: missing values are left out. Curves are computed from the linkage's own kinematics, figures
//! are those of the record. Points count from 0, as everywhere.
//!
//! | for | call |
//! |---|---|
//! | a terminal | [`table::candidates_table`], [`table::batch_summary`], [`exact::exact_text`] |
//! | | [`certificate::certificate_text`], [`plot::terminal_plot`] |
//! | a page | [`svg::candidate_svg`], [`contact_sheet::contact_sheet_svg`], [`exact_sheet::exact_svg`] |
//! | a browser | [`html::report_html`] |
//! | a spreadsheet | [`csv::candidates_csv`], [`csv::curve_csv`] |
//! | a linkage by itself | [`analysis_sheets::analysis_svg`], [`analysis_sheets::cognates_svg`] |
//! | several results | [`compare::compare`] |
//! | a suite of problems | [`suite::suite_text`], [`suite::suite_markdown`] |

pub mod analysis_csv;
pub mod analysis_sheets;
pub mod analysis_text;
pub mod batch_csv;
mod beside;
mod canvas;
pub mod certificate;
pub mod chain_sheet;
pub mod chain_text;
mod cognates_sheet;
pub mod compare;
pub mod contact_sheet;
pub mod csv;
pub mod exact;
pub mod exact_sheet;
mod figure;
mod grid;
pub mod html;
mod labels;
mod parts;
pub mod plot;
pub mod practicality;
pub mod price;
pub(crate) mod scene;
mod sheet;
pub mod snap;
pub mod suite;
pub mod svg;
pub mod table;
pub mod text;
mod words;

pub use grid::Colour;
