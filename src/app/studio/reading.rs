//! Texts that are pasted or dropped, read by the readers of files: points (CSV), drawings (SVG), problems (TOML).

use super::asked::{AskError, MOST_POINTS, NotHere, said};
use super::messages::{Ask, Kind, Reading, Text};
use super::targets::{BodyAsk, FunctionAsk};
use crate::files::problem_file::ProblemFile;
use crate::files::svg_file::{self, SvgOptions};
use crate::files::{name, points_file, problem_file};
use crate::report::html::{Held, held};
use crate::task::AngleOffset;
use crate::task::spec::TimingSpec;

/// Reads a text as the file that it would be. No other file is opened.
///
/// # Errors
/// [`AskError`].
pub fn read(text: &Text) -> Result<Reading, AskError> {
    let file = if text.name.trim().is_empty() { "text" } else { text.name.as_str() };
    let blank = || Ask { name: name::from_file(file, "drawing"), seed: 1, ..Ask::default() };
    let (ask, whole, warnings) = match text.kind {
        Kind::Csv if has_pairs(&text.text) => {
            let csv = points_file::parse_pairs(file, &text.text).map_err(AskError::Text)?;
            let function = FunctionAsk { tolerances_deg: csv.tolerance_deg, ..FunctionAsk::default() };
            let ask = Ask { points: csv.points, weights: csv.weight, function: Some(function), ..blank() };
            (ask, false, csv.warnings)
        }
        Kind::Csv => {
            let csv = points_file::parse(file, &text.text).map_err(AskError::Text)?;
            let timing = csv.crank_deg.and_then(|angles| TimingSpec::partly(&angles, AngleOffset::default()));
            if timing.as_ref().is_some_and(|timing| !timing.free.is_empty()) {
                return Err(NotHere::PartlyTimed.into());
            }
            let tolerances = csv.tolerance;
            let tolerances_deg = csv.tolerance_deg;
            let body =
                csv.angle_deg.map(|angle_deg| BodyAsk { angle_deg, tolerances_deg, ..BodyAsk::default() });
            let ask = Ask { points: csv.points, body, weights: csv.weight, tolerances, timing, ..blank() };
            (ask, false, csv.warnings)
        }
        Kind::Svg => {
            let samples = text.samples.unwrap_or(svg_file::DEFAULT_SAMPLES);
            if !(3..=MOST_POINTS).contains(&samples) {
                return Err(AskError::Samples(samples));
            }
            let options = SvgOptions { id: text.svg_id.as_deref(), samples, closed: None, unit: text.unit };
            let svg = svg_file::parse(file, &text.text, &options).map_err(AskError::Text)?;
            let ask = Ask { points: svg.points, closed: svg.closed, unit: svg.unit, ..blank() };
            (ask, false, svg.warnings)
        }
        Kind::Report => (of_report(&text.text)?, true, Vec::new()),
        Kind::Problem => {
            let problem = problem_file::parse(file, &text.text, None, &[]).map_err(AskError::Text)?;
            let ask = Ask::of(&problem)?;
            (ask, true, problem.warnings)
        }
    };
    // Points alone are told however many they are: fewer of them can be taken.
    if whole && ask.points.len() > MOST_POINTS {
        return Err(NotHere::Points(ask.points.len()).into());
    }
    Ok(Reading { ask, whole, warnings: warnings.iter().map(said).collect() })
}

/// Returns whether the header of a points file names pairs of a function.
fn has_pairs(text: &str) -> bool {
    let header = text.lines().find(|line| !line.trim().is_empty() && !line.trim_start().starts_with('#'));
    header.is_some_and(|header| header.split(',').any(|cell| cell.trim() == "input_deg"))
}

/// Returns the edit that asks the problem of a report.
///
/// # Errors
/// [`AskError`] if the text is no report, or holds a problem that the studio cannot hold.
pub fn of_report(text: &str) -> Result<Ask, AskError> {
    let Held { problem, linkage: from } = held(text).ok_or(AskError::NoReport)?;
    let problem = problem.ok_or(AskError::NoReport)?;
    Ok(Ask { from, ..Ask::of(&ProblemFile::of(problem))? })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::job::run::Job;
    use crate::mechanism::Unit;
    use crate::record::{Evaluations, ProblemRecord, Reason, Record};
    use crate::report::html::report_html;

    fn text(kind: Kind, text: &str) -> Text {
        Text { kind, name: String::new(), text: text.into(), svg_id: None, samples: None, unit: None }
    }

    #[test]
    fn columns_shapes_and_problems_come_as_what_to_ask() {
        let csv = read(&text(Kind::Csv, "x,y,crank_deg,tolerance,colour\n0,0,10,0.1,red\n1,2,20,0.2,red\n"));
        let Reading { ask, whole, warnings } = csv.expect("points");
        assert_eq!((ask.points.as_slice(), whole), ([[0.0, 0.0], [1.0, 2.0]].as_slice(), false));
        assert_eq!(ask.timing.expect("timed").crank_deg, [10.0, 20.0]);
        assert_eq!(ask.tolerances, Some(vec![0.1, 0.2]));
        assert!(warnings.len() == 1 && warnings[0].contains("colour"), "{warnings:?}");

        let csv = "x,y,angle_deg,tolerance_deg\n0,0,10,1\n1,2,,1\n2,2,40,2\n";
        let Reading { ask, .. } = read(&text(Kind::Csv, csv)).expect("poses");
        let body = ask.body.expect("a body");
        assert_eq!(body.angle_deg, [Some(10.0), None, Some(40.0)]);
        assert_eq!(body.tolerances_deg, Some(vec![1.0, 1.0, 2.0]));
        let pairs = read(&text(Kind::Csv, "# pairs\ninput_deg,output_deg\n0,0\n20,5\n")).expect("pairs");
        assert!(pairs.ask.function.is_some() && pairs.ask.points == [[0.0, 0.0], [20.0, 5.0]]);

        let circle = r#"<svg width="20mm" viewBox="0 0 10 10"><circle cx="5" cy="5" r="3"/></svg>"#;
        let Reading { ask, .. } =
            read(&Text { samples: Some(24), ..text(Kind::Svg, circle) }).expect("a drawing");
        assert_eq!((ask.points.len(), ask.closed, ask.unit), (24, true, Some(Unit::Mm)));

        let problem =
            "format = 1\nname = \"p\"\n[task.path]\npoints = [[0, 0], [1, 1], [2, 0]]\n[design]\na = 1\n";
        let Reading { ask, whole, .. } = read(&text(Kind::Problem, problem)).expect("a problem");
        assert!(whole && ask.name == "p" && ask.kept["design.a"] == "[1.0, 1.0]");
    }

    #[test]
    fn a_report_holds_its_problem() {
        let asked = "format = 1\nname = \"p\"\nunit = \"mm\"\n[task.path]\npoints = [[0, 0], [1, 1], [2, 0]]\n[require]\ntransmission_deg_min = 20\n";
        let file = problem_file::parse("p", asked, None, &[]).expect("a problem");
        let record = ProblemRecord::try_from(Job::from(file.clone())).expect("a problem's record");
        let (used, none) = (vec!["least-squares".into()], Evaluations::default());
        let record = Record::new(record, used, Reason::ByHand, none, Vec::new());
        let report = report_html(&record, 0);
        let Reading { ask, whole, .. } = read(&text(Kind::Report, &report)).expect("a report");
        assert!(whole && ask == Ask::of(&file).expect("an edit"), "{ask:?}");
        assert!(read(&text(Kind::Report, "<html></html>")).is_err());
        let broken = report.replace("\"resolved\":", "\"solved\":");
        assert!(read(&text(Kind::Report, &broken)).is_err());
    }

    #[test]
    fn what_is_wrong_is_said_with_its_line() {
        for (kind, what, says) in [
            (Kind::Csv, "x,y\n0,0\n1,\n", "line 3"),
            (Kind::Csv, "", "empty"),
            (Kind::Svg, "<svg></svg>", "no"),
            (Kind::Svg, "no drawing", ""),
            (Kind::Problem, "format = 1\n[task.path]\nfile = \"/etc/passwd\"\n", "cannot be read here"),
            (Kind::Problem, "format = 1\n[task.path]\nsvg = \"../x.svg\"\n", "cannot be read here"),
            (Kind::Problem, "format = 1\n[task.path]\npoints = [[0, 0], [1, 1]]\n", "3 to 1000"),
        ] {
            let refusal = read(&text(kind, what)).expect_err(what).to_string();
            assert!(refusal.contains(says) && refusal.len() > 10, "{what}: {refusal}");
        }
        let many = format!("x,y\n{}", "1,2\n3,4\n".repeat(501));
        assert_eq!(read(&text(Kind::Csv, &many)).expect("points").ask.points.len(), 1002);
        let samples = Text { samples: Some(1_000_000), ..text(Kind::Svg, "<svg/>") };
        assert!(read(&samples).expect_err("too many").to_string().contains("3 to 1000"));
    }
}
