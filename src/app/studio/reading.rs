//! Texts that are pasted or dropped, read by the readers of files: points (CSV), drawings (SVG), problems (TOML).

use super::asked::{MOST_POINTS, NotHere};
use super::messages::Ask;
use crate::files::diagnostic::Diagnostic;
use crate::files::problem_file;
use crate::files::svg_file;
use crate::files::svg_file::SvgOptions;
use crate::files::{name, points_file};
use crate::mechanism::Unit;
use crate::task::spec::TimingSpec;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What a text is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// A points file: a header row with x,y and optionally `crank_deg`, `weight`, `tolerance`.
    Csv,
    /// A drawing.
    Svg,
    /// A problem file.
    Problem,
}

/// A text to be read.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Text {
    /// What it is.
    pub kind: Kind,
    /// What to call it in messages; a problem without a name takes this one's.
    #[serde(default)]
    pub name: String,
    /// The text itself.
    pub text: String,
    /// The id of a drawing's shape; absent: the first.
    #[serde(default)]
    pub svg_id: Option<String>,
    /// How many points are taken along a drawing; absent: 60.
    #[serde(default)]
    pub samples: Option<usize>,
    /// What a drawing's physical lengths are to be given in; absent: mm.
    #[serde(default)]
    pub unit: Option<Unit>,
}

/// What was read.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Reading {
    /// What to ask for it. Where it is not whole, only the points with what stands beside them, `closed` and `unit`
    /// were in the text.
    pub ask: Ask,
    /// Whether it is a whole problem, with its requirements.
    pub whole: bool,
    /// What was ignored or cannot succeed.
    pub warnings: Vec<String>,
}

/// `line 3: the cell of y is empty: give its value or leave the row out`
pub(super) fn said(diagnostic: &Diagnostic) -> String {
    let mut said = diagnostic.line_column().map_or(String::new(), |(line, _)| format!("line {line}: "));
    said.push_str(&diagnostic.message);
    if let Some(help) = &diagnostic.help {
        said.push_str(&format!(": {help}"));
    }
    said
}

/// Reads a text as the file that it would be. No other file is opened.
///
/// # Errors
/// What is wrong with it and what to do, in words.
pub fn read(text: &Text) -> Result<Reading, String> {
    let file = if text.name.trim().is_empty() { "text" } else { text.name.as_str() };
    let refused = |e: Box<Diagnostic>| said(&e);
    let blank = || Ask { name: name::from_file(file, "drawing"), seed: 1, ..Ask::default() };
    let (ask, whole, warnings) = match text.kind {
        Kind::Csv => {
            let csv = points_file::parse(file, &text.text).map_err(refused)?;
            let timing = csv.crank_deg.map(|crank_deg| TimingSpec { crank_deg, offset: Default::default() });
            let tolerances = csv.tolerance;
            let ask = Ask { points: csv.points, weights: csv.weight, tolerances, timing, ..blank() };
            (ask, false, csv.warnings)
        }
        Kind::Svg => {
            let samples = text.samples.unwrap_or(svg_file::DEFAULT_SAMPLES);
            if !(3..=MOST_POINTS).contains(&samples) {
                return Err(format!("{samples} points along a drawing: 3 to {MOST_POINTS} can be taken"));
            }
            let options = SvgOptions { id: text.svg_id.as_deref(), samples, closed: None, unit: text.unit };
            let svg = svg_file::parse(file, &text.text, &options).map_err(refused)?;
            let ask = Ask { points: svg.points, closed: svg.closed, unit: svg.unit, ..blank() };
            (ask, false, svg.warnings)
        }
        Kind::Problem => {
            let problem = problem_file::parse(file, &text.text, None, &[]).map_err(refused)?;
            let ask = Ask::of(&problem).map_err(|e| e.to_string())?;
            (ask, true, problem.warnings)
        }
    };
    if ask.points.len() > MOST_POINTS {
        return Err(NotHere::Points(ask.points.len()).to_string());
    }
    Ok(Reading { ask, whole, warnings: warnings.iter().map(said).collect() })
}

#[cfg(test)]
mod tests {
    use super::*;

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
            let refusal = read(&text(kind, what)).expect_err(what);
            assert!(refusal.contains(says) && refusal.len() > 10, "{what}: {refusal}");
        }
        let many = format!("x,y\n{}", "1,2\n3,4\n".repeat(501));
        assert!(read(&text(Kind::Csv, &many)).expect_err("too many").contains("1002 points"));
        let samples = Text { samples: Some(1_000_000), ..text(Kind::Svg, "<svg/>") };
        assert!(read(&samples).expect_err("too many").contains("3 to 1000"));
    }
}
