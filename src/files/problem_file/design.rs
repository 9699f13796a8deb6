//! Checks `[design]` before anything is searched: bounds that no linkage satisfies are refused.

use super::raw::RawDesign;
use crate::files::diagnostic::{Checked, Diagnostic};
use crate::files::linkage_file::{no_triangle, triangle_remedy};
use crate::files::toml_text::TomlText;
use crate::mechanism::{FLAT_TOLERANCE, LinkageKind};
use crate::task::Output;
use crate::task::region::Region;
use crate::task::spec::{DesignSpec, Limits, Method, RequireSpec, SolveSpec, TaskSpec};
use crate::task::values::OneOrMore;
use crate::task::without_several_loops::WithoutSeveralLoops;

/// Two quantities that should agree may differ by this part of their scale: a person types few digits.
const TYPED_DIGITS: f64 = 1e-6;

/// Returns the `[design]` table as data, unchecked; `of_places`: of a function whose outputs are places of a slider.
pub(super) fn spec_of(raw: &RawDesign, of_places: bool) -> DesignSpec {
    let limits = |b: Option<crate::files::toml_values::Bounds>| b.map(|b| b.0);
    DesignSpec {
        mechanism: kinds_of(raw, of_places),
        crank_pivot: raw.crank_pivot.map(|p| p.0),
        follower_pivot: raw.follower_pivot.map(|p| p.0),
        a: limits(raw.a),
        b: limits(raw.b),
        c: limits(raw.c),
        d: limits(raw.d),
        e: limits(raw.e),
        ground: limits(raw.ground),
        ground_angle_deg: limits(raw.ground_angle_deg),
        line_deg: limits(raw.line_deg),
        line_point: raw.line_point.map(|p| p.0),
        coupler_x: limits(raw.coupler_x),
        coupler_y: limits(raw.coupler_y),
    }
}

/// Returns the kinds of linkages, sorted; none where they are four-bars alone. Where the file is silent a slider's places are
/// those of a slider-crank.
fn kinds_of(raw: &RawDesign, of_places: bool) -> Vec<LinkageKind> {
    let silent = || if of_places { vec![LinkageKind::SliderCrank] } else { Vec::new() };
    let mut kinds = raw.mechanism.as_ref().map_or_else(silent, |kinds| kinds.0.clone());
    kinds.sort_unstable();
    kinds.dedup();
    // A list of four-bars for places is refused later.
    if kinds == [LinkageKind::FourBar] && !of_places { Vec::new() } else { kinds }
}

/// Refuses keys that go with no kind that is searched for: an empty list of kinds, a line or a stroke without a slider-crank, a
/// kind that has no such output, and sliders by a method that does not search for them.
pub(super) fn of_kinds(
    toml: &TomlText<'_>,
    raw: &RawDesign,
    (task, solve, require): (&TaskSpec, &SolveSpec, &RequireSpec),
) -> Checked<()> {
    let lines = [("line_deg", raw.line_deg.is_some()), ("line_point", raw.line_point.is_some())];
    let kinds = kinds_of(raw, task.is_of_places());
    let has_line = kinds.contains(&LinkageKind::SliderCrank);
    if let Some((key, _)) = lines.into_iter().find(|(_, given)| *given && !has_line) {
        let message = format!("{key} is about the line of a slider-crank, and none is searched for");
        return toml.refuse(
            &format!("design.{key}"),
            message,
            "remove it, or write mechanism = \"slider-crank\"",
        );
    }
    let asked = [("stroke", require.stroke.is_some()), ("time_ratio", require.time_ratio.is_some())];
    if let Some((key, _)) = asked.into_iter().find(|(_, given)| *given && kinds != [LinkageKind::SliderCrank])
    {
        let message = format!("{key} is about a slider-crank, and other kinds are searched for");
        let help = "remove it, or write mechanism = \"slider-crank\" in [design]";
        return toml.refuse(&format!("require.{key}"), message, help);
    }
    if raw.mechanism.as_ref().is_some_and(|OneOrMore(kinds)| kinds.is_empty()) {
        return toml.refuse(
            "design.mechanism",
            "no kind of linkage is listed",
            "write mechanism = \"four-bar\"",
        );
    }
    of_several_loops(toml, raw, &kinds, (task, solve, require))?;
    if let Some(output) = task.output.as_ref().map(|output| output.output)
        && let Some(kind) = kinds.iter().find(|kind| !output.is_of(**kind))
    {
        let help = match output {
            Output::Angle => "write output = [..], the places of its slider",
            Output::Place => "write output_deg = [..], the angles of its follower",
        };
        let message = format!("{} has {}", kind.with_article(), output.missing());
        return toml.refuse("design.mechanism", message, help);
    }
    let Some(slider) = kinds.iter().find(|kind| kind.has_slider()) else { return Ok(()) };
    let method = solve.method;
    // Continuation says itself which linkages with a slider it finds.
    if method.finds_sliders() || method == Method::Continuation {
        return Ok(());
    }
    let why =
        format!("\"{slider}\" is searched for by least squares alone, not by method = \"{}\"", method.name());
    if raw.mechanism.is_none() {
        return toml.refuse_key(
            "task.function",
            why,
            "a slider's places are those of a slider-crank: change the rest",
        );
    }
    toml.refuse("design.mechanism", why, "write mechanism = \"four-bar\", or change what does not go with it")
}

/// Refuses six-bars and eight-bars where they are not searched for ([`WithoutSeveralLoops`]), and keys that bound nothing of theirs
/// where no other kind is searched for.
fn of_several_loops(
    toml: &TomlText<'_>,
    raw: &RawDesign,
    kinds: &[LinkageKind],
    (task, solve, require): (&TaskSpec, &SolveSpec, &RequireSpec),
) -> Checked<()> {
    let Some(kind) = kinds.iter().find(|kind| kind.dyads().is_some()) else { return Ok(()) };
    if let Some(reason) = WithoutSeveralLoops::of(task, solve, require) {
        let help = "leave it out of the list, or change what does not go with it";
        return toml.refuse("design.mechanism", format!("\"{kind}\" {reason}"), help);
    }
    if kinds.iter().any(|kind| kind.dyads().is_none()) {
        return Ok(());
    }
    if !require.types.is_empty() {
        let message = format!("type is about four-bars, and {} has none", kind.with_article());
        return toml.refuse("require.type", message, "remove it: the crank of every six-bar turns fully");
    }
    let bounds = [
        ("a", raw.a.is_some()),
        ("b", raw.b.is_some()),
        ("c", raw.c.is_some()),
        ("d", raw.d.is_some()),
        ("e", raw.e.is_some()),
        ("ground", raw.ground.is_some()),
        ("ground_angle_deg", raw.ground_angle_deg.is_some()),
        ("coupler_x", raw.coupler_x.is_some()),
        ("coupler_y", raw.coupler_y.is_some()),
    ];
    if let Some((key, _)) = bounds.into_iter().find(|(_, given)| *given) {
        let message = format!("{key} bounds nothing of {}: A and B alone do", kind.with_article());
        let help = "remove it; longest_max and link_ratio_max in [require] bound all of its lengths";
        return toml.refuse(&format!("design.{key}"), message, help);
    }
    for (key, pivot) in [("A", raw.crank_pivot), ("B", raw.follower_pivot)] {
        if pivot.is_some_and(|pivot| pivot.0.iter().any(Limits::is_fixed)) {
            let of = kind.with_article();
            let message = format!("{key} is fixed, and the pivots of {of} are searched for in boxes");
            let help = format!("write {key} = [[xmin, xmax], [ymin, ymax]]");
            return toml.refuse(&format!("design.{key}"), message, help);
        }
    }
    Ok(())
}

/// Refuses lengths that are no lengths and bounds that contradict one another.
pub(super) fn check(toml: &TomlText<'_>, design: &DesignSpec) -> Checked<()> {
    lengths(toml, design)?;
    triangle(toml, design)?;
    coupler_point(toml, design)?;
    ground(toml, design)
}

/// Refuses bounds of a coupler point, which a function does not have.
pub(super) fn of_function(toml: &TomlText<'_>, design: &DesignSpec) -> Checked<()> {
    let DesignSpec { d, e, coupler_x, coupler_y, .. } = design;
    let given = [("d", d), ("e", e), ("coupler_x", coupler_x), ("coupler_y", coupler_y)];
    match given.into_iter().find(|(_, limits)| limits.is_some()) {
        None => Ok(()),
        Some((key, _)) => {
            let message = format!("{key} is about a coupler point, which a function does not have");
            toml.refuse(&format!("design.{key}"), message, "remove it: P is drawn at the follower's pin")
        }
    }
}

fn lengths(toml: &TomlText<'_>, design: &DesignSpec) -> Checked<()> {
    let links = [("a", design.a), ("b", design.b), ("c", design.c), ("ground", design.ground)];
    let distances = [("d", design.d), ("e", design.e)];
    for (key, limits) in links.into_iter().chain(distances) {
        let Some(limits) = limits else { continue };
        let path = format!("design.{key}");
        if limits.0 < 0.0 {
            let (given, help) = match limits.is_fixed() {
                true => (format!("{key} ="), "write a length above 0"),
                false => (format!("the lower bound of {key} is"), "write a lower bound of 0 or more"),
            };
            let message = format!("{given} {}: a length cannot be negative", limits.0);
            return toml.refuse(&path, message, help);
        }
        if limits.1 == 0.0 && links.iter().any(|(link, _)| *link == key) {
            let message = format!("{key} is fixed at 0: a link's length must be positive");
            return toml.refuse(&path, message, "write a length above 0, or bounds [min, max]");
        }
    }
    Ok(())
}

/// Refuses b, d and e that are not the sides of a triangle.
fn triangle(toml: &TomlText<'_>, design: &DesignSpec) -> Checked<()> {
    let (Some(b), Some(d), Some(e)) = (design.b, design.d, design.e) else { return Ok(()) };
    let sides = [("b", b), ("d", d), ("e", e)];
    for i in 0..3 {
        let [(name, Limits(least, _)), (n1, Limits(_, s1)), (n2, Limits(_, s2))] =
            [sides[i], sides[(i + 1) % 3], sides[(i + 2) % 3]];
        if least <= (s1 + s2) * (1.0 + FLAT_TOLERANCE) {
            continue;
        }
        let path = if name == "b" { "design.d".to_owned() } else { format!("design.{name}") };
        if sides.iter().all(|(_, side)| side.is_fixed()) {
            return toml.refuse(&path, no_triangle(b.0, d.0, e.0), triangle_remedy(b.0, d.0, e.0));
        }
        let sum = s1 + s2;
        let message = format!(
            "impossible triangle: {name} is at least {least}, but {n1} + {n2} at most {s1} + {s2} = {sum}"
        );
        let help = format!("lower {name}, or raise the upper bounds of {n1} and {n2}");
        return toml.refuse(&path, message, help);
    }
    Ok(())
}

/// Refuses d and e that contradict coupler_x and coupler_y, which determine the same point.
fn coupler_point(toml: &TomlText<'_>, design: &DesignSpec) -> Checked<()> {
    let (Some(x), Some(y)) = (design.coupler_x, design.coupler_y) else { return Ok(()) };
    let along_from_d = design.b.map(|b| Limits(x.0 - b.1, x.1 - b.0));
    let given = [("d", design.d, Some(x), "from C"), ("e", design.e, along_from_d, "from D")];
    for (key, limits, along, from) in given {
        let (Some(limits), Some(along)) = (limits, along) else { continue };
        let reach = norm_range([along, y]);
        if are_apart(limits, reach) {
            let (given, reach) = (words(limits), words(reach));
            let message =
                format!("{key} is {given}, but coupler_x and coupler_y put the coupler point {reach} {from}");
            let help = "give either d and e or coupler_x and coupler_y, or make them agree";
            return toml.refuse(&format!("design.{key}"), message, help);
        }
    }
    Ok(())
}

/// Refuses pivots that contradict `ground` and `ground_angle_deg`.
fn ground(toml: &TomlText<'_>, design: &DesignSpec) -> Checked<()> {
    let (Some(a), Some(b)) = (design.crank_pivot, design.follower_pivot) else { return Ok(()) };
    let apart = [0, 1].map(|axis| Limits(b[axis].0 - a[axis].1, b[axis].1 - a[axis].0));
    let reach = norm_range(apart);
    if reach.1 == 0.0 {
        let help = "put the pivots apart: a four-bar has a ground link of some length";
        return toml.refuse("design.B", "A and B are the same point", help);
    }
    if let Some(ground) = design.ground
        && are_apart(ground, reach)
    {
        let message = format!("ground is {}, but A and B are {} apart", words(ground), words(reach));
        return toml.refuse("design.ground", message, "leave out ground, or make it agree with A and B");
    }
    if let Some(angle) = design.ground_angle_deg
        && apart.iter().all(Limits::is_fixed)
    {
        let given = f64::atan2(apart[1].0, apart[0].0).to_degrees();
        let turns_below = ((angle.1 - given) / 360.0 + TYPED_DIGITS).floor();
        if given + 360.0 * turns_below < angle.0 - 360.0 * TYPED_DIGITS {
            let (angle, given) = (words(angle), rounded(given));
            let message =
                format!("ground_angle_deg is {angle}, but the line from A to B is at {given} degrees");
            let help = "leave out ground_angle_deg, or make it agree with A and B";
            return toml.refuse("design.ground_angle_deg", message, help);
        }
    }
    Ok(())
}

/// Refuses pivots outside their box, and returns a warning about a link ratio that no linkage inside the bounds has: the
/// search is still of use.
pub(super) fn against_requirements(
    toml: &TomlText<'_>,
    design: &DesignSpec,
    require: &RequireSpec,
) -> Checked<Option<Diagnostic>> {
    if let Some([x0, y0, x1, y1]) = require.pivots_in.as_ref().map(Region::corners) {
        for (key, pivot) in [("A", design.crank_pivot), ("B", design.follower_pivot)] {
            let Some([x, y]) = pivot else { continue };
            if x.0 > x1 || x.1 < x0 || y.0 > y1 || y.1 < y0 {
                let message = format!("{key} lies outside pivots_in = [{x0}, {y0}, {x1}, {y1}]");
                let help = format!("move {key}, or widen pivots_in in [require]");
                return toml.refuse(&format!("design.{key}"), message, help);
            }
        }
    }
    let links = [("ground", design.ground), ("a", design.a), ("b", design.b), ("c", design.c)];
    let given = || links.iter().filter_map(|(key, limits)| limits.map(|l| (*key, l)));
    let longest = given().max_by(|l, r| l.1.0.total_cmp(&r.1.0));
    let shortest = given().min_by(|l, r| l.1.1.total_cmp(&r.1.1));
    let (Some((long, longest)), Some((short, shortest))) = (longest, shortest) else { return Ok(None) };
    let most = require.link_ratio_max;
    if longest.0 <= most * shortest.1 * (1.0 + TYPED_DIGITS) {
        return Ok(None);
    }
    let lengths = format!("{long} is {} and {short} is {}", words(longest), words(shortest));
    let message = format!("no answer can be accepted: {lengths}, while link_ratio_max is {most}");
    let help = "raise link_ratio_max in [require], or change the lengths";
    Ok(Some(toml.at(&format!("design.{long}"), message).with_help(help)))
}

/// Refuses lines of `pivot_on` that pass by the bounds of their pivot, given or by default, or by the box of both.
pub(super) fn against_lines(toml: &TomlText<'_>, design: &DesignSpec, require: &RequireSpec) -> Checked<()> {
    let loci = require.pivot_on.as_ref().map_or([None; 2], |pivot_on| pivot_on.both());
    let region = require.pivots_in.as_ref().map(Region::corners);
    for ((key, pivot), locus) in
        [("A", design.crank_pivot), ("B", design.follower_pivot)].into_iter().zip(loci)
    {
        let Some(locus) = locus else { continue };
        let bounds = pivot.map(|[x, y]| [x.0, y.0, x.1, y.1]);
        for (corners, name) in [(bounds, format!("design.{key}")), (region, "pivots_in".to_owned())] {
            let Some(corners @ [x0, y0, x1, y1]) = corners else { continue };
            if !locus.meets(corners) {
                let [x0, y0, x1, y1] = [x0, y0, x1, y1].map(rounded);
                let message =
                    format!("the line of {key} passes by {name}, the box from ({x0}, {y0}) to ({x1}, {y1})");
                let help = match name.as_str() {
                    "pivots_in" => "move the line, or widen pivots_in".to_owned(),
                    _ => format!("move the line, or give {key} = [[xmin, xmax], [ymin, ymax]] in [design]"),
                };
                return toml.refuse("require.pivot_on", message, help);
            }
        }
    }
    Ok(())
}

/// Returns the bounds of the lengths of the vectors in a box.
fn norm_range([x, y]: [Limits; 2]) -> Limits {
    let least = |l: Limits| if l.0 > 0.0 { l.0 } else { (-l.1).max(0.0) };
    let most = |l: Limits| l.0.abs().max(l.1.abs());
    Limits(least(x).hypot(least(y)), most(x).hypot(most(y)))
}

fn are_apart(x: Limits, y: Limits) -> bool {
    let slack = TYPED_DIGITS * x.1.abs().max(y.1.abs());
    x.0 > y.1 + slack || x.1 < y.0 - slack
}

fn words(limits: Limits) -> String {
    let (low, high) = (rounded(limits.0), rounded(limits.1));
    if low == high { low.to_string() } else { format!("between {low} and {high}") }
}

/// Returns a number with six digits, enough for a message.
fn rounded(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}
