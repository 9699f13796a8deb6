//! File formats: problem, linkage, points and drawing files are read, with errors that point at their place; schemas,
//! templates, the mark of written files.
//!
//! | module | holds |
//! |---|---|
//! | [`diagnostic`] | diagnostics: error messages about a text that a person wrote, with the place, the fault and the remedy |
//! | [`generator`] | the generator mark of written files: every file that a person names bears it, and a file without it is never replaced |
//! | [`input_text`] | reading of an input file as text: bounded in size, with a remedy for each way in which it can fail |
//! | [`linkage_file`] | linkage files: a four-bar in natural coordinates or as a vector loop, a linkage with a slider, or a chain of stages |
//! | [`loads_file`] | loads: the table `[loads]` of a linkage file, and files of loads alone, read by the same code |
//! | [`name`] | names of problems and linkages, which become names of folders |
//! | [`points_file`] | points files: CSV with a header row with `x,y` and optionally `crank_deg`, `weight`, `tolerance`; `#` comments |
//! | [`problem_file`] | problem files: TOML is read, and a `ProblemSpec` with every default filled in is returned |
//! | [`problem_template`] | a commented problem file to start from: it can be run as it is, and is written for a user with a motor and a path |
//! | [`schema`] | JSON Schemas of the files that are read and of the record that is written, generated from the types that read and write them |
//! | [`shop_file`] | shop data: the table `[shop]` of a linkage file, and files of shop data alone, read by the same code |
//! | [`svg_file`] | SVG drawings as targets: one shape of a drawing as target points, spaced evenly by arc length, y up |
//! | [`sweep_file`] | sweep files: a problem and the keys of it that vary |
//! | [`toml_text`] | a TOML text with its errors: reads a type from it and finds the place of a key |

pub mod diagnostic;
pub mod generator;
pub(crate) mod input_text;
pub mod linkage_file;
pub mod loads_file;
pub mod name;
pub mod points_file;
pub mod problem_file;
pub mod problem_template;
pub mod schema;
pub mod shop_file;
pub mod svg_file;
pub mod sweep_file;
pub(crate) mod toml_text;
pub(crate) use crate::task::values as toml_values;
