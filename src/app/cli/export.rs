//! `export`: a linkage as a file to build from.

use super::arguments::Export;
use super::output::Output;
use super::result;
use super::result::Given;
use super::{Ended, refuse, refuse_at, terminal};
use crate::files::diagnostic::{Diagnostic, escaped};
use crate::report::export::{Format, Refusal, Settings, Subject, export};

/// Runs the command.
pub fn run(options: &Export) -> Result<Ended, Ended> {
    let settings = Settings::parse(options.format, &options.set).map_err(|e| refused(options, e))?;
    if options.out.is_none() && !options.format.is_text() {
        let name = options.format.name();
        return Err(refuse(format!("{name} is not text: say where it goes with --out FILE.{name}")));
    }
    let has_holes = options.format.settings().contains(&"hole_mm");
    if let Some(file) = options.shop.as_ref().filter(|_| !has_holes) {
        let (file, name) = (terminal::shown(file), options.format.name());
        return Err(refuse(format!(
            "--shop {file} means nothing for {name}, which has no holes: leave it out"
        )));
    }
    let shop = |linkage| result::read_shop(&options.result, options.shop.as_ref(), linkage);
    let subject = match result::read(&options.result)? {
        Given::Linkage(file) => Subject { shop: shop(&file.linkage)?, ..Subject::of_linkage(&file) },
        Given::Run(run) => {
            let candidate = run.one()?.candidate;
            Subject::of_candidate_for_shop(&run.record, candidate, shop(&candidate.linkage)?)
        }
    };
    let exported = export(&subject, options.format, &settings).map_err(|e| refused(options, e))?;
    if subject.shop.is_some() && matches!(options.format, Format::Toml | Format::Json) {
        terminal::tell("note: the shop data are not carried over");
    }
    for note in &exported.notes {
        terminal::tell(&format!("note: {}", escaped(note)));
    }
    let Some(path) = &options.out else {
        terminal::answer(&String::from_utf8_lossy(&exported.bytes));
        return Ok(Ended::Good);
    };
    let file = (path, options.format.kind(), &exported.bytes);
    Output::new([&options.result].into_iter().chain(&options.shop), options.force).write(&[file])?;
    let (title, standing) = (subject.title(), &subject.standing);
    terminal::answer(&format!("Wrote {}: {title}, {standing}\n", terminal::shown(path)));
    Ok(Ended::Good)
}

/// Shows a refusal as every other error of an input, with the setting that it is about.
fn refused(options: &Export, refusal: Refusal) -> Ended {
    let mut file = options.result.display().to_string();
    if let Some((key, value)) = &refusal.setting {
        file.push_str(&format!(" with --set {key}={value}"));
    }
    refuse_at(Box::new(Diagnostic::new(file, "", refusal.message).with_help(refusal.help)))
}
