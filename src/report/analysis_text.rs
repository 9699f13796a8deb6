//! An analysis as text: the mobility in words, and the tables of positions, motion and methods.

use super::grid::{Align, Colour, Grid, Ink};
use super::text::{capitalised, clean, significant, wrapped};
use crate::mechanism::Unit;
use crate::mechanism::analysis::{Analysis, Configuration, MobilityRecord, Row, Status};
use crate::mechanism::four_bar::transmission::ForceTransmission;
use crate::mechanism::{FourBar, LinkageType};

/// The width of the page, in columns.
const COLUMNS: usize = 100;
/// The number of significant digits of lengths and rates.
const DIGITS: usize = 7;

/// Returns the linkage and its mobility in words.
pub fn analysis_head(analysis: &Analysis, colour: Colour) -> String {
    let mut out = format!("{}\n", colour.paint(Ink::Strong, &clean(&analysis.name)));
    if let Some(first) = analysis.configurations.first() {
        out.push_str(&linkage_line(&first.linkage, analysis.unit));
        out.push_str(&mobility_words(&analysis.mobility, analysis.unit));
    }
    out
}

/// Returns the whole output of `analyze`.
pub fn analysis_table(analysis: &Analysis, colour: Colour) -> String {
    let mut out = analysis_head(analysis, colour);
    for configuration in &analysis.configurations {
        let natural = configuration.linkage.natural_coordinates();
        let signs = format!(
            "\n  t1 = {:+}, t2 = {:+} ({}, P {} of C-D)\n",
            natural.assembly.sign(),
            natural.side.sign(),
            match natural.assembly.sign() > 0.0 {
                true => "D left of C-B",
                false => "D right of C-B",
            },
            if natural.side.sign() > 0.0 { "left" } else { "right" },
        );
        out.push_str(&colour.paint(Ink::Strong, &signs));
        out.push_str(&positions(configuration, colour));
        if analysis.omega2_rad_s != 0.0 || analysis.alpha2_rad_s2 != 0.0 {
            out.push('\n');
            out.push_str(&velocities(configuration, colour));
            out.push('\n');
            out.push_str(&accelerations(configuration, colour));
        }
        out.push_str(&methods(configuration, colour));
        out.push_str(&conditions(configuration));
    }
    let unit = analysis.unit.map_or("the file's unit".to_owned(), |u| u.label().to_owned());
    out.push_str(&wrapped(
        "\n  ",
        "  ",
        &format!(
            "Crank speed {} rad/s, acceleration {} rad/s2. Angles in degrees from the x axis, \
             counter-clockwise; lengths in {unit}. status: ok; singular: a toggle, velocities are not decided by \
             the crank; open: the loop does not close; undetermined: C lies on B.",
            significant(analysis.omega2_rad_s, DIGITS),
            significant(analysis.alpha2_rad_s2, DIGITS),
        ),
        COLUMNS,
    ));
    out
}

fn linkage_line(linkage: &FourBar, unit: Option<Unit>) -> String {
    let n = linkage.natural_coordinates();
    let s = |x: f64| significant(x, 6);
    let unit = unit.map_or(String::new(), |u| format!(" {}", u.label()));
    wrapped(
        "  ",
        "  ",
        &format!(
            "A ({}, {}), B ({}, {}), ground {}, a {}, b {}, c {}, d {}, e {}{unit}",
            s(n.crank_pivot[0]),
            s(n.crank_pivot[1]),
            s(n.follower_pivot[0]),
            s(n.follower_pivot[1]),
            s(linkage.ground()),
            s(n.crank),
            s(n.coupler),
            s(n.follower),
            s(n.crank_side),
            s(n.follower_side)
        ),
        COLUMNS,
    )
}

/// Returns the mobility of a linkage in words: type, margin, input range, toggles, circuits and branches, transmission,
/// warnings.
pub fn mobility_words(mobility: &MobilityRecord, unit: Option<Unit>) -> String {
    let Some(kind) = mobility.linkage_type else {
        return wrapped(
            "  ",
            "  ",
            "These links cannot be joined: the longest is longer than the other three together.",
            COLUMNS,
        );
    };
    let unit = unit.map_or(String::new(), |u| format!(" {}", u.label()));
    let of_type = match kind {
        LinkageType::CrankRocker => "the crank turns fully, the follower rocks",
        LinkageType::RockerCrank => "the driven link rocks, the follower turns fully",
        LinkageType::DoubleCrank => "crank and follower both turn fully",
        LinkageType::DoubleRocker => "crank and follower rock, the coupler turns fully",
        LinkageType::TripleRocker => "no link turns fully",
        LinkageType::ChangePoint => "it can lie flat, and there the next position is not decided",
    };
    let mut words = format!(
        "{}: {of_type} (Grashof margin p + q - s - l = {}{unit}).",
        capitalised(kind.name()),
        significant(mobility.grashof_margin, 5)
    );
    let degrees = |x: f64| format!("{}°", significant(x, 6));
    if mobility.input_turns_fully {
        words.push_str(" The crank reaches every angle.");
    } else if !mobility.input_arcs_deg.is_empty() {
        let arcs: Vec<String> = mobility
            .input_arcs_deg
            .iter()
            .map(|[from, to]| format!("{} to {}", degrees(*from), degrees(*to)))
            .collect();
        let ends: Vec<String> = mobility.toggles_deg.iter().map(|t| degrees(*t)).collect();
        words.push_str(&format!(
            " The crank reaches {}; toggles, with coupler and follower in line, at {}.",
            arcs.join(" or "),
            ends.join(", ")
        ));
    }
    let plural = |n: u8, one: &str, several: &str| format!("{n} {}", if n == 1 { one } else { several });
    words.push_str(&format!(
        " {}, {} in each.",
        plural(mobility.circuits, "circuit", "circuits"),
        plural(mobility.branches_per_circuit, "branch", "branches")
    ));
    if let (Some([least, greatest]), Some(worst)) =
        (mobility.transmission_deg, mobility.worst_transmission_deg)
    {
        words.push_str(&format!(
            " Transmission angle {} to {}, at its worst {} from a toggle.",
            degrees(least),
            degrees(greatest),
            degrees(worst)
        ));
        let force = ForceTransmission::of(worst);
        if force < ForceTransmission::Fair {
            if mobility.input_turns_fully {
                words.push_str(&format!(" Watch for: {}.", force.words()));
            } else {
                words.push_str(
                    " Watch for: at a toggle the crank can no longer push the follower; stop short of it or drive \
                     the follower.",
                );
            }
        }
    }
    if let Some(ratio) = mobility.link_ratio {
        words.push_str(&format!(" Longest over shortest link: {}.", significant(ratio, 4)));
    } else {
        words.push_str(" The two fixed pivots coincide.");
    }
    wrapped("  ", "  ", &words, COLUMNS)
}

fn plain(text: String) -> (String, Ink) {
    (text, Ink::Plain)
}

/// Returns a number shown beside others of the given size; a number that is only rounding in comparison is shown as 0.
fn number(value: Option<f64>, size: f64) -> (String, Ink) {
    let shown = |v: f64| if v.abs() <= ROUNDING * size { 0.0 } else { v };
    plain(value.map_or_else(|| "-".to_owned(), |v| significant(shown(v), DIGITS)))
}

/// The fraction of its neighbours below which a number is rounding: the table shows 0, CSV and JSON all digits.
const ROUNDING: f64 = 1e-14;

fn status(row: &Row) -> (String, Ink) {
    let ink = if row.status == Status::Ok { Ink::Faint } else { Ink::Bad };
    (row.status.word().to_owned(), ink)
}

fn positions(configuration: &Configuration, colour: Colour) -> String {
    use Align::{Left, Right};
    let mut grid = Grid::new(&[
        ("crank", Right),
        ("theta3", Right),
        ("theta4", Right),
        ("mu", Right),
        ("Cx", Right),
        ("Cy", Right),
        ("Dx", Right),
        ("Dy", Right),
        ("Px", Right),
        ("Py", Right),
        ("status", Left),
    ]);
    for row in &configuration.rows {
        let p = row.pose;
        let size = p.map_or(0.0, |p| {
            [p.crank_pin, p.follower_pin, p.coupler_point]
                .iter()
                .flatten()
                .fold(0.0, |m: f64, x| m.max(x.abs()))
        });
        let at = |f: fn(&crate::mechanism::analysis::Pose) -> f64| number(p.as_ref().map(f), size);
        let angle = |f: fn(&crate::mechanism::analysis::Pose) -> f64| {
            plain(p.as_ref().map_or_else(|| "-".to_owned(), |p| significant(f(p), 6)))
        };
        grid.row(vec![
            plain(significant(row.crank_deg, 6)),
            angle(|p| p.coupler_deg),
            angle(|p| p.follower_deg),
            angle(|p| p.transmission_deg),
            at(|p| p.crank_pin[0]),
            at(|p| p.crank_pin[1]),
            at(|p| p.follower_pin[0]),
            at(|p| p.follower_pin[1]),
            at(|p| p.coupler_point[0]),
            at(|p| p.coupler_point[1]),
            status(row),
        ]);
    }
    grid.render(colour)
}

type Of = fn(&crate::mechanism::analysis::Rates) -> f64;

fn rates(configuration: &Configuration, colour: Colour, columns: [(&'static str, Of); 8]) -> String {
    let mut heads = vec![("crank", Align::Right)];
    heads.extend(columns.iter().map(|(head, _)| (*head, Align::Right)));
    let mut grid = Grid::new(&heads);
    for row in &configuration.rows {
        let mut cells = vec![plain(significant(row.crank_deg, 6))];
        // The first two columns belong to the links, the others to the points.
        let size = |these: &[(&'static str, Of)]| {
            let sizes = these.iter().filter_map(|(_, of)| row.rates.as_ref().map(|r| of(r).abs()));
            sizes.fold(0.0, f64::max)
        };
        let (links, points) = columns.split_at(2);
        for group in [links, points] {
            let size = size(group);
            cells.extend(group.iter().map(|(_, of)| number(row.rates.as_ref().map(of), size)));
        }
        grid.row(cells);
    }
    grid.render(colour)
}

fn velocities(configuration: &Configuration, colour: Colour) -> String {
    let columns: [(&str, Of); 8] = [
        ("omega3", |r| r.omega3_rad_s),
        ("omega4", |r| r.omega4_rad_s),
        ("vCx", |r| r.vC[0]),
        ("vCy", |r| r.vC[1]),
        ("vDx", |r| r.vD[0]),
        ("vDy", |r| r.vD[1]),
        ("vPx", |r| r.vP[0]),
        ("vPy", |r| r.vP[1]),
    ];
    rates(configuration, colour, columns)
}

fn accelerations(configuration: &Configuration, colour: Colour) -> String {
    let columns: [(&str, Of); 8] = [
        ("alpha3", |r| r.alpha3_rad_s2),
        ("alpha4", |r| r.alpha4_rad_s2),
        ("aCx", |r| r.aC[0]),
        ("aCy", |r| r.aC[1]),
        ("aDx", |r| r.aD[0]),
        ("aDy", |r| r.aD[1]),
        ("aPx", |r| r.aP[0]),
        ("aPy", |r| r.aP[1]),
    ];
    rates(configuration, colour, columns)
}

fn methods(configuration: &Configuration, colour: Colour) -> String {
    use Align::{Left, Right};
    if configuration.rows.iter().all(|row| row.methods.is_empty()) {
        return String::new();
    }
    let mut grid = Grid::new(&[
        ("crank", Right),
        ("method", Left),
        ("t1", Right),
        ("theta3", Right),
        ("theta4", Right),
        ("Px", Right),
        ("Py", Right),
        ("off", Right),
        ("rounds", Right),
        ("status", Left),
    ]);
    for row in &configuration.rows {
        for m in &row.methods {
            let ink = if m.status == "ok" { Ink::Faint } else { Ink::Bad };
            grid.row(vec![
                plain(significant(row.crank_deg, 6)),
                plain(m.method.name().to_owned()),
                plain(m.t1.map_or("-".to_owned(), |t| format!("{:+}", t.sign()))),
                number(m.coupler_deg, 0.0),
                number(m.follower_deg, 0.0),
                number(m.coupler_point.map(|p| p[0]), 0.0),
                number(m.coupler_point.map(|p| p[1]), 0.0),
                plain(m.from_natural.map_or("-".to_owned(), |d| format!("{d:.1e}"))),
                plain(m.iterations.map_or(String::new(), |n| n.to_string())),
                (m.status.to_owned(), ink),
            ]);
        }
    }
    format!(
        "\n  Other methods; off: distance of their P from that of the natural coordinates\n{}",
        grid.render(colour)
    )
}

/// Returns Romero's condition (20) beside a sufficient condition: at the rows without a position, otherwise at the row
/// at which it is nearest to failing.
fn conditions(configuration: &Configuration) -> String {
    let rows = || configuration.rows.iter().filter_map(|row| Some((row, row.assembly?)));
    let line = |(row, condition): (&Row, crate::mechanism::analysis::ConditionRecord)| {
        let ratio = condition.ratio.map_or("undefined".to_owned(), |r| significant(r, 5));
        let word = |holds| if holds { "holds" } else { "fails" };
        format!(
            "at {}°: condition (20), (b^2 + d^2)/(l1^2 + l2^2) = {ratio} >= 1, {}; b^2 >= l1^2 and d^2 >= l2^2: {}",
            significant(row.crank_deg, 6),
            word(condition.necessary),
            word(condition.sufficient)
        )
    };
    let open: Vec<String> = rows().filter(|(row, _)| row.pose.is_none()).take(6).map(line).collect();
    let shown = if open.is_empty() {
        let least = rows().min_by(|x, y| {
            let ratio = |c: &crate::mechanism::analysis::ConditionRecord| c.ratio.unwrap_or(f64::INFINITY);
            ratio(&x.1).total_cmp(&ratio(&y.1))
        });
        least.map(line).into_iter().collect()
    } else {
        open
    };
    if shown.is_empty() {
        return String::new();
    }
    let text = format!("Assembly (Romero's condition is necessary, not sufficient): {}.", shown.join("; "));
    wrapped("\n  ", "  ", &text, COLUMNS)
}
