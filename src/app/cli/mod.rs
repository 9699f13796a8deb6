//! The command line: arguments, commands, exit codes.
//!
//! stdout carries the answer, stderr progress and diagnostics. Exit codes: 0 done, 1 ran but nothing is
//! acceptable (or a check failed), 2 bad input or usage, 70 a bug of ours, 130 interrupted.
//!
//! | module | holds |
//! |---|---|
//! | [`analyze`] | `analyze` and `cognates`: motion of a given linkage, and the other linkages of its curve |
//! | [`mod@arguments`] | commands and options, with their help texts and the checks of their values |
//! | [`balance`] | `balance`: a spring that lets a linkage stay where it is put, or counter-masses |
//! | [`build`] | `build`: layers, distances and sensitivities of a linkage that is to be built |
//! | [`certify`] | `certify`: lower bounds of the error, by branch and bound |
//! | [`check`] | `check`: reads files and reports their faults without running anything |
//! | [`compare`] | `compare`: results and linkages side by side |
//! | [`error`] | errors of commands, apart from those that another layer names |
//! | [`export`] | `export`: a linkage as a file to build from |
//! | [`front`] | `front`: the trade-off between error, transmission angle, size and other figures |
//! | [`inputs`] | inputs of `synth`: files and folders of problem files, each with the folder of its result |
//! | [`interrupt`] | signals |
//! | `keyboard` | Enter, pressed at the terminal while a command runs |
//! | [`man`] | `man`: the manual pages, made from the same definitions that `--help` is made from |
//! | [`new`] | `new`: a problem file to start from |
//! | [`output`] | output files at places that a user names: files of other origin are kept, unless `--force` |
//! | [`progress`] | a bar on a terminal, plain lines otherwise; nothing for work that is over before one could read it |
//! | [`report`] | `report`: a result as a page, from its record alone |
//! | [`result`] | RESULT on the command line: a folder, its record.json, either with `:2` for one candidate (or `:buildable`, `:smallest`, `:best-transmission`, `:front-2`), or a linkage file |
//! | [`snap`] | `snap`: lengths brought to stock sizes |
//! | [`studio`] | `studio`: a local page that answers while a target is drawn |
//! | [`suite`] | `suite`: problems whose answer is known, from many seeds |
//! | [`sweep`] | `sweep`: many problems that are one problem with different values of some keys |
//! | [`synth`] | `synth`: problems in, results out |
//! | [`terminal`] | writing to the two streams, and how colourful the terminal is |
//! | [`verify`] | `verify`: recompute a result |

mod analyze;
mod arguments;
mod balance;
mod build;
mod certify;
mod check;
mod compare;
mod error;
mod export;
mod front;
mod inputs;
mod interrupt;
#[cfg(feature = "studio")]
mod keyboard;
mod man;
mod new;
mod output;
mod progress;
mod report;
mod result;
mod snap;
#[cfg(feature = "studio")]
mod studio;
mod suite;
mod sweep;
mod synth;
mod terminal;
mod verify;

use crate::app::job::folder::FolderError;
use crate::files::diagnostic::Diagnostic;
use crate::files::schema::{reference, schema};
use arguments::{Arguments, Command};
use ariadne::ReportKind;
use clap::{CommandFactory, Parser};
use std::ffi::OsString;
use std::fmt::Display;
use std::io;
use std::panic::catch_unwind;
use std::path::Path;
use std::process::ExitCode;

/// The end of a command, as its exit code; the gravest is the last: of several inputs the gravest is that of the command.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Ended {
    /// Done, and something acceptable was found or the check passed.
    Good = 0,
    /// It ran, but nothing is acceptable or the check failed.
    Bad = 1,
    /// Bad input or usage.
    Refused = 2,
    /// A bug of ours; the other parts of a batch ran.
    Bug = 70,
    /// Interrupted; the best so far is saved.
    Interrupted = 130,
}

/// Complains of the reason for which a command refuses its input.
fn refuse(why: impl Display) -> Ended {
    terminal::complain(&why.to_string());
    Ended::Refused
}

/// Complains of the reason for which a file or a folder is refused.
fn refuse_path(path: &Path, why: impl Display) -> Ended {
    refuse(format!("{}: {why}", path.display()))
}

/// Complains of a path that the system refuses, with the remedy.
fn refuse_io(path: &Path, source: io::Error) -> Ended {
    refuse(FolderError::Io { path: path.display().to_string(), source })
}

/// Shows the place at which an input is refused.
fn refuse_at(diagnostic: Box<Diagnostic>) -> Ended {
    terminal::diagnose(ReportKind::Error, &diagnostic);
    Ended::Refused
}

/// Runs the command that the process was called with.
pub fn main() -> ExitCode {
    ExitCode::from(main_of(std::env::args_os()))
}

/// Runs the command of these words, the first of which is the program's name, and returns its exit code.
pub fn main_of(words: impl IntoIterator<Item = OsString>) -> u8 {
    interrupt::outlive_large_files();
    let words: Vec<OsString> = words.into_iter().collect();
    let run =
        || arguments(&words).and_then(|arguments| dispatch(arguments.command)).unwrap_or_else(|ended| ended);
    let ended = match catch_unwind(run) {
        Ok(Ended::Good) if terminal::lost() => Ended::Refused,
        Ok(ended) => ended,
        Err(_) => {
            terminal::complain("this is a bug of linkwright: please report it with the input that shows it");
            Ended::Bug
        }
    };
    ended as u8
}

/// Returns what was typed. Help that was asked for is printed as an answer.
fn arguments(words: &[OsString]) -> Result<Arguments, Ended> {
    Arguments::try_parse_from(words).map_err(|e| {
        let printed = e.print();
        if e.use_stderr() {
            return Ended::Refused;
        }
        terminal::note(printed);
        Ended::Good
    })
}

fn dispatch(command: Command) -> Result<Ended, Ended> {
    match command {
        Command::Synth(options) => synth::run(&options),
        Command::Front(options) => front::run(options),
        Command::Check(options) => check::run(&options),
        Command::New(options) => new::run(&options),
        Command::Compare(options) => compare::run(&options),
        Command::Verify(options) => verify::run(&options),
        Command::Analyze(options) => analyze::run(&options),
        Command::Balance(options) => balance::run(&options),
        Command::Cognates(options) => analyze::cognates(&options),
        Command::Certify(options) => certify::run(&options),
        Command::Report(options) => report::run(&options),
        Command::Build(options) => build::run(&options),
        Command::Snap(options) => snap::run(&options),
        Command::Suite(options) => suite::run(&options),
        Command::Sweep { part } => sweep::run(&part),
        Command::Export(options) => export::run(&options),
        #[cfg(feature = "studio")]
        Command::Studio(options) => studio::run(&options),
        Command::Schema { kind, markdown } => {
            let text = if markdown { reference(kind) } else { format!("{:#}\n", schema(kind)) };
            terminal::answer(&text);
            Ok(Ended::Good)
        }
        Command::Completions { shell } => {
            let mut script = Vec::new();
            clap_complete::generate(shell, &mut Arguments::command(), "linkwright", &mut script);
            terminal::answer(&String::from_utf8_lossy(&script));
            Ok(Ended::Good)
        }
        Command::Man { command } => man::run(command.as_deref()),
    }
}
