//! The function of a candidate: its graph beside the one that is wanted, the error below, and the pairs.

use super::canvas::{Area, Canvas, palette};
use super::chart::{Abscissa, Chart, Range, Series};
use super::{body, output, words};
use crate::record::{Candidate, Record};
use crate::task::Sense;
use crate::task::spec::TaskSpec;

/// Samples of the generated function between its first and its last input.
const SAMPLES: usize = 361;
/// Width of the charts, and the height of each, in pixels.
pub(super) const WIDTH: f64 = 880.0;
const HEIGHT: f64 = 220.0;

/// A pair of a function as a candidate generates it: angles in degrees, places in the file's unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct GeneratedPair {
    /// The input.
    pub input: f64,
    /// The output that is wanted.
    pub wanted: f64,
    /// The output that is generated, in the sense in which outputs count; on the turn that is nearest to the one wanted.
    /// `None` where the linkage does not close.
    pub generated: Option<f64>,
}

impl GeneratedPair {
    /// Returns the error, wanted less generated.
    pub(super) fn error(&self) -> Option<f64> {
        Some(self.wanted - self.generated?)
    }
}

/// Returns the pairs of a task as a candidate generates them; none for another task.
pub(super) fn pairs(task: &TaskSpec, candidate: &Candidate) -> Vec<GeneratedPair> {
    let at = candidate.crank_deg.iter().zip(&candidate.t1_at);
    let [of_input, of_output] = candidate.scales(task);
    let pair = |([input, wanted], (crank_deg, t1)): ([f64; 2], (&f64, &crate::mechanism::AssemblyMode))| {
        let (input, wanted) = (of_input * input, of_output * wanted);
        let turned = generated(candidate, *crank_deg, *t1);
        let generated = turned.map(|turned| wanted - body::apart(candidate, wanted - turned));
        GeneratedPair { input, wanted, generated }
    };
    task.pairs().into_iter().zip(at).map(pair).collect()
}

/// Returns the output at a crank angle (degrees) in the sense in which outputs count; an angle within half a turn.
fn generated(candidate: &Candidate, crank_deg: f64, t1: crate::mechanism::AssemblyMode) -> Option<f64> {
    let at = candidate.linkage.joints_with(crank_deg.to_radians(), t1)?;
    let sign = if candidate.sense? == Sense::Opposite { -1.0 } else { 1.0 };
    Some(sign * body::output(candidate, &at)?)
}

/// Returns the generated function from its least to its greatest input, (input, output); strands break where
/// the linkage does not close.
fn curve(candidate: &Candidate, pairs: &[GeneratedPair]) -> Vec<Vec<(f64, f64)>> {
    let (Some(first), Some(crank), Some(t1)) =
        (pairs.first(), candidate.crank_deg.first(), candidate.t1_at.first())
    else {
        return Vec::new();
    };
    let (low, high) = inputs(pairs);
    let mut strands: Vec<Vec<(f64, f64)>> = vec![Vec::new()];
    // Each output lies on the turn that is nearest to the one before it; the first, to the one wanted there.
    let mut last =
        pairs.iter().min_by(|one, other| one.input.total_cmp(&other.input)).map_or(0.0, |p| p.wanted);
    for i in 0..SAMPLES {
        let input = low + (high - low) * i as f64 / (SAMPLES - 1) as f64;
        match generated(candidate, crank + input - first.input, *t1) {
            Some(turned) => {
                let at = last - body::apart(candidate, last - turned);
                last = at;
                if let Some(strand) = strands.last_mut() {
                    strand.push((input, at));
                }
            }
            None => strands.push(Vec::new()),
        }
    }
    strands.retain(|strand| !strand.is_empty());
    strands
}

/// Returns the least and the greatest input.
fn inputs(pairs: &[GeneratedPair]) -> (f64, f64) {
    pairs.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), pair| {
        (low.min(pair.input), high.max(pair.input))
    })
}

/// Returns the charts of a candidate as a self-contained SVG: the outputs wanted and generated over the input, and the error
/// below; `None` for another task.
pub(super) fn chart_svg(record: &Record, candidate: &Candidate) -> Option<String> {
    let mut canvas = Canvas::default();
    let height = charts(&mut canvas, record, candidate, Area { x: 0.0, y: 0.0, width: WIDTH, height: 0.0 })?;
    let title = format!("{}: the function", words::standing(record, candidate));
    let unit = words::error_unit(record);
    let description = format!(
        "the {} over the crank's angle, wanted and generated; errors {}{unit} rms, {}{unit} at most",
        output::of(candidate),
        super::text::significant(candidate.error.rms, 4),
        super::text::significant(candidate.error.max, 4)
    );
    Some(canvas.document(WIDTH, height, &title, &description))
}

/// Draws the charts at the top left corner of an area as wide as it; returns their height.
pub(super) fn charts(canvas: &mut Canvas, record: &Record, candidate: &Candidate, area: Area) -> Option<f64> {
    let task = &record.problem.resolved.task;
    if !task.is_function() {
        return None;
    }
    let pairs = pairs(task, candidate);
    let (low, high) = inputs(&pairs);
    if high.partial_cmp(&low) != Some(std::cmp::Ordering::Greater) {
        return None;
    }
    let spots = |of: &dyn Fn(&GeneratedPair) -> Option<f64>| -> Vec<Vec<(f64, f64)>> {
        pairs.iter().filter_map(|pair| Some(vec![(pair.input, of(pair)?)])).collect()
    };
    let abscissa = Abscissa { low, high, unreachable: Vec::new(), toggles: Vec::new() };
    let generated = Series { name: "generated", colour: palette::CURVE, strands: curve(candidate, &pairs) };
    let wanted =
        Series { name: "wanted", colour: palette::TARGET, strands: spots(&|pair| Some(pair.wanted)) };
    let is_of_places = task.is_of_places();
    let unit = if is_of_places { output::length_name(record) } else { "degrees".into() };
    let outputs = Chart {
        title: output::title(candidate),
        unit: match is_of_places {
            true => format!("{unit} moved, over the crank's degrees"),
            false => "degrees turned, over the crank's".into(),
        },
        series: vec![generated, wanted],
        range: Range::Fitted { natural: 1.0, angle: !is_of_places, unbounded: false },
        warning: Vec::new(),
    };
    let errors = Chart {
        title: "Error",
        unit: format!("{unit}, wanted less generated"),
        series: vec![Series { name: "error", colour: palette::TARGET, strands: error_strands(&pairs) }],
        range: Range::Fitted { natural: candidate.error.max.max(1e-9), angle: false, unbounded: false },
        warning: Vec::new(),
    };
    for (i, chart) in [outputs, errors].iter().enumerate() {
        let y = area.y + i as f64 * HEIGHT;
        chart.draw(canvas, &abscissa, Area { x: area.x, y, width: area.width, height: HEIGHT });
    }
    Some(2.0 * HEIGHT)
}

/// Returns the errors in the order of the inputs, broken where there is none.
fn error_strands(pairs: &[GeneratedPair]) -> Vec<Vec<(f64, f64)>> {
    let mut sorted = pairs.to_vec();
    sorted.sort_by(|one, other| one.input.total_cmp(&other.input));
    let gaps = sorted.split(|pair| pair.generated.is_none());
    let strand = |part: &[GeneratedPair]| -> Vec<(f64, f64)> {
        part.iter().filter_map(|pair| Some((pair.input, pair.error()?))).collect()
    };
    gaps.map(strand).filter(|strand| !strand.is_empty()).collect()
}
