//! `new`: a problem file to start from.

use super::arguments::New;
use super::{Ended, refuse, refuse_at, terminal};
use crate::app::job::folder::{OutputFile, Replace, write_files};
use crate::files::generator::FileKind;
use crate::files::name;
use crate::files::problem_file::{from_points_file, parse};
use crate::files::problem_template::problem_template;
use std::path::{Path, PathBuf};

/// Runs the command.
pub fn run(options: &New) -> Result<Ended, Ended> {
    let name = options.name.strip_suffix(".toml").unwrap_or(&options.name);
    let not_a_name = |e: name::NameError| refuse(format!("{e}: {}", e.remedy()));
    name::check(name).map_err(not_a_name)?;
    // The file that is named has to be a target before a problem file may point at it.
    if let Some(from) = &options.from {
        from_points_file(from, &[]).map_err(refuse_at)?;
    }
    // A file below the folder that we are in is named from there: the problem file can be moved with it.
    let from = options.from.as_ref().map(|path| {
        let here = std::env::current_dir().ok();
        let inside = here.as_deref().and_then(|here| path.strip_prefix(here).ok());
        inside.unwrap_or(path).display().to_string()
    });
    let text = problem_template(name, from.as_deref()).map_err(not_a_name)?;
    let path = PathBuf::from(format!("{name}.toml"));
    let shown = path.display();
    // A written file must run: a points file in another folder cannot be reached from the problem file.
    parse(&shown.to_string(), &text, Some(Path::new("")), &[]).map_err(refuse_at)?;
    let replace = if options.force { Replace::Anything } else { Replace::Nothing };
    let file = OutputFile { path: &path, kind: FileKind::Problem, bytes: text.as_bytes() };
    write_files(&[file], replace).map_err(refuse)?;
    terminal::answer(&format!("Wrote {shown}. Next: linkwright synth {shown:?}\n"));
    Ok(Ended::Good)
}
