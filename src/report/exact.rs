//! The linkages through nine points, or poses and points, or eight points of a linkage with a slider (exact synthesis), in words
//! and as a table.

use super::grid::Align::{Left, Right};
use super::grid::{Colour, Grid, Ink, plain, verdict};
use super::text::{COLUMNS, clean, grouped, indented, shortened, significant, wrapped};
use super::words;
use crate::mechanism::{AssemblyMode, LinkageKind};
use crate::record::{Census, Completeness, ExactLinkage, ExactRecord, Record};
use crate::task::Defect;

/// The number of rows if not all are asked for.
const FEW: usize = 8;

/// Returns the census and the real linkages, the best of them or `all`; empty for a record without any.
pub fn exact_text(record: &Record, all: bool, colour: Colour) -> String {
    let Some(exact) = &record.exact else { return String::new() };
    let mut out = format!("\n  {}\n", colour.paint(Ink::Strong, &title(exact)));
    for sentence in said(record, exact) {
        out.push_str(&wrapped("    ", "    ", &sentence, COLUMNS));
    }
    if exact.linkages.is_empty() {
        return out;
    }
    let shown = if all { exact.linkages.len() } else { exact.linkages.len().min(FEW) };
    out.push('\n');
    out.push_str(&rows(record, &exact.linkages[..shown], colour));
    let mut key = format!(
        "curve: what {} can do. defects, transmission, ratio: of the one listed. t1: how it is assembled at each {}. \
         radius: one exact linkage is proved to stand this near.",
        best_of(exact),
        if exact.poses == 0 { "point" } else { "target" }
    );
    let more = exact.linkages.len() - shown;
    if more > 0 {
        key.push_str(&format!(
            " {more} more: --all, or exact.linkages in the record; all are drawn in exact.svg."
        ));
    }
    out.push('\n');
    out.push_str(&indented(&key));
    out
}

/// Returns the census in sentences, or the one sentence in its place.
pub(super) fn said(record: &Record, exact: &ExactRecord) -> Vec<String> {
    let said = none_through(record).map_or_else(|| sentences(exact).to_vec(), |one| vec![one]);
    said.into_iter().filter(|sentence| !sentence.is_empty()).collect()
}

/// Returns the poses and points in words, and whether fixed pivots are given: "nine points".
pub fn targets(exact: &ExactRecord) -> String {
    const NUMBERS: [&str; 10] =
        ["no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine"];
    let ExactRecord { kind, poses, pivots, .. } = *exact;
    let free = match poses {
        0 if kind.has_slider() => 8,
        0 => 9,
        _ => 10 - 2 * poses.min(5),
    };
    let points = free - (2 * pivots).min(free);
    let counted = |n: usize, noun: &str| {
        (n > 0).then(|| format!("{} {noun}{}", NUMBERS[n.min(9)], if n == 1 { "" } else { "s" }))
    };
    let parts: Vec<String> =
        [counted(poses, "pose"), counted(points, "point")].into_iter().flatten().collect();
    let given = ["", " with one fixed pivot given", " with both fixed pivots given"][pivots.min(2)];
    parts.join(" and ") + given
}

/// Returns whether the targets are points alone.
fn has_points_alone(exact: &ExactRecord) -> bool {
    exact.poses == 0 && exact.pivots == 0
}

/// Returns the name of one of the linkages.
pub fn noun(exact: &ExactRecord) -> &'static str {
    match exact.kind {
        LinkageKind::SliderCrank => "slider-crank",
        LinkageKind::InvertedSliderCrank => "inverted slider-crank",
        _ => "linkage",
    }
}

/// Returns the heading of the list.
pub(super) fn title(exact: &ExactRecord) -> String {
    format!("Every {} through the {}", noun(exact), targets(exact))
}

/// Returns what a class is listed by.
pub(super) fn best_of(exact: &ExactRecord) -> &'static str {
    match (exact.kind, exact.poses, exact.pivots) {
        (LinkageKind::SliderCrank, ..) => "the better of its two mechanisms (two cognates)",
        (LinkageKind::InvertedSliderCrank, ..) => "the linkage (it has no cognates)",
        (_, 0, 0) => "the best of its six mechanisms (three cognates, either link driven)",
        (_, 0, 1) => "the best of its four mechanisms (two cognates with that pivot, either link driven)",
        _ => "the better of its two mechanisms (either link driven)",
    }
}

/// Returns up to what solutions are counted once.
fn up_to(exact: &ExactRecord) -> &'static str {
    match (exact.kind, exact.poses, exact.pivots) {
        (LinkageKind::InvertedSliderCrank, ..) => "",
        (_, 0, 0 | 1) => " up to cognates",
        (_, _, 0) => " up to the order of the two links",
        _ => "",
    }
}

/// Returns one plain sentence instead of a census if the points are in special position and no solution was found.
pub fn none_through(record: &Record) -> Option<String> {
    let exact = record.exact.as_ref()?;
    if exact.completeness != Completeness::NonGeneric || exact.census.classes > 0 {
        return None;
    }
    let nearest = if record.candidates.is_empty() {
        "method = \"auto\" looks for some that come near"
    } else {
        "the candidates come near"
    };
    let has_line = exact.kind == LinkageKind::FourBar && has_points_alone(exact);
    if has_line && on_one_line(&record.problem.resolved.task.points) {
        return Some(format!(
            "The nine points lie on one line, and a coupler curve meets a line in at most six points: no linkage passes \
             through all nine; {nearest}."
        ));
    }
    // A whole family of slider-cranks draws a straight line.
    let isolated = if exact.kind.has_slider() { "isolated " } else { "" };
    let (all, noun, general) = (targets(exact), noun(exact), count(exact.generic_classes()));
    Some(format!(
        "The {all} are non-generic (in special position), and no {isolated}{noun} through all of them was found ({all} in \
         general position have {general} solutions): {nearest}."
    ))
}

/// Returns whether points lie on one line, within the rounding of their extent.
fn on_one_line(points: &[[f64; 2]]) -> bool {
    const ROUNDING: f64 = 1e-9;
    let from = |p: &[f64; 2]| [p[0] - points[0][0], p[1] - points[0][1]];
    let length = |v: &[f64; 2]| v[0].hypot(v[1]);
    let Some(far) = points.iter().map(from).max_by(|v, w| length(v).total_cmp(&length(w))) else {
        return false;
    };
    let extent = length(&far);
    points.iter().map(from).all(|v| (v[0] * far[1] - v[1] * far[0]).abs() <= ROUNDING * extent * extent)
}

/// Returns sentences on the number and kind of solutions, the search for them, and the proof.
pub fn sentences(exact: &ExactRecord) -> [String; 4] {
    [found(exact), real(exact), paths(&exact.census), proof(exact)]
}

fn count(n: usize) -> String {
    grouped(n as u64)
}

/// Returns the number of solutions, and the kind of points.
fn found(exact: &ExactRecord) -> String {
    let census = &exact.census;
    let found = count(census.classes);
    let all = count(exact.generic_classes());
    let (targets, up_to) = (targets(exact), up_to(exact));
    let some = format!("{found} of {all} solutions{up_to} were found");
    match exact.completeness {
        Completeness::Complete => {
            format!("{found} solutions{up_to}: as many as {targets} in general position have.")
        }
        Completeness::NonGeneric => {
            let isolated = count(census.certified);
            let mut text = format!(
                "The {} are non-generic: {isolated} isolated solutions{up_to} were found, where {} in general position \
                 have {all}.",
                if has_points_alone(exact) { "points" } else { &targets },
                if has_points_alone(exact) { "points" } else { &targets },
            );
            if census.not_certified > 0 {
                let rest = count(census.not_certified);
                text.push_str(&format!(" {rest} more may be members of whole families of solutions."));
            }
            text
        }
        Completeness::Incomplete => some + ": some may be missing, for paths were lost or ended together.",
        Completeness::Cancelled => some + " until the search was stopped.",
    }
}

fn real(exact: &ExactRecord) -> String {
    let census = &exact.census;
    let real = match census.real {
        1 => "1 is a linkage".to_owned(),
        n => format!("{} are linkages", count(n)),
    };
    let without = if exact.poses == 0 {
        "have a real curve that no real linkage draws"
    } else {
        "have links that are conjugates of each other"
    };
    let complex = count(census.complex);
    // The conjugate of a real curve is a cognate's, or the other link's.
    let is_alone = exact.pivots > 0 || exact.kind == LinkageKind::InvertedSliderCrank;
    let mut text = if is_alone && census.real_curve == 0 {
        format!("{real}, {complex} are complex.")
    } else {
        format!("{real}, {} more {without}, {complex} are complex.", count(census.real_curve))
    };
    if census.degenerate > 0 {
        text.push_str(&format!(
            " {} of the real ones cannot be listed: a link has no length.",
            census.degenerate
        ));
    }
    if census.real > 0 {
        text.push_str(&format!(
            " Of the real ones {} can pass all {} on one circuit, {} of them in order, {} of these on one branch: \
             free of defects.",
            count(census.one_circuit),
            if exact.poses == 0 { "points" } else { "targets" },
            count(census.in_order),
            count(census.free_of_defects)
        ));
    }
    text
}

fn paths(census: &Census) -> String {
    let others = [
        (census.duplicate, "at an end found before"),
        (census.singular, "at infinity or where solutions meet"),
        (census.failed, "lost"),
    ];
    let parts: Vec<String> =
        others.iter().filter(|(n, _)| *n > 0).map(|(n, what)| format!("{} {what}", count(*n))).collect();
    let rest = if parts.is_empty() { "none lost".to_owned() } else { parts.join(", ") };
    format!("{} paths followed: {} different ends, {rest}.", count(census.tracked), count(census.classes))
}

/// Returns the statement of the proof and its limits.
fn proof(exact: &ExactRecord) -> String {
    let census = &exact.census;
    let mut text = match (census.certified, census.not_certified) {
        (0, _) => return "No solution is proved to exist, or to be isolated.".to_owned(),
        (n, 0) => format!("Proved: each of the {} exists", count(n)),
        (n, without) => format!("Proved: {} of them exist ({} without a proof)", count(n), count(without)),
    };
    text.push_str(", each alone within its radius");
    text.push_str(&match census.not_told_apart {
        0 => ", and no two are the same".to_owned(),
        1 => ", and no two are the same but for 1 pair that may be".to_owned(),
        n => format!(", and no two are the same but for {} pairs that may be", count(n)),
    });
    if census.reality_proved == census.certified {
        text.push_str("; and each is real or not as counted");
    } else {
        text.push_str(&format!("; {} are proved to be real or not as counted", count(census.reality_proved)));
    }
    text.push_str(". Not proved: that there are no others; ");
    text.push_str(if exact.generic {
        match (exact.kind, exact.poses, exact.pivots) {
            (LinkageKind::SliderCrank, ..) => "that rests on the count published by Tari and Su (2010).",
            (LinkageKind::FourBar, 0 | 1, 0) => {
                "that rests on the count published by Wampler, Morgan and Sommese (1992)."
            }
            (LinkageKind::FourBar, 2..=4, 0) => {
                "that rests on the count published by Brake, Hauenstein, Murray, Myszka and Wampler (2016)."
            }
            (LinkageKind::FourBar, _, 0) => "that rests on Burmester's count of dyads, four at most.",
            (LinkageKind::FourBar, 0 | 1, 2) => {
                "that rests on the count published by Morgan and Wampler (1990)."
            }
            _ => "that rests on a count by monodromy, made twice from different beginnings.",
        }
    } else {
        "and solutions that are not isolated are not listed."
    });
    text
}

/// Returns the abilities of a class: those of the best of its mechanisms.
pub fn ability(linkage: &ExactLinkage) -> &'static str {
    match (linkage.free_of_defects, linkage.in_order, linkage.one_circuit) {
        (true, ..) => "free of defects",
        (_, true, _) => "in order",
        (.., true) => "one circuit",
        _ => "two circuits",
    }
}

/// Returns the defects of a linkage in words.
pub(super) fn defects(linkage: &ExactLinkage) -> String {
    let names: Vec<&str> = linkage.defects.iter().map(Defect::name).collect();
    if names.is_empty() { "none".to_owned() } else { names.join(", ") }
}

/// Returns the names of the requirements that a linkage misses, other than those for which it has a defect.
pub(super) fn others(linkage: &ExactLinkage) -> Vec<String> {
    let of_defect = |name: &str| linkage.defects.iter().any(|defect| defect.name() == name);
    let names = linkage.not_met.iter().filter(|name| !of_defect(name));
    names.map(|name| clean(name.strip_prefix("design.").unwrap_or(name))).collect()
}

fn rows(record: &Record, linkages: &[ExactLinkage], colour: Colour) -> String {
    let rank = |l: &ExactLinkage| if l.rank > 0 { format!("#{}", l.rank) } else { String::new() };
    let signs = |l: &ExactLinkage| -> String {
        let signs = l.t1_at.iter().take(COLUMNS / 4);
        signs.map(|t1| if *t1 == AssemblyMode::Plus { '+' } else { '-' }).collect()
    };
    let radius = |l: &ExactLinkage| match l.certified {
        Some(proof) => format!("{}{}", significant(proof.radius, 1), words::unit_suffix(record)),
        None => "no proof".to_owned(),
    };
    let said = |l: &ExactLinkage| match (l.accepted, others(l).as_slice()) {
        (true, _) => "accepted".to_owned(),
        (false, []) => "no".to_owned(),
        (false, [only]) => format!("no: {only}"),
        (false, [first, rest @ ..]) => format!("no: {first} +{}", rest.len()),
    };
    let numbered: Vec<(usize, &ExactLinkage)> = (1..).zip(linkages).collect();
    let grid = Grid::of(
        &numbered,
        &[
            (Right, "", &|(number, _)| plain(number.to_string())),
            (Right, "#", &|(_, l)| (rank(l), Ink::Strong)),
            (Left, "curve", &|(_, l)| plain(ability(l))),
            (Left, "type", &|(_, l)| plain(l.type_name())),
            (Left, "t1", &|(_, l)| plain(signs(l))),
            (Left, "defects", &|(_, l)| plain(defects(l))),
            (Right, "transmission", &|(_, l)| {
                plain(format!("{}°", significant(l.transmission_worst_deg, 3)))
            }),
            (Right, "ratio", &|(_, l)| plain(significant(l.link_ratio, 3))),
            (Right, "radius", &|(_, l)| plain(radius(l))),
            (Left, "verdict", &|(_, l)| verdict(shortened(&said(l), 22), l.accepted)),
        ],
    );
    grid.render(colour)
}
