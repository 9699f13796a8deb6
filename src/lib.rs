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
//! ```
//! use linkwright::{Context, Job, parse_problem, run};
//! use std::sync::atomic::AtomicBool;
//! let text = "format = 1\n[task.path]\npoints = [[0, 0], [1, 1], [2, 1.5], [3, 1]]\n";
//! let file = parse_problem("path.toml", text, None, &[]).map_err(|e| e.to_string())?;
//! let context = Context { cancel: &AtomicBool::new(false), observer: &|_| {} };
//! let record = run(&Job::from(file), &context)?.record;
//! assert!(record.candidates[0].accepted && record.candidates[0].error.rms < 1e-9);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # The house
//!
//! Nine storeys, each one folder of `src/`; a storey uses only the storeys that its row names. `mod.rs` of a storey lists
//! its rooms.
//!
//! | storey | what it holds | may use |
//! |---|---|---|
//! | `numbers` | numerical mathematics that knows nothing of linkages, a package for each subject: [`arithmetic`](internals::numbers::arithmetic) (lanes, double-double, random streams), [`optimise`](internals::numbers::optimise) (least squares, populations, convex programs), [`nine_point`](internals::numbers::nine_point) (path tracking), [`bound`](internals::numbers::bound) (branch and bound), [`checker`](internals::numbers::checker) (the check of its proofs, without its code) and [`leaves`](internals::numbers::leaves) (their file) | |
//! | `mechanism` | what a linkage is and where it is: the [`four_bar`](internals::mechanism::four_bar) (position, gradient, mobility, transmission angle, coupler curve, cognates), the [`chain`](internals::mechanism::chain), their [`analysis`](internals::mechanism::analysis), their [`plates`](internals::mechanism::plates) | numbers |
//! | `task` | what is wanted: the path, the [`spec`](internals::task::spec) with every key of a problem file, the checked [`Problem`], and the task as mathematics in [`forms`](internals::task::forms) (design space, residuals, [rows of the requirements](internals::task::forms::requirements)) | numbers, mechanism |
//! | `record` | the truth on disk: what was asked, done and found | numbers, mechanism, task |
//! | `judge` | is it so: the [`referee`](internals::judge::referee) (order, circuit and branch defects), [`assess`](internals::judge::assess) (every figure of a candidate), ranking, warnings, cognates, costs, [`certificate`](internals::judge::certificate), [`practicality`](internals::judge::practicality), and [`verify`](internals::judge::verify), which recomputes a record | numbers, mechanism, task, record |
//! | `synthesis` | what to try: the [`plan`](internals::synthesis::plan) of a search, starts, the [`atlas`](internals::synthesis::atlas) of coupler curves, searches for [`timed`](internals::synthesis::timed) and [`free`](internals::synthesis::free) timing, populations, [`conflicts`](internals::synthesis::conflicts), live fitting, snapping | numbers, mechanism, task, record, judge |
//! | `files` | text in: problem, points, linkage and drawing files, schemas, and errors that point at their place | numbers, mechanism, task, record |
//! | `report` | what a person sees, pure functions of records and analyses: text, tables, drawings, the [page](internals::report::html), the [comparison](internals::report::compare), and files to build from in [`export`](internals::report::export) (DXF, STL, ..) | mechanism, task, record, judge, synthesis, files |
//! | `app` | the doors: a job in, a record out ([`run`](internals::app::job::run)), folders of results, checkpoints, the [`suite`](internals::app::suite), the command line (feature `cli`), the studio (feature `studio`) | everything |
//!
//! Public are the names below; `internals` holds the rest for this repository's own tests and tools, and versions say
//! nothing about it.

mod app;
mod files;
mod judge;
mod mechanism;
mod numbers;
mod record;
mod report;
mod synthesis;
mod task;

pub use app::job::run::{Context, Finished, Job, RunError, run};
pub use files::diagnostic::Diagnostic;
pub use files::linkage_file::{
    AnyLinkageFile, load_any as load_linkage, parse_any as parse_linkage, to_toml as linkage_to_toml,
};
pub use files::problem_file::{ProblemFile, load_any as load_problem, parse as parse_problem};
pub use judge::certificate::{NoCertificate, Request as CertificateRequest, certify};
pub use judge::verify::{Mismatch, verify};
pub use mechanism::analysis::{Analysis, Request as AnalysisRequest, analyze};
pub use mechanism::four_bar::cognate::Cognate;
pub use mechanism::{
    AssemblyMode, Chain, ChainBuilder, Complex, CouplerCurve, CouplerSide, FourBar, Joints, Linkage,
    LinkageError, LinkageType, Mobility, NaturalCoordinates, Position, Unit, VectorLoop,
};
pub use record::{Candidate, Certificate, Record};
pub use report::export::{
    Exported, Format as ExportFormat, Settings as ExportSettings, Subject as ExportSubject, export,
};
pub use report::html::report_html;
pub use synthesis::{Observer, Progress};
pub use task::spec::ProblemSpec;
pub use task::{AngleOffset, Defect, PathTask, Problem, TaskError, Timing};

/// All rooms, for this repository's integration tests, benchmarks, fuzz targets and commands.
#[doc(hidden)]
pub mod internals {
    macro_rules! storeys {
        ($($name:ident: $doc:literal),*) => {
            $(
                #[doc = $doc]
                pub mod $name {
                    pub use crate::$name::*;
                }
            )*
        };
    }
    storeys! {
        numbers: "Numerical mathematics.",
        mechanism: "Mechanisms.",
        task: "Tasks.",
        record: "Records.",
        judge: "The judge.",
        synthesis: "Searches.",
        files: "Text in.",
        report: "Text and drawings out.",
        app: "Doors."
    }
}
