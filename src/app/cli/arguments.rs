//! Commands and options, with their help texts and the checks of their values.

use super::balance::arguments::Balance;
use super::sweep::arguments::Sweep;
use crate::app::snapping::{NoKey, kept_key, length_key, set_key};
use crate::files::schema::SchemaKind;
use crate::mechanism::MAX_MAGNITUDE;
use crate::mechanism::analysis::PositionMethod;
use crate::record::{Axis, MOST_MEMBERS};
use crate::report::compare::SortKey;
use crate::report::export::Format;
use crate::synthesis::front::FrontRequest;
use crate::synthesis::snap::Length;
use crate::task::spec::{CertifySpec, MAX_CERTIFY_S};
use clap::builder::RangedI64ValueParser;
use clap::{Args, Parser, Subcommand, ValueEnum};
use std::path::PathBuf;
use std::time::Duration;

/// Finds the linkage that draws the path you ask for (a four-bar, one with a slider, a six-bar), takes a body through your poses, or
/// turns one angle into another.
#[derive(Debug, Parser)]
#[command(
    name = "linkwright",
    version,
    after_help = "Start with `linkwright new my-path`, then `linkwright synth my-path.toml`.\n\
                  Exit codes: 0 something acceptable was found, 1 nothing acceptable, 2 bad input, \
                  70 a bug, 130 interrupted (best so far saved)."
)]
pub struct Arguments {
    /// The command.
    #[command(subcommand)]
    pub command: Command,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Find linkages for problem files (or bare CSV points and SVG drawings): the main job
    Synth(Synth),
    /// Find the trade-off of a problem: linkages none of which is beaten in error, transmission angle and size together
    Front(Front),
    /// Check problem, sweep, linkage and points files without running anything
    Check(Check),
    /// Write a commented problem file that runs as it is
    New(New),
    /// Put results or linkages side by side
    Compare(Compare),
    /// Recompute the figures and verdicts of a result, and name what cannot be
    Verify(Verify),
    /// Prove that no linkage whose input turns fully is better than a result by more than a gap (prescribed timing)
    Certify(Certify),
    /// Write a result as a page to look at, print and mail: one HTML file
    Report(Report),
    /// Positions, velocities, accelerations and mobility of a linkage
    Analyze(Analyze),
    /// A spring that lets a loaded linkage stay where it is put, or counter-masses for an even torque
    Balance(Balance),
    /// The other two linkages of the same coupler curve
    Cognates(Cognates),
    /// What it takes to build a linkage: layers, least distances, sensitivity to each dimension
    Build(Build),
    /// Bring the lengths of a linkage to stock sizes and fit the rest again
    Snap(Snap),
    /// Run problems whose answer is known from many seeds, beside what was published
    Suite(Suite),
    /// Run a problem with all combinations of values of its keys: plan, run, merge
    Sweep {
        /// The part.
        #[command(subcommand)]
        part: Sweep,
    },
    /// Write a linkage as a file to build from: drawings in millimetres, DXF, STL, OpenSCAD, lists
    Export(Export),
    /// Open a local page: draw a path, drag its points, watch the best linkages follow
    #[cfg(feature = "studio")]
    Studio(Studio),
    /// Print the JSON Schema of a file, for editors, or a reference of its keys
    Schema {
        /// problem, linkage, record or sweep
        kind: SchemaKind,
        /// Print a reference page (Markdown) of its keys instead
        #[arg(long)]
        markdown: bool,
    },
    /// Print a completion script for a shell
    Completions {
        /// Which shell
        shell: clap_complete::Shell,
    },
    /// Print the manual page, for man: `linkwright man > linkwright.1`
    Man {
        /// The page of this command [default: of the program]
        command: Option<String>,
    },
}

/// Options of a search, in `synth` and `front`.
#[derive(Debug, Args)]
pub struct SearchOptions {
    /// The seed of every draw: as `--set solve.seed=..`
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = clap::value_parser!(u64).range(0..=i64::MAX as u64))]
    pub seed: Option<u64>,
    /// Threads [default: all cores]; they change the time, never a digit
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Keep where a search stands not more often than this; 0: at every boundary, whatever it costs
    #[arg(long, value_name = "SECONDS", default_value = "1", allow_negative_numbers = true, value_parser = seconds)]
    pub checkpoint_every: Duration,
}

/// Options of `synth`.
#[derive(Debug, Args)]
pub struct Synth {
    /// Problem files (TOML), points (CSV), drawings (SVG), or folders of problem files; several make a batch
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Where the results go (several files: a folder for each in it) [default: results/NAME]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// auto, least-squares, differential-evolution, genetic or continuation: as `--set solve.method=..`
    #[arg(long, value_name = "METHOD")]
    pub method: Option<String>,
    #[command(flatten)]
    pub search: SearchOptions,
    /// Set any key of the problem file, e.g. --set solve.candidates=9
    #[arg(long = "set", value_name = "KEY=VALUE", value_parser = |text: &str| pair(text, "solve.candidates=9"))]
    pub set: Vec<(String, String)>,
    /// The answers alone, not what conflicts, what can be built or what limits cost: as `--set solve.advice=false`
    #[arg(long)]
    pub no_advice: bool,
    /// Go on from the checkpoint that an interrupted run left, skip what is done
    #[arg(long)]
    pub resume: bool,
    /// Nine precision points: print every real linkage through them, not the best ones alone
    #[arg(long)]
    pub all: bool,
    /// Print the record (several files: an array of records) instead of the table
    #[arg(long)]
    pub json: bool,
    /// No progress and no picture on the terminal
    #[arg(long)]
    pub quiet: bool,
    /// The front to be computed after the search: of the command `front` alone.
    #[arg(skip)]
    pub front: Option<FrontRequest>,
}

/// Options of `front`.
#[derive(Debug, Args)]
pub struct Front {
    /// A problem file (TOML), points (CSV) or a drawing (SVG)
    pub problem: PathBuf,
    /// Two to four of rms, max, transmission, extent, longest, link_ratio, sensitivity, peak_torque
    #[arg(long, value_name = "AXIS,..", value_delimiter = ',', default_value = "rms,transmission,extent", value_parser = axis)]
    pub axes: Vec<Axis>,
    /// How many linkages
    #[arg(long, value_name = "N", default_value = "20", allow_negative_numbers = true, value_parser = clap::value_parser!(u16).range(1..=MOST_MEMBERS as i64))]
    pub points: u16,
    /// The folder of the result [default: results/NAME]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    #[command(flatten)]
    pub search: SearchOptions,
    /// Set any key of the problem file, e.g. --set require.transmission_deg_min=30
    #[arg(long = "set", value_name = "KEY=VALUE", value_parser = |text: &str| pair(text, "require.transmission_deg_min=30"))]
    pub set: Vec<(String, String)>,
    /// Go on from the checkpoint that an interrupted run left
    #[arg(long)]
    pub resume: bool,
    /// Print the record instead of the table
    #[arg(long)]
    pub json: bool,
    /// No progress on the terminal
    #[arg(long)]
    pub quiet: bool,
}

/// Reads the name of an axis.
fn axis(name: &str) -> Result<Axis, String> {
    let names = || Axis::ALL.map(Axis::name).join(", ");
    Axis::named(name).ok_or_else(|| format!("write two to four of {}", names()))
}

/// Options of `check`.
#[derive(Debug, Args)]
pub struct Check {
    /// Problem, sweep or linkage files (TOML), points (CSV) or drawings (SVG)
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
}

/// Options of `new`.
#[derive(Debug, Args)]
pub struct New {
    /// The problem's name; NAME.toml is written here
    pub name: String,
    /// Take the target from these points or poses (CSV) or this drawing (SVG)
    #[arg(long, value_name = "FILE")]
    pub from: Option<PathBuf>,
    /// What the linkage is to do [default: motion where FILE has a column angle_deg, else path]
    #[arg(long, value_enum)]
    pub task: Option<NewTask>,
    /// Replace a file that is there even where linkwright did not write it, or where this command reads it
    #[arg(long)]
    pub force: bool,
}

/// The task of a new problem file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum NewTask {
    /// A point traces a path
    Path,
    /// A body passes poses: places with angles
    Motion,
    /// An angle of the follower for each angle of the crank
    Function,
}

/// Options of `compare`.
#[derive(Debug, Args)]
pub struct Compare {
    /// Results: a folder, a record.json, either with `:2` for its second candidate, or a linkage file
    #[arg(required = true, value_name = "RESULT")]
    pub results: Vec<PathBuf>,
    /// Measure everything on the target of this problem [default: runs on their own]
    #[arg(long, value_name = "PROBLEM")]
    pub target: Option<PathBuf>,
    /// Which figures rank, the first first: sum_sq, rms, max, to_curve, transmission, link_ratio, size, extent, objective,
    /// angle_rms, angle_max
    /// [default: what the problem minimises, sum_sq where there are several]
    #[arg(long, value_name = "KEY,..", value_delimiter = ',')]
    pub sort: Vec<SortKey>,
    /// Print by how many per cent each figure is above that of this RESULT
    #[arg(long, value_name = "RESULT")]
    pub reference: Option<PathBuf>,
    /// Write the tables as CSV too
    #[arg(long, value_name = "FILE")]
    pub csv: Option<PathBuf>,
    /// Write the curves over the target as a drawing too
    #[arg(long, value_name = "FILE")]
    pub svg: Option<PathBuf>,
    /// Write a page with curves and tables too: one file, needs no network
    #[arg(long, value_name = "FILE")]
    pub html: Option<PathBuf>,
    /// Replace a file that is there even where linkwright did not write it, or where this command reads it
    #[arg(long)]
    pub force: bool,
    /// Print JSON instead of the tables
    #[arg(long)]
    pub json: bool,
}

/// Options of `verify`.
#[derive(Debug, Args)]
pub struct Verify {
    /// A result's folder or record.json
    #[arg(required = true, value_name = "RESULT")]
    pub results: Vec<PathBuf>,
    /// Work out the certificates again, box by box: as long as `certify` took
    #[arg(long)]
    pub certificate: bool,
    /// Check the leaves of the certificates (certify --leaves) with arithmetic of their own: some minutes
    #[arg(long)]
    pub leaves: bool,
}

/// Options of `certify`.
#[derive(Debug, Args)]
pub struct Certify {
    /// A result's folder
    pub result: PathBuf,
    /// How far below the best candidate the proved bound may be, relative
    #[arg(long, value_name = "G", default_value_t = CertifySpec::default().gap, allow_negative_numbers = true, value_parser = gap)]
    pub gap: f64,
    /// certify.time_limit_s=S: end after S seconds with what is proved by then [default: 300]
    #[arg(long = "set", value_name = "KEY=VALUE", value_parser = certify_key)]
    pub set: Vec<(String, f64)>,
    /// Go on from certificate.checkpoint where a run that was stopped left one
    #[arg(long)]
    pub resume: bool,
    /// Keep the decided boxes too, as certificate.leaves, for verify --leaves
    #[arg(long)]
    pub leaves: bool,
    /// No progress
    #[arg(long)]
    pub quiet: bool,
}

/// Options of `report`.
#[derive(Debug, Args)]
pub struct Report {
    /// A result's folder or record.json; `:2` shows its second candidate first
    pub result: PathBuf,
    /// Where the page goes [default: report.html in the folder, or beside a record under another name]
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Replace a file that is there even where linkwright did not write it, or where this command reads it
    #[arg(long)]
    pub force: bool,
}

/// Options of `analyze`.
#[derive(Debug, Args)]
pub struct Analyze {
    /// A linkage file (TOML), a result's folder or record.json (its first candidate), either with `:2` for another
    pub linkage: PathBuf,
    /// Crank angles, degrees from the x axis, separated by commas [default: every 30 degrees]
    #[arg(long, value_name = "DEG,..", value_delimiter = ',', allow_hyphen_values = true, value_parser = finite)]
    pub angle: Option<Vec<f64>>,
    /// This many crank angles, evenly over a full turn
    #[arg(long, value_name = "N", conflicts_with = "angle", allow_negative_numbers = true, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub cycle: Option<u32>,
    /// Speed of the crank, rad/s
    #[arg(long, value_name = "W", allow_negative_numbers = true, value_parser = finite)]
    pub omega: Option<f64>,
    /// Speed of the crank, turns a minute
    #[arg(long, value_name = "N", conflicts_with = "omega", allow_negative_numbers = true, value_parser = finite)]
    pub rpm: Option<f64>,
    /// Acceleration of the crank, rad/s^2
    #[arg(long, value_name = "A", default_value = "0", allow_negative_numbers = true, value_parser = finite)]
    pub alpha: f64,
    /// Loads in a file of their own, in place of those of the linkage file: torque, joint forces, energies
    #[arg(long, value_name = "FILE")]
    pub loads: Option<PathBuf>,
    /// Methods side by side: natural, algebraic, complex, fixed-point
    #[arg(long, value_name = "METHOD,..", value_delimiter = ',')]
    pub method: Vec<PositionMethod>,
    /// All four configurations (t1, t2), not the file's alone
    #[arg(long)]
    pub all_configurations: bool,
    /// Write every row as CSV
    #[arg(long, value_name = "FILE")]
    pub csv: Option<PathBuf>,
    /// Draw the sheets into one SVG file
    #[arg(long, value_name = "FILE")]
    pub svg: Option<PathBuf>,
    /// Replace a file that is there even where linkwright did not write it, or where this command reads it
    #[arg(long)]
    pub force: bool,
    /// Print JSON instead of the tables
    #[arg(long)]
    pub json: bool,
}

/// Options of `cognates`.
#[derive(Debug, Args)]
pub struct Cognates {
    /// A linkage file (TOML), a result's folder or record.json (its first candidate), either with `:2` for another
    pub linkage: PathBuf,
    /// The folder for the linkage files NAME-cognate-1.toml and NAME-cognate-2.toml, of a slider-crank NAME-cognate.toml [default: here]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Draw all three together: four-bars
    #[arg(long, value_name = "FILE")]
    pub svg: Option<PathBuf>,
    /// Replace a file that is there even where linkwright did not write it, or where this command reads it
    #[arg(long)]
    pub force: bool,
}

/// Options of `build`.
#[derive(Debug, Args)]
pub struct Build {
    /// A result's folder or record.json, either with `:2` for its second candidate, or a linkage file
    pub result: PathBuf,
    /// The holes' diameter, in the file's unit [default: 4 mm, without a unit a fortieth of the longest link; less where holes are near each other]
    #[arg(long, value_name = "D", allow_negative_numbers = true, value_parser = positive)]
    pub hole: Option<f64>,
    /// The diameter of the crank's hole at A, for the shaft of a motor [default: as the others]
    #[arg(long, value_name = "D", allow_negative_numbers = true, value_parser = positive)]
    pub motor_hole: Option<f64>,
    /// The diameter of the ground's hole at A, for the boss of a motor [default: as that of the crank]
    #[arg(long, value_name = "D", allow_negative_numbers = true, value_parser = positive)]
    pub boss_hole: Option<f64>,
    /// Material around a hole [default: as much as its diameter]
    #[arg(long, value_name = "M", allow_negative_numbers = true, value_parser = positive)]
    pub margin: Option<f64>,
    /// Take the diameters of joints, thicknesses of plates, pins and rims from this file, in place of the table `[shop]` of a linkage file
    #[arg(long, value_name = "FILE")]
    pub shop: Option<PathBuf>,
    /// The standard deviation of every dimension [default: 0.1 mm, without a unit a thousandth of the longest link]
    #[arg(long, value_name = "T", allow_negative_numbers = true, value_parser = positive)]
    pub tolerance: Option<f64>,
}

/// Options of `snap`.
#[derive(Debug, Args)]
#[command(group = clap::ArgGroup::new("stock").required(true).args(["grid", "lengths", "pitches"]))]
pub struct Snap {
    /// A result's folder or record.json, either with `:2` for its second candidate, or a linkage file
    pub result: PathBuf,
    /// The stock: multiples of this, in the file's unit
    #[arg(long, value_name = "S", allow_negative_numbers = true, value_parser = positive)]
    pub grid: Option<f64>,
    /// The stock: these lengths, separated by commas
    #[arg(long, value_name = "L,..", value_delimiter = ',', allow_negative_numbers = true, value_parser = positive)]
    pub lengths: Option<Vec<f64>>,
    /// The stock: the lengths in this text file, one a line or separated by commas
    #[arg(long, value_name = "FILE")]
    pub pitches: Option<PathBuf>,
    /// Snap these hole distances alone: ground, a, b, c, d, e, of a six-bar also two joints, such as X2F2 [default: all]
    #[arg(long, value_name = "KEY,..", value_delimiter = ',', value_parser = length_key)]
    pub snap: Option<Vec<Length>>,
    /// Keep these exactly as they are: hole distances, A, B, ground_angle_deg, of a six-bar also its third pivot, such as Y2
    #[arg(long, value_name = "KEY,..", value_delimiter = ',', value_parser = kept_key)]
    pub keep: Vec<String>,
    /// Put a dimension at a value of its own: a hole distance, ground_angle_deg
    #[arg(long = "set", value_name = "KEY=VALUE", value_parser = dimension)]
    pub set: Vec<(String, f64)>,
    /// Where the result goes: a folder, or FILE.toml for the best linkage alone [default: results/NAME-snapped]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Replace a file that is there even where linkwright did not write it, or where this command reads it
    #[arg(long)]
    pub force: bool,
}

/// Options of `suite`.
#[derive(Debug, Args)]
pub struct Suite {
    /// Only problems whose name or file name holds this
    pub filter: Option<String>,
    /// Run the problem files of this folder that have `best_known_sum_sq` (paths) or `objective` (motions) in `[expect]`
    /// [default: problems/literature where it is here, else the same files, which linkwright holds]
    #[arg(long, value_name = "DIR")]
    pub problems: Option<PathBuf>,
    /// Seeds 1 to N for each problem
    #[arg(long, value_name = "N", default_value_t = 10, allow_negative_numbers = true, value_parser = RangedI64ValueParser::<u64>::new().range(1..=100_000))]
    pub seeds: u64,
    /// Prove the best answer of each problem that can be proved, within 0.01 % or 300 s each
    #[arg(long)]
    pub certify: bool,
    /// Print JSON instead of the tables
    #[arg(long)]
    pub json: bool,
    /// Write results/literature.md and results/literature.json too, or with --problems the files of that folder's name (all
    /// problems, no FILTER): for linkwright's repository
    #[arg(long, conflicts_with = "filter")]
    pub write: bool,
    /// Replace a file that is there even where linkwright did not write it, or where this command reads it
    #[arg(long)]
    pub force: bool,
}

/// Options of `studio`.
#[cfg(feature = "studio")]
#[derive(Debug, Args)]
pub struct Studio {
    /// Begin with the target and the requirements of this problem file, points (CSV), drawing (SVG) or report (HTML)
    pub problem: Option<PathBuf>,
    /// The port on 127.0.0.1, 0 for any free one [default: 8017, or a free one where that is taken]
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub port: Option<u16>,
    /// Save jobs in folders inside of DIR, and list the results that are there [default: results]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Open no browser: print the address alone
    #[arg(long)]
    pub no_open: bool,
}

/// Options of `export`.
#[derive(Debug, Args)]
pub struct Export {
    /// A result's folder or record.json (its first candidate), either with `:2` for another, or a linkage file
    pub result: PathBuf,
    /// svg, svg-plates, dxf, dxf-plates, stl, scad, csv, toml, json, cut-list or cut-list-csv
    #[arg(long, value_name = "FORMAT")]
    pub format: Format,
    /// Set a size or the scale, e.g. --set hole_mm=4
    #[arg(long = "set", value_name = "KEY=VALUE", value_parser = |text: &str| pair(text, "hole_mm=4"))]
    pub set: Vec<(String, String)>,
    /// Take the diameters of joints, thicknesses of plates, pins and rims from this file, in place of the table `[shop]` of a linkage file
    #[arg(long, value_name = "FILE")]
    pub shop: Option<PathBuf>,
    /// Write it to this file [default: to standard output]
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Replace a file that is there even where linkwright did not write it, or where this command reads it
    #[arg(long)]
    pub force: bool,
}

/// The reason why a value of an option is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub(super) enum ValueError {
    #[error("this is not a number")]
    NotANumber,
    #[error("a finite number below {MAX_MAGNITUDE:e} in magnitude is needed")]
    TooLarge,
    #[error("a number above 0 is needed")]
    NotPositive,
    #[error("a gap is between 0 and 1, such as 1e-4 for a hundredth of a per cent")]
    Gap,
    #[error("at most {MAX_CERTIFY_S:e} seconds")]
    TooLong,
    #[error("a number of seconds is wanted, such as 0.5 or 60")]
    NotSeconds,
    #[error("it is from 0 to 86400 seconds")]
    NotWithinADay,
    #[error("write KEY=VALUE, for example {0}")]
    NotAPair(&'static str),
    #[error("what can be set is certify.time_limit_s")]
    NotOfCertify,
    #[error(transparent)]
    Key(#[from] NoKey),
}

pub(super) fn finite(text: &str) -> Result<f64, ValueError> {
    let number: f64 = text.trim().parse().map_err(|_| ValueError::NotANumber)?;
    if number.abs() <= MAX_MAGNITUDE { Ok(number) } else { Err(ValueError::TooLarge) }
}

fn positive(text: &str) -> Result<f64, ValueError> {
    Some(finite(text)?).filter(|number| *number > 0.0).ok_or(ValueError::NotPositive)
}

fn gap(text: &str) -> Result<f64, ValueError> {
    Some(positive(text)?).filter(|number| *number < 1.0).ok_or(ValueError::Gap)
}

fn certify_key(text: &str) -> Result<(String, f64), ValueError> {
    let (key, value) = pair(text, "certify.time_limit_s=60")?;
    if key != "certify.time_limit_s" {
        return Err(ValueError::NotOfCertify);
    }
    let seconds = positive(&value)?;
    if seconds <= MAX_CERTIFY_S { Ok((key, seconds)) } else { Err(ValueError::TooLong) }
}

fn dimension(text: &str) -> Result<(String, f64), ValueError> {
    let (key, value) = pair(text, "a=2.5")?;
    let number = if set_key(&key)? { positive(&value)? } else { finite(&value)? };
    Ok((key, number))
}

fn pair(text: &str, example: &'static str) -> Result<(String, String), ValueError> {
    match text.split_once('=') {
        Some((key, value)) if !key.trim().is_empty() => Ok((key.trim().into(), value.trim().into())),
        _ => Err(ValueError::NotAPair(example)),
    }
}

/// A time of at most a day.
fn seconds(text: &str) -> Result<Duration, ValueError> {
    let seconds: f64 = text.parse().map_err(|_| ValueError::NotSeconds)?;
    let within = (0.0..=86400.0).contains(&seconds);
    within.then(|| Duration::from_secs_f64(seconds)).ok_or(ValueError::NotWithinADay)
}
