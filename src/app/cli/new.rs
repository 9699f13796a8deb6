//! `new`: a problem file to start from.

use super::arguments::{New, NewTask};
use super::{Ended, refuse, refuse_at, terminal};
use crate::app::job::folder::{OutputFile, Replace, write_files};
use crate::files::diagnostic::quoted;
use crate::files::generator::FileKind;
use crate::files::name;
use crate::files::problem_file::{from_points_file, holds_pairs, holds_poses, is_drawing, parse};
use crate::files::problem_template::problem_template;
use crate::task::TaskKind;
use std::path::{Path, PathBuf};

/// Runs the command.
pub fn run(options: &New) -> Result<Ended, Ended> {
    let name = options.name.strip_suffix(".toml").unwrap_or(&options.name);
    let not_a_name = |e: name::NameError| refuse(format!("{e}: {}", e.remedy()));
    name::check(name).map_err(not_a_name)?;
    let task = task_of(options)?;
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
    let text = problem_template(name, task, from.as_deref()).map_err(not_a_name)?;
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

/// Returns the task that is asked for; where it is silent, a file of poses makes a motion.
fn task_of(options: &New) -> Result<TaskKind, Ended> {
    let from = options.from.as_deref();
    let poses = from.is_some_and(holds_poses);
    let pairs = from.is_some_and(holds_pairs);
    match options.task {
        None if pairs => Ok(TaskKind::Function),
        Some(NewTask::Function) => match from.filter(|path| !pairs && path.exists()) {
            None => Ok(TaskKind::Function),
            Some(path) => Err(refuse(format!(
                "{} has no pairs of a function: write them as a CSV with the columns input_deg,output_deg",
                quoted(&path.display().to_string())
            ))),
        },
        Some(NewTask::Path | NewTask::Motion) if pairs => Err(refuse(
            "the file holds pairs of a function (a column input_deg): write --task function, or leave --task out",
        )),
        Some(NewTask::Path) => Ok(TaskKind::Path),
        None if !poses => Ok(TaskKind::Path),
        None => Ok(TaskKind::Motion),
        Some(NewTask::Motion) => match from.filter(|path| !poses && path.is_file()) {
            None => Ok(TaskKind::Motion),
            Some(path) if is_drawing(path) => Err(refuse(format!(
                "{} is a drawing, which has no angles of a body: write the poses as a CSV with the columns x,y,angle_deg",
                quoted(&path.display().to_string())
            ))),
            Some(path) => Err(refuse(format!(
                "{} has no column angle_deg: add it; an empty cell asks for the place alone",
                quoted(&path.display().to_string())
            ))),
        },
    }
}
