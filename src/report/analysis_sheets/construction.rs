//! The construction of a position with ruler and compasses: C from the crank angle, D as an intersection of the circle
//! of radius b about C with the circle of radius c about B.

use super::{closed, degrees};
use crate::mechanism::analysis::{Analysis, Configuration};
use crate::mechanism::{Complex, FourBar, cross};
use crate::report::canvas::{
    Canvas, ROUND_ENDS, SHARP_CORNERS, Spot, Vec2, filled, font, haloed, outline, palette, stroke,
};
use crate::report::labels::Beside;
use crate::report::parts::{away, bars, letter, stand};
use crate::report::scene::Bounds;
use crate::report::sheet::{Sheet, arc, sign};
use crate::report::text::brief;
use crate::report::words;

/// The part of the crank's circle that is drawn on both sides of C, in radians.
const CRANK_ARC: f64 = 0.35;
/// The angle by which an arc continues beyond an intersection, in radians.
const BEYOND: f64 = 0.2;
/// The angle from the line C-B, in radians, above which intersections get an arc each instead of one for both.
const APART: f64 = 1.2;

pub(super) fn sheet(analysis: &Analysis, configuration: &Configuration, width: f64) -> Option<Sheet> {
    let linkage = &configuration.linkage;
    let (row, joints) = closed(configuration).into_iter().next()?;
    let [a, b, c, d, _] = joints;
    let phi = row.crank_deg.to_radians();
    let other = linkage.position_with(phi, linkage.assembly().opposite()).joints().map(|j| j.follower_pin);
    let coincide = other.is_none_or(|other| (other - d).norm() <= 1e-6 * linkage.longest_link());
    let other = other.filter(|_| !coincide);

    let crank = [arc(a, linkage.crank(), phi - CRANK_ARC, phi + CRANK_ARC).collect()];
    let about_c = arcs(c, linkage.coupler(), b, d, other);
    let about_b = arcs(b, linkage.follower(), c, d, other);
    let arcs = crank.iter().chain(&about_c).chain(&about_b).flatten().copied();
    let bounds = Bounds::of([a, b, c, d].into_iter().chain(other).chain(arcs));

    let (mut sheet, view) = Sheet::fitted("Construction by arcs", &bounds, width);
    let body = &mut sheet.body;
    for (strokes, colour) in
        [(&crank[..], palette::MUTED), (&about_c[..], palette::TARGET), (&about_b[..], palette::FOLLOWER)]
    {
        for stroke in strokes {
            let spots = view.spots(stroke);
            body.path(&spots, false, &(outline(colour, 1.6) + ROUND_ENDS));
            body.labels.mark_path(&spots);
        }
    }
    let [sa, sb, sc, sd] = [a, b, c, d].map(|p| view.spot(p));
    if let Some(other) = other {
        let at = view.spot(other);
        let dashed = stroke(palette::MUTED, 1.6) + r#" stroke-dasharray="6 5""#;
        for from in [sc, sb] {
            body.line(from, at, &dashed);
            body.labels.mark_line(from, at);
        }
        body.circle(at, 4.2, &filled(palette::PAPER, palette::MUTED, 1.6));
    }
    for (from, to) in [(sa, sc), (sc, sd), (sb, sd)] {
        body.labels.mark_line(from, to);
        body.labels.mark_line(from, to);
    }
    for pivot in [sa, sb] {
        stand(body, pivot, 0.9);
        body.labels.mark_line(pivot + Vec2::new(-14.0, 15.0), pivot + Vec2::new(14.0, 15.0));
    }
    bars(body, [sa, sb, sc, sd], palette::BAR_EDGE, 0.75);
    letter(body, "A", sa, away(sa, &[sc]));
    letter(body, "B", sb, away(sb, &[sd]));
    letter(body, "C", sc, away(sc, &[sa, sd]));
    letter(body, "D", sd, away(sd, &[sb, sc]));
    if let Some(other) = other.map(|p| view.spot(p)) {
        letter(body, "D′", other, away(other, &[sb, sc]));
    }
    for (name, from, to, colour) in
        [("a", sa, sc, palette::INK), ("b", sc, sd, palette::TARGET_TEXT), ("c", sb, sd, palette::FOLLOWER)]
    {
        link_name(body, name, from, to, colour);
    }
    crank_angle(body, [sa, sc], phi, &format!("φ = {}", degrees(row.crank_deg)));
    sheet.scale_bar(&view, analysis.unit, width);
    sheet.note = format!("the first position that closes, crank at {}", degrees(row.crank_deg));
    sheet.foot = steps(analysis, linkage, joints, other);
    Some(sheet)
}

/// Returns the steps of the construction in words.
fn steps(
    analysis: &Analysis,
    linkage: &FourBar,
    joints: [Complex; 5],
    other: Option<Complex>,
) -> Vec<String> {
    let [a, b, c, d, _] = joints;
    let unit = words::length_suffix(analysis.unit);
    let length = |x: f64| format!("{}{unit}", brief(x, 6));
    let shape = |pin: Complex| if crosses_itself([a, b, c, pin]) { "crossed" } else { "open" };
    let own = sign(linkage.assembly().sign());
    let found = match other {
        Some(other) => format!(
            "D (t1 = {own}, {}) and D′ (t1 = {}, {})",
            shape(d),
            sign(linkage.assembly().opposite().sign()),
            shape(other)
        ),
        None => "D alone: C, D and B are in line, a toggle".to_owned(),
    };
    vec![
        format!(
            "1. crank a = {} gives C; 2. arc b = {} about C;",
            length(linkage.crank()),
            length(linkage.coupler())
        ),
        format!("3. arc c = {} about B; they meet in", length(linkage.follower())),
        found,
    ]
}

/// Returns the arcs about `centre` through the two intersections, which lie on both sides of the line to `towards`.
fn arcs(
    centre: Complex,
    radius: f64,
    towards: Complex,
    pin: Complex,
    other: Option<Complex>,
) -> Vec<Vec<Complex>> {
    let line = towards - centre;
    let from_line = |p: Complex| {
        let to = p - centre;
        if line.norm() > 0.0 { (to * line.conj()).arg() } else { to.arg() }
    };
    let middle = if line.norm() > 0.0 { line.arg() } else { 0.0 };
    let stroke = |from: f64, to: f64| arc(centre, radius, middle + from, middle + to).collect();
    let at = from_line(pin);
    match other {
        Some(_) if at.abs() <= APART => vec![stroke(-at.abs() - BEYOND, at.abs() + BEYOND)],
        Some(other) => [at, from_line(other)].map(|angle| stroke(angle - BEYOND, angle + BEYOND)).to_vec(),
        None => vec![stroke(at - 2.0 * BEYOND, at + 2.0 * BEYOND)],
    }
}

/// Returns whether crank and follower, or coupler and ground, cross.
fn crosses_itself([a, b, c, d]: [Complex; 4]) -> bool {
    let apart = |p: Complex, q: Complex, x: Complex, y: Complex| {
        let (dx, dy) = (cross(q - p, x - p), cross(q - p, y - p));
        (dx < 0.0 && dy > 0.0) || (dx > 0.0 && dy < 0.0)
    };
    let meet = |p: Complex, q: Complex, x: Complex, y: Complex| apart(p, q, x, y) && apart(x, y, p, q);
    meet(a, c, b, d) || meet(c, d, a, b)
}

/// Draws the crank angle between the x axis and the crank.
fn crank_angle(canvas: &mut Canvas, [pivot, pin]: [Spot; 2], phi: f64, text: &str) {
    let radius = (0.4 * pivot.distance(pin)).clamp(8.0, 40.0);
    let end = Spot::new(pivot.x + radius + 14.0, pivot.y);
    canvas.line(pivot, end, &(stroke(palette::MUTED, 1) + r#" stroke-dasharray="2 3""#));
    canvas.labels.mark_line(pivot, end);
    let turn = phi.rem_euclid(std::f64::consts::TAU);
    // Counter-clockwise in the plane is clockwise with y down.
    let spots: Vec<Spot> =
        arc(Complex::ZERO, radius, 0.0, turn).map(|p| pivot + Vec2::new(p.re, -p.im)).collect();
    canvas.path(&spots, false, &outline(palette::MUTED, 1));
    canvas.labels.mark_path(&spots);
    let towards = Vec2::new((0.5 * turn).cos(), -(0.5 * turn).sin());
    let attributes = haloed(&font(12, palette::INK), "2.5", SHARP_CORNERS);
    let beside = Beside { point: pivot + radius * towards, distance: 8.0, towards, needed: true };
    canvas.label(text, 12.0, &attributes, beside);
}

/// Draws the letter of a link beside its middle.
fn link_name(canvas: &mut Canvas, name: &str, from: Spot, to: Spot, colour: &str) {
    let length = from.distance(to).max(f64::MIN_POSITIVE);
    let towards = Vec2::new((to.y - from.y) / length, (from.x - to.x) / length);
    let italic = format!(r#"font-size="14" font-style="italic" fill="{colour}""#);
    let beside = Beside { point: from.midpoint(to), distance: 7.0, towards, needed: false };
    canvas.label(name, 14.0, &haloed(&italic, "2.5", SHARP_CORNERS), beside);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanism::AssemblyMode;

    fn romero() -> FourBar {
        let pivots = [Complex::new(0.0, 0.0), Complex::new(4.0, 1.0)];
        let offset = Complex::new(2.5, 4.330_127_018_922_193);
        FourBar::with_coupler_offset(pivots, [2.0, 5.0, 5.0], offset, AssemblyMode::Plus).expect("a linkage")
    }

    #[test]
    fn the_example_of_romero_is_open_on_one_side_and_crossed_on_the_other() {
        let linkage = romero();
        let shapes = [AssemblyMode::Plus, AssemblyMode::Minus].map(|t1| {
            let joints = linkage.position_with(1.0, t1).joints().expect("a crank-rocker closes");
            let (a, b) = (linkage.crank_pivot(), linkage.follower_pivot());
            crosses_itself([a, b, joints.crank_pin, joints.follower_pin])
        });
        assert_eq!(shapes, [false, true]);
    }
}
