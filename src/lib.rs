//! linkwright finds the linkage whose point draws the path you ask for (a four-bar, one with a slider, or a six-bar), and the
//! four-bar that takes a body through poses, or turns one angle into another.
//!
//! ```text
//!                    P                given: points T_1 .. T_n (and, if you like, the crank angle at each)
//!                   / \               found: A, B, a, b, c, d, e, the assembly t1 and the side t2 of P with
//!                d /   \ e
//!                 /  b  \                    sum_j |T_j - P(phi_j)|^2  least (or the largest deviation)
//!                C-------D
//!             a /         \ c                and every requirement met: type, transmission angle, link ratio,
//!              A-----------B                 pivots, footprint, order, circuit, branch
//! ```
//!
//! ```
//! use linkwright::spec::RequireSpec;
//! use linkwright::{Context, ExportFormat, ExportSettings, ExportSubject, Job, Problem, export, run};
//! use std::sync::atomic::AtomicBool;
//!
//! let points = vec![[0.0, 0.0], [1.0, 1.0], [2.0, 1.5], [3.0, 1.0]];
//! let require = RequireSpec { transmission_deg_min: Some(30.0), ..RequireSpec::default() };
//! let job = Job::new("arc", Problem::builder(points).require(require).spec()?);
//! let context = Context { cancel: &AtomicBool::new(false), observer: &|_| {} };
//! let record = run(&job, &context)?.record;
//! let best = &record.candidates[0];
//! assert!(best.accepted && best.error.rms < 1e-9);
//! let [ground, crank, coupler, follower] = best.linkage.four_bar().expect("four-bars were asked for").links();
//! assert!(ground.min(crank).min(coupler).min(follower) > 0.0);
//! let settings = ExportSettings { scale: Some(20.0), unit: Some(linkwright::Unit::Mm), ..Default::default() };
//! let drawing = export(&ExportSubject::of_candidate(&record, best), ExportFormat::Dxf, &settings)?;
//! assert!(!drawing.bytes.is_empty());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # The layers
//!
//! Nine layers ("storeys"), each one folder of `src/`; outside tests, a layer uses only the layers that its row names.
//! `mod.rs` of a layer lists its modules; a module is the file `x.rs` or the folder `x/`.
//!
//! | layer | holds | may use |
//! |---|---|---|
//! | `numbers` | packages of their own that use nothing of this one: `arithmetic/` (lanes, double-double numbers, random streams), `optimise/` (least squares, population searches, convex programs), `nine_point/` (all four-bars through nine points, or through poses, points and given pivots, and all linkages with a slider through eight points, by homotopy continuation), `bound/` (lower bounds by branch and bound), `checker/` (checks the proofs of `bound` independently), `leaves/` (the file format of those proofs) | |
//! | `mechanism` | what a linkage is and where it is: the [`four_bar`](internals::mechanism::four_bar) (position, gradient, mobility, transmission angle, coupler curve, cognates), the [`slider_crank`](internals::mechanism::slider_crank) and the [`inverted_slider_crank`](internals::mechanism::inverted_slider_crank), six-bars and eight-bars by the lengths of their links ([`multi_loop`](internals::mechanism::multi_loop)), all of them behind one type ([`crank_linkage`](internals::mechanism::crank_linkage)), the [`chain`](internals::mechanism::chain), the [`dyad_chain`](internals::mechanism::dyad_chain) (six-bars, eight-bars in the unknowns of a search), the trait that [`any`](internals::mechanism::any) of them implements, their [`analysis`](internals::mechanism::analysis), the [`dyad`](internals::mechanism::dyad) that guides a body through poses, their [`plates`](internals::mechanism::plates), their bodies and pairs ([`structure`](internals::mechanism::structure)) and the [`loads`](internals::mechanism::loads) on them: torques, joint forces, energies | numbers |
//! | `task` | what is wanted: the path, the motion or the function, the [`spec`](internals::task::spec) with every key of a problem file, the checked [`Problem`], the [list of requirements](internals::task::requirement), and the task as mathematics in [`forms`](internals::task::forms) (design space, residuals, [rows of the requirements](internals::task::forms::rows)) | numbers, mechanism |
//! | `record` | the record of a run: what was asked, done and found; its front and its picks | numbers, mechanism, task |
//! | `judge` | verdicts: the [`referee`](internals::judge::referee) (order, circuit and branch defects), [`assess`](internals::judge::assess) (every figure of a candidate), ranking, warnings, cognates, costs, trade-offs, [`certificate`](internals::judge::certificate), [`practicality`](internals::judge::practicality), and [`verify`](internals::judge::verify), which recomputes a record | numbers, mechanism, task, record |
//! | `synthesis` | the search: its [`plan`](internals::synthesis::plan), the canonical frame of free timing, starts, the [`dyads`](internals::synthesis::dyads) through poses and the [curves of four poses](internals::synthesis::pose_curves), the starts of functions, the [`atlas`](internals::synthesis::atlas) of coupler curves, searches for prescribed (by [`variable_projection`](internals::synthesis::variable_projection)) and [`free`](internals::synthesis::free) timing, population searches, the [`front`](internals::synthesis::front) and the [`picks`](internals::synthesis::picks) by fits under tightened limits, [`conflicts`](internals::synthesis::conflicts) of requirements, the families of exact answers, fitting while a target is dragged, rounding lengths to stock sizes; linkages with a slider; the [`dyad_chains`](internals::synthesis::dyad_chains) that draw a path, for the problems that ask for six-bars ([`several_loops`](internals::synthesis::several_loops)); its limits and its cancellation | numbers, mechanism, task, record, judge |
//! | `files` | file formats: problem, points, linkage, loads, shop and drawing files are read, with errors that point at their place; schemas, templates | numbers, mechanism, task, record |
//! | `report` | what a person sees, pure functions of records and analyses: text, tables, drawings, the [page](internals::report::html), the [comparison](internals::report::compare), and files to build from in [`export`](internals::report::export) (DXF, STL, ..) | mechanism, task, record, judge, synthesis, files |
//! | `app` | entry points: a job in, a record out ([`run`](internals::app::job::run)), folders of results and checkpoints, the [`suite`](internals::app::suite), [sweeps](internals::app::sweep), the command line in `cli/` (Ctrl-C, exit codes), the local page in `studio/` | everything |
//!
//! The public interface is the names below. `internals` is for this repository's own tests and tools; versions say nothing
//! about it.

mod app;
mod files;
mod judge;
mod mechanism;
mod numbers;
mod record;
mod report;
mod synthesis;
mod task;
#[cfg(test)]
#[path = "../tests/common/thorough.rs"]
mod thorough;

pub use app::job::run::{Context, Finished, Job, RunError, prove, run};
pub use files::diagnostic::Diagnostic;
pub use files::linkage_file::{
    AnyLinkageFile, LinkageFile, load_any as load_linkage, parse_any as parse_linkage,
    to_toml as linkage_to_toml,
};
pub use files::problem_file::{ProblemFile, load_any as load_problem, parse as parse_problem};
pub use judge::certificate::{NoCertificate, Request as CertificateRequest, certify};
pub use judge::verify::{Mismatch, verify};
pub use mechanism::four_bar::cognate::Cognate;
pub use mechanism::{
    AssemblyMode, Chain, ChainBuilder, Complex, CouplerCurve, CouplerSide, CrankLinkage, FourBar,
    InvertedSliderCrank, InvertedSliderCrankParameters, Joints, Linkage, LinkageError, LinkageKind,
    LinkageType, Mobility, NaturalCoordinates, Position, SliderCrank, SliderCrankParameters, SliderLinkage,
    Unit, VectorLoop,
};
pub use record::{Candidate, Certificate, Record};
pub use report::export::{
    Exported, Format as ExportFormat, Refusal as ExportRefusal, Settings as ExportSettings,
    Subject as ExportSubject, export,
};
pub use report::html::report_html;
pub use synthesis::{Observer, Progress};
pub use task::{AngleOffset, Defect, Problem, ProblemBuilder, Sense, Task, TaskError, TaskOptions, Timing};

/// Problems as data: every key of a problem file.
pub mod spec {
    pub use crate::task::region::Region;
    pub use crate::task::spec::{
        BodySpec, CertifySpec, ClosingPolicy, DesignSpec, DirectionPolicy, FormulaSpec, Limits, Method,
        Objective, OnePolicy, OrderPolicy, OutputSpec, ProblemSpec, RequireSpec, SolveSpec, TaskSpec,
        TimingSpec, TransmissionOver, Variables,
    };
}

/// The parts of a record.
pub mod results {
    pub use crate::record::digest::ProblemError;
    pub use crate::record::{
        CurveErrorRecord, ErrorRecord, ExactLinkage, ExactRecord, Figure, Reason, Requirement, Termination,
        Warning, WarningKind,
    };
}

/// Many problems that are one problem with different values of some keys: a plan, shards, merged rows.
pub mod sweep {
    pub use crate::app::sweep::{
        How, Merged, PlanOptions, Ran, ShardDone, SweepError, merge, open, plan, run_missing, run_shard,
    };
    pub use crate::record::sweep::{Plan, Row, Values, Varied};
}

/// Positions, velocities, accelerations and mobility of a given linkage.
pub mod analysis {
    pub use crate::mechanism::analysis::{Analysis, PositionMethod, Request, analyze};
    pub use crate::mechanism::four_bar::motion::CrankMotion;
}

/// The example of the README, compiled and run.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

/// All layers, for this repository's integration tests, benchmarks, fuzz targets and commands.
#[doc(hidden)]
pub mod internals {
    macro_rules! layers {
        ($($name:ident),*) => {
            $(
                #[doc = concat!("The layer `", stringify!($name), "`.")]
                pub mod $name {
                    pub use crate::$name::*;
                }
            )*
        };
    }
    layers!(numbers, mechanism, task, record, judge, synthesis, files, report, app);
}
