//! `export`: a linkage as a file to build from.

use super::arguments::Export;
use super::output::Output;
use super::result;
use super::result::Given;
use super::{Ended, refuse, refuse_at, terminal};
use crate::files::diagnostic::{Diagnostic, escaped};
use crate::report::export::{Refusal, Settings, Subject, export};

/// Runs the command.
pub fn run(options: &Export) -> Result<Ended, Ended> {
    let settings = Settings::parse(options.format, &options.set).map_err(|e| refused(options, e))?;
    if options.out.is_none() && !options.format.is_text() {
        let name = options.format.name();
        return Err(refuse(format!("{name} is not text: say where it goes with --out FILE.{name}")));
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
