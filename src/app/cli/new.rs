//! `new`: a problem file to start from.

use super::arguments::New;
use super::{Ended, terminal};
use crate::app::results_folder::{OutputFile, Replace, write_files};
use crate::files::generator::FileKind;
use ariadne::ReportKind;
use std::path::{Path, PathBuf};

/// Runs the command.
pub fn run(options: &New) -> Ended {
    let name = options.name.strip_suffix(".toml").unwrap_or(&options.name);
    if let Err(e) = crate::files::name::check(name) {
        terminal::complain(&format!("{e}: {}", e.remedy()));
        return Ended::Refused;
    }
    // The file that is named has to be a target before a problem file may point at it.
    if let Some(from) = &options.from
        && let Err(diagnostic) = crate::files::problem_file::from_points_file(from, &[])
    {
        terminal::diagnose(ReportKind::Error, &diagnostic);
        return Ended::Refused;
    }
    // A file below the folder that we are in is named from there: the problem file can be moved with it.
    let from = options.from.as_ref().map(|path| {
        let here = std::env::current_dir().ok();
        let inside = here.as_deref().and_then(|here| path.strip_prefix(here).ok());
        inside.unwrap_or(path).display().to_string()
    });
    let text = match crate::files::problem_template::problem_template(name, from.as_deref()) {
        Ok(text) => text,
        Err(e) => {
            terminal::complain(&format!("{e}: {}", e.remedy()));
            return Ended::Refused;
        }
    };
    // What was written must run: a points file in another folder cannot be reached from the problem file.
    if let Err(diagnostic) =
        crate::files::problem_file::parse(&format!("{name}.toml"), &text, Some(Path::new("")), &[])
    {
        terminal::diagnose(ReportKind::Error, &diagnostic);
        return Ended::Refused;
    }
    let path = PathBuf::from(format!("{name}.toml"));
    let replace = if options.force { Replace::Anything } else { Replace::Nothing };
    let file = OutputFile { path: &path, kind: FileKind::Problem, bytes: text.as_bytes() };
    if let Err(e) = write_files(&[file], replace) {
        terminal::complain(&e.to_string());
        return Ended::Refused;
    }
    let shown = path.display();
    terminal::answer(&format!("Wrote {shown}. Next: linkwright synth {shown:?}\n"));
    Ended::Good
}
