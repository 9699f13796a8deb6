//! Reports: text, drawings, tables and files to build from, pure functions of a [`Record`](crate::record::Record), of an
//! analysis or of a linkage.
//!
//! The same record gives the same bytes: nothing here reads a clock, a host or a terminal. A record may come from
//! anywhere, so names in it are arbitrary text (cleaned for the terminal, escaped for XML) and its lists may be empty
//! or of unequal lengths: missing values are left out. Curves are computed from the linkage's own kinematics, figures
//! are those of the record. Points count from 0, as everywhere.
//!
//! | for | call |
//! |---|---|
//! | a terminal | [`table::candidates_table`], [`table::batch_summary`], [`exact::exact_text`], [`front::front_text`] |
//! | | [`certificate::certificate_text`], [`plot::terminal_plot`] |
//! | a page | [`svg::candidate_svg`], [`contact_sheet::contact_sheet_svg`], [`exact_sheet::exact_svg`] |
//! | a browser | [`html::report_html`], [`html::front_html`] |
//! | a spreadsheet | [`csv::candidates_csv`], [`csv::front_csv`], [`csv::curve_csv`] |
//! | a linkage by itself | [`analysis_sheets::analysis_svg`], [`mechanism_sheet::mechanism_svg`], [`cognates_sheet::cognates_svg`] |
//! | several results | [`compare::compare`] |
//! | a suite of problems | [`suite::suite_text`], [`suite::suite_markdown`] |
//!
//! | module | holds |
//! |---|---|
//! | [`analysis_csv`] | an analysis as CSV: one row for each configuration and crank angle; a cell without a number is empty |
//! | [`analysis_sheets`] | an analysis as one self-contained SVG page: the drawings of the classic papers, as far as they apply |
//! | [`analysis_text`] | an analysis as text: the mobility in words, and the tables of positions, motion and methods |
//! | [`balance`] | the balance of a linkage as text: what to add, and what is left before and after |
//! | [`batch_csv`] | a batch as a table for spreadsheets and scripts: one row for each file |
//! | [`beside`] | lines printed below the candidates: the family, warnings, cognates, the buildable candidate, the picks |
//! | `bodies` | the drawing of a motion's body: a frame at each pose |
//! | `body` | the body of a motion, or the follower of a function, at the positions of a candidate: its angles and their errors |
//! | [`canvas`] | the SVG shapes of the drawings, in pixels with y down, and the view that maps the plane to the canvas, with y up |
//! | [`certificate`] | the certificate of a result, and the number of times its best answer was found, in words |
//! | [`chart`] | a chart of a few series against the crank angle |
//! | [`cognates_sheet`] | Roberts' figure: a linkage and its cognates in one position, with the coupler curve that they share |
//! | [`compare`] | comparison of linkages from several results: ranked by chosen figures, with the Pareto front of error, worst transmission angle and size marked, and differences from a chosen one in per cent |
//! | [`contact_sheet`] | the contact sheet: small drawings of all candidates side by side |
//! | [`csv`] | tables for spreadsheets and scripts |
//! | [`exact`] | the linkages through nine points (exact synthesis), in words and as a table |
//! | [`exact_sheet`] | small drawings of every real linkage through nine points, side by side |
//! | [`export`] | export of linkages to files for building them: drawings in true millimetres, cutting and printing files, lists |
//! | [`figure`] | the drawing of a scene: curve, linkage, target and labels |
//! | [`guide`] | the guide of a slider in drawings: the rail with its block, or the rod that slides through a block at a pivot |
//! | [`front`] | the front as text: a row for each member |
//! | [`function`] | the function of a candidate: its graph beside the one that is wanted, the error below, and the pairs |
//! | [`grid`] | a table of text with aligned columns, and the colours of a terminal |
//! | [`html`] | a run as an HTML page in one file: the linkage moving over its target, with every figure and verdict |
//! | [`labels`] | placement of labels beside their points, where they hide least |
//! | [`loads`] | loads of an analysis as text, as columns of a CSV, and as a chart of the torque |
//! | `loops` | the links of a six-bar or an eight-bar in drawings |
//! | [`mechanism_sheet`] | a drawing of a linkage of any kind at one position, with other positions drawn faintly and the path of its traced point |
//! | [`mechanism_text`] | an analysis of a linkage of any kind as text and as CSV |
//! | [`parts`] | the parts of drawings of linkages: stands, bars, the coupler's triangle, letters |
//! | [`picks`] | the picks beside the closest candidate, in words |
//! | `output` | the words for the output of a function: the angle of a follower or a block, or the place of a slider |
//! | [`plot`] | a small plot for the terminal: the target points and the coupler curve, with one scale for both axes |
//! | [`pose_curves`] | the circle-point and centre-point curves of four poses: where pins and fixed pivots can go |
//! | [`practicality`] | the practicality of a linkage as text: layers, distances, sensitivities |
//! | [`price`] | the costs of requirements and the relaxations that would help, in words |
//! | [`scale`] | scales of charts: figures mapped to the range from 0 to 1, in proportion or by logarithms, with round values for ticks |
//! | [`scene`] | the scene of a candidate's drawing: target points, the circuits used, and one position of the linkage |
//! | [`shop`] | the parts of a linkage that is built with shop data, as text: pins, spacers, thicknesses and rims |
//! | [`sheet`] | sheets: framed drawings with a title each, laid out on one page |
//! | [`snap`] | the cost of snapping as text: before and after, and the next best linkages |
//! | [`suite`] | a suite for the terminal and as Markdown: the same tables in two formats |
//! | [`svg`] | the drawing of one candidate: a self-contained SVG with the linkage, its coupler curve, the target and the figures |
//! | [`sweep`] | the outcome of a sweep: its table, and its plot over the varied keys |
//! | [`table`] | the output of `synth`: the candidates of a run, or one line for each file of a batch |
//! | [`text`] | formatting of numbers and foreign text for a terminal, for XML and for a spreadsheet |
//! | [`words`] | verdicts, requirements and endings in plain words |

pub mod analysis_csv;
pub mod analysis_sheets;
pub mod analysis_text;
pub mod balance;
pub mod batch_csv;
mod beside;
mod bodies;
mod body;
mod canvas;
pub mod certificate;
mod chart;
pub mod cognates_sheet;
pub mod compare;
pub mod contact_sheet;
pub mod csv;
pub mod exact;
pub mod exact_sheet;
pub mod export;
mod figure;
pub mod front;
mod function;
pub mod grid;
mod guide;
pub mod html;
mod labels;
pub mod loads;
mod loops;
pub mod mechanism_sheet;
pub mod mechanism_text;
mod output;
mod parts;
mod picks;
pub mod plot;
pub mod pose_curves;
pub mod practicality;
pub mod price;
mod scale;
pub(crate) mod scene;
mod sheet;
pub(crate) mod shop;
pub mod snap;
pub mod suite;
pub mod svg;
pub mod sweep;
pub mod table;
pub mod text;
mod words;

pub use grid::Colour;
