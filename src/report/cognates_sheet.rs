//! Roberts' figure: a linkage and its cognates in one position, with the coupler curve that they share.

use super::canvas::{
    Anchor, Canvas, ROUND_CORNERS, ROUND_ENDS, Spot, Vec2, View, bold, font, outline, palette, stroke,
};
use super::parts::{away, bars, letter, mark_joints, point_mark, stand, triangle};
use super::scene::{Bounds, SAMPLES, all_joints, circuits_through, closest, middle_position};
use super::sheet::{FULL, INSET, Sheet, dimensions, page};
use super::text::{brief, plural, text_width};
use super::words::named;
use crate::mechanism::Unit;
use crate::mechanism::{AssemblyMode, Complex, CouplerCurve, FourBar};
use std::f64::consts::TAU;

/// The number of positions along the circuit among which the most legible one is chosen.
const TRIED: usize = 180;
/// The largest closure error of a cognate at the common coupler point, as a fraction of its size. A cognate with a
/// larger error is not drawn: it traces another curve. At a flat crank dyad, rounding leaves the square root of the
/// machine's precision.
const CLOSURE: f64 = 1e-6;
const COLOURS: [(&str, &str); 3] = [
    (palette::BAR_EDGE, palette::COUPLER),
    (palette::FOLLOWER, palette::FOLLOWER),
    (palette::SECOND, palette::SECOND),
];
const LEGEND_LINE: f64 = 20.0;

/// Returns the original and its cognates together in one position, with the coupler curve that they share.
///
/// The position is the one at which joints are farthest apart; the position of each cognate is computed from its own
/// lengths and the coupler point. A cognate that does not reach the point is named in the legend and not drawn.
///
/// ```
/// # use linkwright::internals::mechanism::*;
/// let original = FourBar::with_coupler_offset([point([0.0, 0.0]), point([4.0, 1.0])], [2.0, 5.0, 5.0],
///     point([2.5, 4.3]), AssemblyMode::Plus)?;
/// let cognates: Vec<FourBar> = original.cognates().into_iter().flatten().map(|c| c.linkage).collect();
/// let svg = linkwright::internals::report::cognates_sheet::cognates_svg("mine", None, &original, &cognates);
/// assert!(svg.contains(">G</text>") && !svg.contains("not drawn"));
/// # Ok::<(), LinkageError>(())
/// ```
pub fn cognates_svg(name: &str, unit: Option<Unit>, original: &FourBar, cognates: &[FourBar]) -> String {
    let counted = match cognates.len() {
        0 => "no cognate".to_owned(),
        n => plural(n, "cognate"),
    };
    let note = "four-bar linkages with one coupler curve (Roberts 1875, Chebyshev 1878)".to_owned();
    page(&named(name, "unnamed linkage"), &counted, &[note], vec![sheet(unit, original, cognates)])
}

/// The joints A, B, C, D, P of a linkage.
type Joints5 = [Complex; 5];

fn sheet(unit: Option<Unit>, original: &FourBar, cognates: &[FourBar]) -> Sheet {
    let drawn = position(original, cognates);
    let circuits = circuits_through(original, [middle_position(original)], SAMPLES);
    let curve: Vec<Complex> = circuits.iter().flatten().map(|joints| joints.coupler_point).collect();
    let pivots = [original.crank_pivot(), original.follower_pivot()];
    let bounds = Bounds::of(curve.iter().chain(drawn.iter().flatten().flatten()).chain(&pivots).copied());

    let (mut sheet, view) = Sheet::fitted("The linkage and its cognates", &bounds, FULL);
    draw(&mut sheet.body, &view, &view.spots(&curve), &drawn);
    sheet.scale_bar(&view, unit, 0.6 * FULL);

    let mut y = sheet.bottom + 18.0;
    legend(&mut sheet.body, y, palette::CURVE, "the common coupler curve, traced by P", None);
    for (i, linkage) in std::iter::once(original).chain(cognates).enumerate() {
        y += LEGEND_LINE;
        let is_drawn = drawn.get(i).is_some_and(Option::is_some);
        legend(&mut sheet.body, y, COLOURS[i % 3].0, &counted(i), Some(&described(linkage, is_drawn)));
    }
    sheet.note = if drawn.first().is_none_or(Option::is_none) {
        "the links of the original cannot be joined".to_owned()
    } else {
        let pivots = fixed_pivots(&drawn);
        let third = pivots.get(2).map_or(String::new(), |g| {
            format!("; the third fixed pivot G is at ({}, {})", brief(g.re, 6), brief(g.im, 6))
        });
        format!("all in the position that belongs to one point P of the curve{third}")
    };
    sheet.bottom = y + 6.0;
    sheet
}

/// Returns `original`, `first cognate` ..
fn counted(index: usize) -> String {
    match index {
        0 => "original".to_owned(),
        1 => "first cognate".to_owned(),
        2 => "second cognate".to_owned(),
        n => format!("cognate {n}"),
    }
}

fn described(linkage: &FourBar, is_drawn: bool) -> String {
    let kind = linkage.linkage_type().map_or("cannot be joined", |t| t.name());
    let without = if is_drawn { "" } else { ", not drawn: it does not reach P" };
    format!("{kind}{without}; {}", dimensions(linkage))
}

/// Returns the joints of the original and of each cognate at the most legible position; `None` for a linkage that does
/// not reach it.
fn position(original: &FourBar, cognates: &[FourBar]) -> Vec<Option<Joints5>> {
    let (angle, assembly) = middle_position(original);
    let curve = CouplerCurve::through(original, angle, assembly, 8);
    let tried = (0..TRIED).filter_map(|i| {
        let (angle, assembly) = curve.position_at(TAU * i as f64 / TRIED as f64);
        let own = joints_at(original, angle, assembly)?;
        let reached = cognates.iter().map(|cognate| reaching(cognate, own[4]));
        let all: Vec<Option<Joints5>> = std::iter::once(Some(own)).chain(reached).collect();
        Some(((all.iter().flatten().count(), spacing(&all)), all))
    });
    // The first of equal ones.
    let best = tried.reduce(|best, next| if next.0 > best.0 { next } else { best });
    best.map_or(vec![None; 1 + cognates.len()], |(_, all)| all)
}

/// Returns the distance of the closest two of all pins, pivots and P.
fn spacing(all: &[Option<Joints5>]) -> f64 {
    let mut points = fixed_pivots(all);
    points.extend(all.iter().flatten().flat_map(|[_, _, c, d, _]| [*c, *d]));
    points.extend(all.iter().flatten().map(|joints| joints[4]).next());
    closest(&points)
}

fn joints_at(linkage: &FourBar, angle: f64, assembly: AssemblyMode) -> Option<Joints5> {
    Some(all_joints(linkage, &linkage.position_with(angle, assembly).joints()?))
}

/// Returns the joints of a linkage whose coupler point is at `p`: C is an intersection of the circles of radius a about
/// A and d about P, D follows from the coupler's triangle, and the right one of the two answers is that whose follower
/// has its length.
fn reaching(linkage: &FourBar, p: Complex) -> Option<Joints5> {
    let (a, b, z) = (linkage.crank_pivot(), linkage.follower_pivot(), linkage.coupler_ratio());
    let (crank, side) = (linkage.crank(), linkage.crank_side());
    let line = p - a;
    let s = line.norm();
    let size = linkage.longest_link() + crank + side;
    if s <= CLOSURE * size {
        return None;
    }
    if side <= CLOSURE * size {
        // If P is on C, D is either intersection.
        return joints_at(linkage, line.arg(), linkage.assembly())
            .filter(|_| (s - crank).abs() <= CLOSURE * size);
    }
    let along = 0.5 * (s + (crank - side) * (crank + side) / s);
    let across_sq = (crank - along) * (crank + along);
    if across_sq < -CLOSURE * size * size {
        return None;
    }
    let across = across_sq.max(0.0).sqrt();
    let answers = [across, -across].map(|across| {
        let c = a + line / s * Complex::new(along, across);
        let d = c + (p - c) / z; // P = C + z (D - C)
        (((d - b).norm() - linkage.follower()).abs(), [a, b, c, d, p])
    });
    let [left, right] = answers;
    let (miss, joints) = if right.0 < left.0 { right } else { left };
    (miss <= CLOSURE * size).then_some(joints)
}

/// Returns A, B and then the pivots of the cognates that are at neither.
fn fixed_pivots(all: &[Option<Joints5>]) -> Vec<Complex> {
    let mut pivots: Vec<Complex> = Vec::new();
    for (i, joints) in all.iter().enumerate() {
        for pivot in joints.iter().flat_map(|joints| [joints[0], joints[1]]) {
            let size = joints.map_or(0.0, |j| (j[2] - j[0]).norm() + (j[3] - j[1]).norm());
            if i == 0 || pivots.iter().all(|other| (other - pivot).norm() > CLOSURE * size) {
                pivots.push(pivot);
            }
        }
    }
    pivots
}

fn draw(canvas: &mut Canvas, view: &View, curve: &[Spot], drawn: &[Option<Joints5>]) {
    const WEIGHT: f64 = 0.8;
    let pivots = view.spots(&fixed_pivots(drawn));
    canvas.path(&pivots, true, &(outline(palette::MUTED, 1.2) + r#" stroke-dasharray="2 5""#));
    let linkages: Vec<(usize, [Spot; 5])> = drawn
        .iter()
        .enumerate()
        .filter_map(|(i, joints)| Some((i, joints.as_ref()?.map(|p| view.spot(p)))))
        .collect();
    for (i, joints) in &linkages {
        let [.., c, d, p] = *joints;
        let (edge, fill) = COLOURS[i % 3];
        triangle(canvas, [c, d, p], fill, edge, WEIGHT);
        mark_joints(&mut canvas.labels, *joints);
    }
    canvas.path(curve, true, &(outline(palette::CURVE, 2.6) + ROUND_CORNERS));
    canvas.labels.mark_path(curve);
    pivots.iter().for_each(|pivot| stand(canvas, *pivot, WEIGHT));
    for (i, joints) in linkages.iter().rev() {
        let [a, b, c, d, _] = *joints;
        let (edge, _) = COLOURS[i % 3];
        bars(canvas, [a, b, c, d], edge, WEIGHT);
    }
    let Some((_, [.., p])) = linkages.first() else { return };
    point_mark(canvas, *p, 1.1);
    let neighbours: Vec<Spot> = linkages.iter().flat_map(|(_, j)| [j[2], j[3]]).collect();
    letter(canvas, "P", *p, away(*p, &neighbours));
    for (name, pivot) in ["A", "B", "G"].into_iter().zip(&pivots) {
        let arms: Vec<Spot> = linkages
            .iter()
            .flat_map(|(_, j)| [(j[0], j[2]), (j[1], j[3])])
            .filter(|(at, _)| at.distance(*pivot) < 0.5)
            .map(|(_, pin)| pin)
            .collect();
        letter(canvas, name, *pivot, away(*pivot, &arms) + Vec2::new(0.0, -0.4));
    }
    for (i, [a, b, c, d, p]) in &linkages {
        let number = if *i == 0 { String::new() } else { i.to_string() };
        letter(canvas, &format!("C{number}"), *c, away(*c, &[*a, *d, *p]));
        letter(canvas, &format!("D{number}"), *d, away(*d, &[*b, *c, *p]));
    }
}

fn legend(canvas: &mut Canvas, y: f64, colour: &str, name: &str, rest: Option<&str>) {
    let swatch = stroke(colour, 5) + ROUND_ENDS;
    canvas.line(Spot::new(INSET + 4.0, y - 4.0), Spot::new(INSET + 26.0, y - 4.0), &swatch);
    let bold = bold(12.5, palette::INK);
    canvas.text(Spot::new(INSET + 38.0, y), Anchor::Start, &bold, name);
    if let Some(rest) = rest {
        let x = INSET + 38.0 + 1.15 * text_width("second cognate", 12.5) + 14.0;
        let ink = font(12.5, palette::INK);
        let rest = super::sheet::fitting(rest, 12.5, FULL - x - INSET);
        canvas.text(Spot::new(x, y), Anchor::Start, &ink, &rest);
    }
}
