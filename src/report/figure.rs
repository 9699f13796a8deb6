//! The drawing of a scene: curve, linkage, target and labels.

use super::bodies;
use super::canvas::{
    Canvas, ROUND_CORNERS, ROUND_ENDS, Spot, View, filled, font, haloed, outline, palette, px, stroke,
    weighted,
};
use super::guide::Sliding;
use super::labels::Beside;
use super::loops::Loops;
use super::parts::{UP, away, bars, letter, mark_joints, point_mark, stand, triangle};
use super::scene::{Bounds, Scene, Target};
use super::words::joined;
use crate::mechanism::{Complex, Joints};
use std::collections::BTreeSet;

/// The amount of detail and the thickness of lines of a drawing.
#[derive(Clone, Copy, Debug)]
pub(super) struct Detail {
    /// The scale of lines and marks: 1 for a page, less for small drawings.
    pub(super) weight: f64,
    /// The scale of the target points.
    pub(super) target_weight: f64,
    /// Whether there are letters at the joints and numbers at the target points.
    pub(super) letters: bool,
    /// Whether there are numbers at the target points.
    pub(super) numbers: bool,
    /// Whether the linkage itself is drawn; otherwise only the curve and the target.
    pub(super) linkage: bool,
    /// The box outside of which the coupler curve is left out.
    pub(super) clip: Option<Bounds>,
}

impl Detail {
    /// The linkage in a drawing of this scale, without letters and numbers.
    pub(super) const fn small(weight: f64) -> Detail {
        Detail { weight, target_weight: weight, letters: false, numbers: false, linkage: true, clip: None }
    }

    /// The linkage with its letters in a drawing of this scale.
    pub(super) const fn lettered(weight: f64) -> Detail {
        Detail { letters: true, target_weight: 1.0, ..Detail::small(weight) }
    }
}

/// The largest number of points that all have numbers; of more, only round ones have.
const NUMBERED: usize = 20;
/// The largest number of target points that are drawn as rings; more are plain dots.
const MARKED: usize = 150;

/// Draws the scene; labels avoid the marked places, and the drawn parts are marked for later labels.
pub(super) fn draw(canvas: &mut Canvas, scene: &Scene, view: &View, detail: Detail) {
    let loops = Loops::of(scene).filter(|_| detail.linkage);
    let is_one_loop = loops.is_none() && detail.linkage;
    let joints = scene.pose.filter(|_| is_one_loop).map(|pose| pose.joints.map(|p| view.spot(p)));
    if let Some(loops) = &loops {
        loops.ground(canvas, view, detail.weight);
        loops.pin_paths(canvas, view, detail.weight);
        loops.mark(canvas, view);
        loops.links(canvas, view, detail.weight);
    }
    let guide = scene.pose.filter(|_| detail.linkage).and_then(|pose| Sliding::of(scene, &pose));
    if let Some(joints) = joints {
        let [a, b, c, d, p] = joints;
        ground(canvas, &[a, b][..if scene.has_two_pivots() { 2 } else { 1 }], detail);
        if let Some(guide) = &guide {
            guide.rail(canvas, view, detail.weight);
        }
        pin_paths(canvas, scene, view, detail);
        mark_joints(&mut canvas.labels, joints);
        // The rod of an inverted slider-crank slides through D: its plate ends below P.
        let corner = guide.as_ref().and_then(Sliding::below_point).map_or(d, |p| view.spot(p));
        triangle(canvas, [c, corner, p], palette::COUPLER, palette::BAR_EDGE, detail.weight);
    }
    curves(canvas, scene, view, detail);
    let marks = Marks::new(scene, view, detail);
    whiskers(canvas, &marks, detail);
    if let Some([a, b, c, d, _]) = joints {
        match &guide {
            None => bars(canvas, [a, b, c, d], palette::BAR_EDGE, detail.weight),
            Some(guide) => {
                // The crank alone is a bar.
                bars(canvas, [a, a, c, a], palette::BAR_EDGE, detail.weight);
                guide.block(canvas, view, detail.weight);
            }
        }
    }
    bodies::draw(canvas, scene, view, detail.target_weight);
    targets(canvas, &marks, detail);
    if let Some(joints) = joints {
        point_mark(canvas, joints[4], detail.weight);
        if detail.letters {
            letters(canvas, joints, scene.has_two_pivots());
        }
    }
    if let Some(loops) = &loops {
        loops.marks(canvas, view, detail.weight, detail.letters);
    }
    if detail.numbers {
        numbers(canvas, scene, view, marks.radius);
    }
}

/// Draws the coupler curve of the first circuit, and those of other used circuits dashed.
fn curves(canvas: &mut Canvas, scene: &Scene, view: &View, detail: Detail) {
    let line = outline(palette::CURVE, weighted(2.4 * detail.weight)) + ROUND_CORNERS + ROUND_ENDS;
    for (i, circuit) in scene.circuits.iter().enumerate() {
        let points: Vec<Complex> = circuit.iter().map(|joints| joints.coupler_point).collect();
        let dashes = if i == 0 { "" } else { r#" stroke-dasharray="6 5""# };
        let (strands, closed) = strands(&points, detail.clip.as_ref());
        for spots in strands.iter().map(|strand| view.spots(strand)) {
            canvas.path(&spots, closed, &format!("{line}{dashes}"));
            canvas.labels.mark_path(&spots);
        }
    }
}

/// Returns the parts of a closed curve inside a box, each with its neighbours outside; and whether that is the whole
/// curve.
fn strands(points: &[Complex], clip: Option<&Bounds>) -> (Vec<Vec<Complex>>, bool) {
    let Some(clip) = clip.filter(|clip| !points.iter().all(|p| clip.holds(*p))) else {
        return (vec![points.to_vec()], true);
    };
    let n = points.len();
    // Begins at a point outside, so that no part is cut in two.
    let start = points.iter().position(|p| !clip.holds(*p)).unwrap_or(0);
    let sides: Vec<[Complex; 2]> = (start..start + n).map(|i| [points[i % n], points[(i + 1) % n]]).collect();
    let runs = sides.split(|ends| !ends.iter().any(|p| clip.holds(*p)));
    let strand = |run: &[[Complex; 2]]| {
        Some([run.first()?[0]].into_iter().chain(run.iter().map(|side| side[1])).collect())
    };
    (runs.filter_map(strand).collect(), false)
}

/// Draws the line A-B, and under each fixed pivot a hatched stand.
fn ground(canvas: &mut Canvas, pivots: &[Spot], detail: Detail) {
    let faint = stroke(palette::MUTED, weighted(detail.weight)) + r#" stroke-dasharray="2 5""#;
    if let [a, b] = pivots {
        canvas.line(*a, *b, &faint);
    }
    pivots.iter().for_each(|pivot| stand(canvas, *pivot, detail.weight));
}

/// Draws the paths of C and D.
fn pin_paths(canvas: &mut Canvas, scene: &Scene, view: &View, detail: Detail) {
    let attributes = outline(palette::FAINT, weighted(1.1 * detail.weight));
    let pins: [fn(&Joints) -> Complex; 2] = [|joints| joints.crank_pin, |joints| joints.follower_pin];
    for circuit in &scene.circuits {
        for pin in pins {
            let spots: Vec<Spot> = circuit.iter().map(|joints| view.spot(pin(joints))).collect();
            canvas.path(&spots, true, &attributes);
        }
    }
}

/// The place of a target point, and the place that the coupler point reaches instead.
struct Mark {
    index: usize,
    spot: Spot,
    reached: Option<Spot>,
}

/// The target points with the style in which they are drawn.
struct Marks {
    list: Vec<Mark>,
    radius: f64,
    many: bool,
}

impl Marks {
    /// Returns the marks. Of many points, only those that fall on a pixel of their own are kept: a hundred thousand
    /// would make the drawing too large.
    fn new(scene: &Scene, view: &View, detail: Detail) -> Self {
        let n = scene.targets.len();
        let many = n > MARKED;
        let size: f64 = match n {
            0..=40 => 4.6,
            41..=MARKED => 3.2,
            _ => 1.6,
        };
        // A ring must leave the corner of its frame in sight.
        let size =
            if scene.targets.iter().any(|target| target.angle.is_some()) { size.min(3.0) } else { size };
        let mut drawn: BTreeSet<(i64, i64)> = BTreeSet::new();
        let mut list = Vec::new();
        for target in &scene.targets {
            let spot = view.spot(target.at);
            if !many || drawn.insert(((spot.x * 1.5) as i64, (spot.y * 1.5) as i64)) {
                let reached = target.reached.map(|p| view.spot(p));
                list.push(Mark { index: target.index, spot, reached });
            }
        }
        Marks { list, radius: size * detail.target_weight, many }
    }
}

/// Draws a line from each target point to the coupler point's place, if it is long enough to be seen.
fn whiskers(canvas: &mut Canvas, marks: &Marks, detail: Detail) {
    let mut data = String::new();
    for mark in &marks.list {
        let Some(reached) = mark.reached else { continue };
        // A line inside the ring would only look like a blot.
        if mark.spot.distance(reached) > marks.radius {
            canvas.labels.mark_line(mark.spot, reached);
            let [x, y, to_x, to_y] = [mark.spot.x, mark.spot.y, reached.x, reached.y].map(px);
            data.push_str(&format!("M{x} {y}L{to_x} {to_y}"));
        }
    }
    if !data.is_empty() {
        let (width, opacity) = if marks.many { (0.8, 0.45) } else { (1.6, 1.0) };
        let line = outline(palette::TARGET, weighted(width * detail.weight));
        canvas.raw(&format!(r#"<path d="{data}" {line} stroke-opacity="{opacity}"/>"#));
    }
}

/// Draws target points as rings, or as dots if there are many, the first one filled and larger.
fn targets(canvas: &mut Canvas, marks: &Marks, detail: Detail) {
    let spots: Vec<Spot> = marks.list.iter().map(|mark| mark.spot).collect();
    spots.iter().for_each(|spot| canvas.labels.mark(*spot));
    let (radius, w) = (marks.radius, detail.target_weight);
    if marks.many {
        canvas.dots(&spots, 2.0 * radius, palette::TARGET);
    } else {
        let edge = stroke(palette::TARGET, weighted(1.7 * w));
        let ring = format!(r#"fill="{}" fill-opacity="0.75" {edge}"#, palette::PAPER);
        spots.iter().for_each(|spot| canvas.circle(*spot, radius, &ring));
        let reached: Vec<Spot> = marks.list.iter().filter_map(|mark| mark.reached).collect();
        canvas.dots(&reached, 3.4 * w, palette::CURVE);
    }
    if let Some(first) = marks.list.first().filter(|mark| mark.index == 0) {
        let dot = filled(palette::TARGET, palette::PAPER, weighted(w));
        canvas.circle(first.spot, (1.5 * radius).max(5.0 * w), &dot);
    }
}

/// Draws the letters A B C D P, without B of a linkage that has one pivot.
fn letters(canvas: &mut Canvas, [a, b, c, d, p]: [Spot; 5], two_pivots: bool) {
    let joints = [
        ("P", p, away(p, &[c, d])),
        ("C", c, away(c, &[a, d, p])),
        ("D", d, away(d, &[b, c, p])),
        ("A", a, away(a, &[c]) + UP),
        ("B", b, away(b, &[d]) + UP),
    ];
    for (name, joint, towards) in joints.into_iter().take(if two_pivots { 5 } else { 4 }) {
        letter(canvas, name, joint, towards);
    }
}

/// Draws the numbers of the target points: all if they are few, otherwise 0 and round steps.
fn numbers(canvas: &mut Canvas, scene: &Scene, view: &View, radius: f64) {
    let n = scene.targets.len();
    let few = n <= NUMBERED;
    let step = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10_000, 20_000]
        .into_iter()
        .find(|step| n <= NUMBERED * step / if *step > 1 { 2 } else { 1 })
        .unwrap_or(50_000);
    let centre = view.spot(Bounds::of(scene.targets.iter().map(|target| target.at)).centre());
    let attributes = haloed(&font(11, palette::TARGET_TEXT), "2.5", ROUND_CORNERS);
    for target in scene.targets.iter().filter(|target| target.index % step == 0) {
        let point = view.spot(target.at);
        // Points at one place, such as a last one that repeats the first, share a label.
        let together = |other: &&Target| other.index == target.index || (few && other.at == target.at);
        let indices: Vec<usize> = scene.targets.iter().filter(together).map(|other| other.index).collect();
        if indices.first() != Some(&target.index) {
            continue;
        }
        let number = joined(&indices);
        let is_first = target.index == 0;
        let distance = radius + if is_first { 5.0 } else { 3.0 };
        let beside = Beside { point, distance, towards: point - centre, needed: is_first };
        canvas.label(&number, 11.0, &attributes, beside);
    }
}
