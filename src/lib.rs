//! linkwright finds the four-bar linkage whose coupler point draws the path you ask for.
//!
//! ```text
//!                    P                given: points T_1 .. T_n (and, if you like, the crank angle at each)
//!                   / \               found: A, B, a, b, c, d, e and the signs t1, t2 with
//!                d /   \ e
//!                 /  b  \                    sum_j |T_j - P(phi_j)|^2  least
//!                C-------D
//!             a /         \ c                and every requirement met: type, transmission angle, pivots,
//!              A-----------B                 footprint, order, circuit, branch
//! ```
//!
//! # The house
//!
//! The linkage depends on nothing, the task on the linkage; solvers are pure mathematics and depend on nothing of ours.
//! Problems put tasks into the solvers' terms, the search decides what to try, and `run` joins them. Reports are pure
//! functions of records and analyses.
//!
//! | room | what it holds | may use |
//! |---|---|---|
//! | [`linkage`] | what a four-bar is and where it is: position, gradient, mobility, transmission, curve | |
//! | [`task`] | what is wanted: paths, timing, errors, the referee | linkage |
//! | [`solve`] | numbers only: populations, Levenberg-Marquardt, convex programs, non-negative least squares, random streams | |
//! | [`resampling`] | digitised points smoothed and spread evenly | |
//! | [`problem`] | the task as mathematics: design space, residuals, reduced form of prescribed timing, requirements, fitness | linkage, task, solve, resampling |
//! | [`record`] | the truth on disk: what was asked, done and found | linkage, task, problem |
//! | [`assess`] | every figure and verdict of a candidate, recomputed | linkage, task, problem, record |
//! | [`exact`] | every linkage through nine precision points | linkage, task |
//! | [`certificate`] | a certified lower bound of the sum of squares for prescribed timing: no linkage whose input turns fully does better | linkage, task, problem, record |
//! | [`search`] | what to try: starts, rounds, plan; which answers to give: distinct ones, cognates, families, what can be built; what requirements cost, which conflict | linkage, task, solve, problem, record, assess, exact |
//! | [`mod@run`] | a job in, a record out | solve, task, problem, record, assess, certificate, search |
//! | [`live`] | answers that follow a target under the hand: warm starts, same referee; all linkages through nine points | assess, exact, problem, record, search |
//! | [`checkpoint`] | a search half done, on disk: written at its boundaries, checked before it goes on | record, run, search |
//! | [`published`] | answers from the literature, evaluated by our own referee | linkage, problem, problem_file, record, assess, search |
//! | [`suite`] | problems with a known answer, many seeds each, beside the population searches | diagnostic, problem, problem_file, record, search, run, published |
//! | [`analysis`] | what a given linkage or chain does: positions, velocities, accelerations, mobility | linkage, record |
//! | [`plates`] | the links as plates with holes: outlines, distances between them | linkage |
//! | [`mod@verify`] | is a record true? everything recomputed | linkage, task, problem, record, assess, certificate, search, run |
//! | [`problem_file`], [`points_file`], [`svg_file`], [`linkage_file`] (`input_text`, `toml_text`, `toml_values` inside) | text in, with errors that point at their place | diagnostic, generator, name, linkage, task, solve, resampling, problem, record |
//! | [`problem_template`], [`schema`], [`name`] | a file to start from, schemas for editors, what a name may be | problem_file, linkage_file, record |
//! | [`diagnostic`] | an error with file, line, caret and remedy | |
//! | [`generator`] | the mark of written files: whether a file is one that this program wrote as the same kind | |
//! | [`export`] | files to build from: drawings in millimetres, cutting and printing files, lists | generator, linkage, plates, record, report, analysis, linkage_file, toml_text, name |
//! | [`report`] | what a person sees: pure functions of the record, of an analysis or of a suite | generator, linkage, linkage_file, task, problem, record, analysis, suite, plates, practicality, snap |
//! | [`practicality`] | what stands between a linkage and a workshop: layers, clearances, sensitivity to dimensions | linkage, task, problem, record, plates |
//! | [`snap`] | lengths brought to stock sizes, the rest fitted again | practicality, linkage, problem, record, assess, search, run |
//! | [`results_folder`] | a result's folder: locked, replaced as a whole, never mixed with foreign files; files that a person named | generator, record |
//! | [`given`], [`measured`] | a result, a candidate or a linkage that is to be compared; its figures, by the referee | assess, diagnostic, linkage, linkage_file, problem, problem_file, record, report, results_folder, run, search, task, verify |
//! | [`result_files`], [`saved_run`] | what a result's folder holds; a job from its folder to its files, the same for every door | record, report, linkage_file, name, results_folder, run, search, checkpoint, certificate |
//! | `studio` (feature) | a local page that answers while a target is drawn: server, messages, tabs, jobs; no mathematics | live, run, saved_run, search, assess, verify, record, report, export, given, measured, results_folder, problem, problem_file, points_file, svg_file, diagnostic, linkage, linkage_file, name |
//! | `cli` (feature) | arguments, commands, exit codes | everything |

pub mod analysis;
pub mod assess;
pub mod certificate;
pub mod checkpoint;
#[cfg(feature = "cli")]
pub mod cli;
pub mod diagnostic;
pub mod exact;
pub mod export;
pub mod generator;
pub mod given;
mod input_text;
pub mod linkage;
pub mod linkage_file;
pub mod live;
pub mod measured;
pub mod name;
pub mod plates;
pub mod points_file;
pub mod practicality;
pub mod problem;
pub mod problem_file;
pub mod problem_template;
pub mod published;
pub mod record;
pub mod report;
pub mod resampling;
pub mod result_files;
pub mod results_folder;
pub mod run;
pub mod saved_run;
pub mod schema;
pub mod search;
pub mod snap;
pub mod solve;
#[cfg(feature = "studio")]
pub mod studio;
pub mod suite;
pub mod svg_file;
pub mod task;
mod toml_text;
mod toml_values;
pub mod verify;
