//! `analyze` and `cognates`: motion of a given linkage, and the other linkages of its curve.

use super::arguments::{Analyze, Cognates};
use super::output::{Form, Output};
use super::{Ended, refuse, refuse_at, refuse_io, refuse_path, result, terminal};
use crate::files::generator::FileKind;
use crate::files::linkage_file;
use crate::files::linkage_file::AnyLinkageFile;
use crate::files::loads_file;
use crate::files::name;
use crate::mechanism::analysis::driven::{MechanismRequest, analyze_mechanism};
use crate::mechanism::analysis::{Request, analyze, full_turn};
use crate::mechanism::four_bar::motion::CrankMotion;
use crate::mechanism::loads::{Drive, LoadFault};
use crate::mechanism::{FourBar, Linkage, SliderCrank, Unit};
use crate::report::analysis_csv::analysis_csv;
use crate::report::analysis_sheets::analysis_svg;
use crate::report::analysis_text::{analysis_head, analysis_table};
use crate::report::cognates_sheet::cognates_svg;
use crate::report::mechanism_sheet::mechanism_svg;
use crate::report::mechanism_text::{mechanism_csv, mechanism_head, mechanism_table};
use crate::report::scene::middle_position;
use crate::report::text::clean;
use std::path::{Path, PathBuf};

/// The crank angles when none are asked for: every 30 degrees.
const DEFAULT_POSITIONS: usize = 12;
/// A table of more rows is not printed when it was written to a file.
const LONG_TABLE: usize = 72;

/// Runs `analyze`.
pub fn run(options: &Analyze) -> Result<Ended, Ended> {
    let (file, own_loads) = result::read_loaded_linkage(&options.linkage)?;
    let loads = match &options.loads {
        Some(path) => Some(loads_file::load(path, &file).map_err(refuse_at)?),
        None => own_loads,
    };
    let AnyLinkageFile { name, unit, linkage } = file;
    let evenly = || full_turn(options.cycle.map_or(DEFAULT_POSITIONS, |n| n as usize));
    let crank_deg = options.angle.clone().unwrap_or_else(evenly);
    let speed = options.omega.or(options.rpm.map(|rpm| CrankMotion::steady_rpm(rpm).speed_rad_s));
    let told = |fault: LoadFault| refuse(format!("--alpha {}: {fault}; {}", options.alpha, fault.remedy()));
    let input = Drive::chosen(speed, options.alpha, loads.as_ref()).map_err(told)?;
    let all_configurations = options.all_configurations;
    match linkage {
        Linkage::FourBar(linkage) => {
            let methods = options.method.clone();
            let request = Request { name, unit, linkage, crank_deg, input, methods, all_configurations };
            let mut analysis = analyze(&request);
            if let Some(loads) = &loads {
                analysis.add_loads(loads).map_err(refuse)?;
            }
            let forms = Forms {
                positions: analysis.configurations.iter().map(|c| c.rows.len()).sum(),
                csv: &|| analysis_csv(&analysis),
                svg: &|| analysis_svg(&analysis),
                table: &|| analysis_table(&analysis, terminal::colour()),
                head: &|| analysis_head(&analysis, terminal::colour()),
            };
            deliver(options, &analysis, &forms)
        }
        other if all_configurations || !options.method.is_empty() => Err(refuse(format!(
            "--all-configurations and --method are for four-bars; this file is {}, whose signs stand in it",
            linkage_file::kind_in_words(&other)
        ))),
        linkage => {
            let request = MechanismRequest { name, unit, linkage, crank_deg, input };
            let mut analysis = analyze_mechanism(&request);
            if let Some(loads) = &loads {
                analysis.add_loads(&request.linkage, loads).map_err(refuse)?;
            }
            let forms = Forms {
                positions: analysis.rows.len(),
                csv: &|| mechanism_csv(&analysis),
                svg: &|| mechanism_svg(&analysis, &request.linkage),
                table: &|| mechanism_table(&analysis, terminal::colour()),
                head: &|| mechanism_head(&analysis, terminal::colour()),
            };
            deliver(options, &analysis, &forms)
        }
    }
}

/// The forms in which an analysis can be given; each is made only when it is wanted.
struct Forms<'a> {
    positions: usize,
    csv: &'a dyn Fn() -> String,
    svg: &'a dyn Fn() -> String,
    table: &'a dyn Fn() -> String,
    head: &'a dyn Fn() -> String,
}

/// Writes the files that were asked for and prints JSON, the tables, or the head alone of a long table that was written
/// to a file.
fn deliver(options: &Analyze, analysis: &impl serde::Serialize, forms: &Forms<'_>) -> Result<Ended, Ended> {
    let asked: [Form<'_>; 2] =
        [(&options.csv, FileKind::Csv, forms.csv), (&options.svg, FileKind::Svg, forms.svg)];
    let inputs = [&options.linkage].into_iter().chain(&options.loads);
    let files = Output::new(inputs, options.force).write_asked(&asked)?;
    if options.json {
        let text = serde_json::to_string_pretty(analysis)
            .map_err(|e| refuse(format!("the analysis cannot be written as JSON: {e}")))?;
        terminal::answer(&(text + "\n"));
        return Ok(Ended::Good);
    }
    let positions = forms.positions;
    let shown = if files.is_empty() || positions <= LONG_TABLE { forms.table } else { forms.head };
    terminal::answer(&shown());
    if !files.is_empty() {
        terminal::answer(&format!("\n  {positions} positions. Written to {}\n", files.join(" and ")));
    }
    Ok(Ended::Good)
}

/// Runs `cognates`.
pub fn cognates(options: &Cognates) -> Result<Ended, Ended> {
    let AnyLinkageFile { name, unit, linkage } = result::read_linkage(&options.linkage)?;
    result::note_loads(&options.linkage);
    let linkage = match linkage {
        Linkage::FourBar(linkage) => linkage,
        Linkage::SliderCrank(linkage) => return cognate_of_a_slider_crank(options, &name, unit, &linkage),
        other => {
            let kind = linkage_file::kind_in_words(&other);
            let why = format!(
                "it is {kind}, and cognates are of four-bars and slider-cranks: give a file with [linkage], [vector_loop] \
                 or [slider_crank]"
            );
            return Err(refuse_path(&options.linkage, why));
        }
    };
    let mut found = Vec::new();
    let mut text = String::new();
    for (place, cognate) in ["A", "B"].iter().zip(linkage.cognates()) {
        match cognate {
            Ok(cognate) => {
                let n = found.len() + 1;
                let kind = cognate.linkage.linkage_type().map_or("links that cannot be joined", |t| t.name());
                text.push_str(&format!("  {n}. at {place}: {kind}\n     {}\n", cognate.linkage));
                found.push(cognate.linkage);
            }
            Err(e) => text.push_str(&format!("  at {place}: none ({e})\n")),
        }
    }
    let numbered = |(i, linkage): (usize, &FourBar)| {
        let name = name::with_suffix(&name, &format!("-cognate-{}", i + 1));
        (format!("{name}.toml"), linkage_file::to_toml(&name, unit, linkage))
    };
    let mut written = cognate_files(options, found.iter().enumerate().map(numbered))?;
    if let Some(path) = &options.svg {
        written.push((path.clone(), FileKind::Svg, cognates_svg(&name, unit, &linkage, &found)));
    }
    text.push_str(&written_files(options, &written)?);
    terminal::answer(&format!(
        "The Roberts-Chebyshev cognates of {}: other linkages of the same coupler curve\n{text}",
        clean(&name)
    ));
    Ok(if found.is_empty() { Ended::Bad } else { Ended::Good })
}

/// Tells and writes the one cognate of a slider-crank, with t1 as it is in the middle of the crank's range.
fn cognate_of_a_slider_crank(
    options: &Cognates,
    name: &str,
    unit: Option<Unit>,
    linkage: &SliderCrank,
) -> Result<Ended, Ended> {
    if options.svg.is_some() {
        let why = "the drawing of cognates is of four-bars: leave --svg out";
        return Err(refuse_path(&options.linkage, why.to_owned()));
    }
    let title = format!("The cognate of {}: the other slider-crank of the same coupler curve\n", clean(name));
    let (angle, _) = middle_position(*linkage);
    match linkage.cognate(angle) {
        Ok(cognate) => {
            let name = name::with_suffix(name, "-cognate");
            let file = linkage_file::any_to_toml(&name, unit, &cognate.into());
            let written = cognate_files(options, [(format!("{name}.toml"), file)])?;
            let files = written_files(options, &written)?;
            terminal::answer(&format!("{title}  at A: slider-crank\n     {cognate}\n{files}"));
            Ok(Ended::Good)
        }
        Err(e) => {
            terminal::answer(&format!("{title}  none ({e})\n"));
            Ok(Ended::Bad)
        }
    }
}

/// Returns the linkage files of cognates, by their names and texts; one that exists already is refused.
fn cognate_files(
    options: &Cognates,
    texts: impl IntoIterator<Item = (String, String)>,
) -> Result<Vec<(PathBuf, FileKind, String)>, Ended> {
    let file = |(name, text): (String, String)| {
        let path = options.out.as_deref().unwrap_or(Path::new("")).join(name);
        if path.exists() && !options.force {
            let why = "exists already; give another folder with --out, or replace it with --force";
            return Err(refuse(format!("{} {why}", path.display())));
        }
        Ok((path, FileKind::Linkage, text))
    };
    texts.into_iter().map(file).collect()
}

/// Writes the files of cognates, and returns the lines that say so.
fn written_files(options: &Cognates, written: &[(PathBuf, FileKind, String)]) -> Result<String, Ended> {
    let output = Output::new([&options.linkage], options.force);
    // Before the folder is made.
    output.check(written)?;
    if let Some(out) = &options.out {
        std::fs::create_dir_all(out).map_err(|e| refuse_io(out, e))?;
    }
    output.write(written)?;
    Ok(written.iter().map(|(path, ..)| format!("  Wrote {}\n", terminal::shown(path))).collect())
}
