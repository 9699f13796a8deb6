//! `compare`: results and linkages side by side.

use super::arguments::Compare;
use super::output::{Form, Output};
use super::result;
use super::result::{Given, Which};
use super::{Ended, refuse, refuse_at, terminal};
use crate::app::comparison::{NotCompared, Target, compared, label_of_file};
use crate::files::diagnostic::escaped;
use crate::files::generator::FileKind;
use crate::files::problem_file;
use crate::report::compare::Comparison;
use std::path::Path;

/// Runs the command.
pub fn run(options: &Compare) -> Result<Ended, Ended> {
    let target = options.target.as_deref().map(target_of).transpose()?;
    let read = options.results.iter().map(|argument| Ok((argument.as_path(), result::read(argument)?)));
    let mut given = read.collect::<Result<Vec<_>, Ended>>()?;
    let reference = options.reference.as_deref().map(|name| reference(name, &mut given)).transpose()?;
    let comparison = match compared(&given, target.as_ref(), &options.sort, reference.as_deref()) {
        Ok(comparison) => comparison,
        Err(NotCompared::Nothing(left_out)) => {
            for out in &left_out {
                terminal::complain(&format!("{}: {}", out.label, out.why));
            }
            terminal::complain("none of these results has a candidate to compare");
            return Ok(Ended::Bad);
        }
        Err(why) => return Err(refuse(why)),
    };
    deliver(options, &comparison)
}

/// The target of a problem file.
fn target_of(path: &Path) -> Result<Target, Ended> {
    let file = problem_file::load(path, &[]).map_err(refuse_at)?;
    Target::new(file).map_err(refuse)
}

/// Returns the label in the tables of the result that the differences are from. It is read and put to the others if it is
/// none of them.
fn reference<'a>(name: &'a Path, given: &mut Vec<(&'a Path, Given)>) -> Result<String, Ended> {
    let typed = name.display().to_string();
    let labels = |given: &Given, path: &Path| match given {
        Given::Run(run) => run.chosen().into_iter().map(|chosen| chosen.label).collect(),
        Given::Linkage(file) => vec![path.display().to_string(), file.name.clone()],
    };
    for (i, (path, one)) in given.iter().enumerate() {
        let labels = labels(one, path);
        if *path == name || labels.contains(&typed) {
            return Ok(match one {
                Given::Linkage(_) => label_of_file(given, i),
                Given::Run(_) if labels.contains(&typed) => typed,
                Given::Run(run) => run.one()?.label,
            });
        }
    }
    match result::read(name)? {
        Given::Run(mut run) => {
            let label = run.one()?.label;
            if run.which == Which::All {
                run.which = Which::Rank(1);
            }
            if !given.iter().any(|(path, one)| labels(one, path).contains(&label)) {
                given.push((name, Given::Run(run)));
            }
            Ok(label)
        }
        linkage => {
            given.push((name, linkage));
            Ok(label_of_file(given, given.len() - 1))
        }
    }
}

/// Writes the files that were asked for and prints the tables or JSON.
fn deliver(options: &Compare, comparison: &Comparison) -> Result<Ended, Ended> {
    let forms: [Form<'_>; 3] = [
        (&options.csv, FileKind::Csv, &|| comparison.csv()),
        (&options.svg, FileKind::Svg, &|| comparison.svg()),
        (&options.html, FileKind::Html, &|| comparison.html()),
    ];
    let inputs = options.results.iter().chain(&options.target).chain(&options.reference);
    let written = Output::new(inputs, options.force).write_asked(&forms)?;
    if options.json {
        comparison.notes().iter().for_each(|note| terminal::tell(&format!("note: {}", escaped(note))));
        terminal::answer(&comparison.json());
    } else {
        terminal::answer(&comparison.table(terminal::colour()));
        if !written.is_empty() {
            terminal::answer(&format!("\n  Written to {}\n", written.join(" and ")));
        }
    }
    let whole = comparison.is_true() && comparison.left_out.is_empty();
    Ok(if whole { Ended::Good } else { Ended::Bad })
}
