//! The circle-point and centre-point curves of a motion of four poses: where the pins of the body and the fixed pivots can go.

use super::bodies::{Posed, length};
use super::canvas::{
    Anchor, Canvas, ROUND_CORNERS, ROUND_ENDS, Spot, Vec2, View, font, outline, palette, stroke,
};
use super::parts::letter;
use super::scene::Bounds;
use super::sheet::{FULL, HEAD, INSET, Sheet, page};
use super::words::problem_name;
use crate::mechanism::{Complex, CrankLinkage, Pose};
use crate::record::{Candidate, Record};
use crate::synthesis::pose_curves::{PAIRED_ON_A_PAGE, PosePlace, pose_curves};
use crate::task::Problem;

/// The classes of the marks: the least transmission angle in degrees, the colour, and the words of the legend.
const CLASSES: [(f64, &str, &str); 3] = [
    (40.0, palette::FOLLOWER, "40° and more"),
    (20.0, palette::COUPLER, "20° to 40°"),
    (0.0, palette::TARGET, "less than 20°"),
];
/// The extent of the drawing around poses and joints, in diagonals of their box: the curves run to infinity.
const AROUND: f64 = 0.6;
const LEGEND_LINE: f64 = 20.0;
const WIDTH: f64 = 4.0;
/// The dashes of the circle-point curve, and of its marks.
const DASHES: &str = r#" stroke-dasharray="7 4""#;

/// Returns the curves of the problem of a record with the joints of its first candidate; `None` of other problems, and where more
/// than a curve of dyads meets the poses.
pub fn pose_curves_svg(record: &Record) -> Option<String> {
    let problem = Problem::new(record.problem.resolved.clone()).ok()?;
    let curves = pose_curves(&problem, PAIRED_ON_A_PAGE)?;
    let angles = &problem.task().body()?.angles;
    let given = problem.task().points().iter().zip(angles);
    let poses: Vec<Pose> = given.filter_map(|(at, angle)| Some(Pose::new(*at, (*angle)?))).collect();
    let first = poses.first()?;
    let joints = record.candidates.first().and_then(joints_at_the_first_pose);
    let held = poses.iter().map(|pose| pose.position).chain(joints.into_iter().flatten());
    let bounds = Bounds::of(held).padded(AROUND);

    let (mut sheet, view) = Sheet::fitted("Where pins and pivots can go", &bounds, FULL);
    let height = sheet.bottom - HEAD;
    sheet.body.raw(&format!(
        r#"<clipPath id="pose-curves"><rect x="0" y="{HEAD}" width="{FULL}" height="{height:.2}"/></clipPath>"#
    ));
    sheet.body.raw(r##"<g clip-path="url(#pose-curves)">"##);
    draw_curve(&mut sheet.body, &view, &curves, "", |place| place.pivot);
    draw_curve(&mut sheet.body, &view, &curves, DASHES, |place| first.at(place.pin));
    sheet.body.raw("</g>");
    let spots: Vec<Spot> = poses.iter().map(|pose| view.spot(pose.position)).collect();
    let long = length(&spots);
    for (pose, at) in poses.iter().zip(&spots) {
        Posed { at: *at, angle: pose.direction.arg() }.outlined(&mut sheet.body, long, palette::INK, 1.0);
    }
    if let Some([a, c, d, b]) = joints.map(|joints| joints.map(|joint| view.spot(joint))) {
        sheet.body.path(&[a, c, d, b], false, &(outline(palette::BAR_EDGE, 1.6) + ROUND_CORNERS));
        for (name, at) in [("A", a), ("C", c), ("D", d), ("B", b)] {
            sheet.body.circle(at, 4.0, &super::canvas::filled(palette::PAPER, palette::BAR_EDGE, 1.6));
            letter(&mut sheet.body, name, at, Vec2::new(0.7, -0.7));
        }
    }
    sheet.scale_bar(&view, record.problem.unit, 0.6 * FULL);

    let mut y = sheet.bottom + 18.0;
    let lines = [
        ("", palette::MUTED, 1.4, "centre points: the fixed pivots that a body can have"),
        (
            DASHES,
            palette::MUTED,
            1.4,
            "circle points: the pins of the body that go with them, with the body in its first pose",
        ),
    ];
    for (dashes, colour, width, words) in lines {
        legend(&mut sheet.body, y, &(stroke(colour, width) + dashes), words);
        y += LEGEND_LINE;
    }
    for (_, colour, words) in CLASSES {
        let words = format!(
            "a linkage without defects has its pin here, with a worst transmission angle of {words} between the poses"
        );
        legend(&mut sheet.body, y, &stroke(colour, WIDTH), &words);
        y += LEGEND_LINE;
    }
    sheet.note =
        "Burmester curves of four poses; any two of the dyads are a four-bar that meets the poses exactly"
            .into();
    sheet.bottom = y;
    Some(page(&problem_name(record), "four poses", &[], vec![sheet]))
}

/// Returns A, C, D and B where the body of a four-bar is at the first pose.
fn joints_at_the_first_pose(candidate: &Candidate) -> Option<[Complex; 4]> {
    let CrankLinkage::FourBar(linkage) = &candidate.linkage else { return None };
    let (angle, assembly) = (candidate.crank_deg.first()?.to_radians(), *candidate.t1_at.first()?);
    let joints = candidate.linkage.joints_with(angle, assembly)?.joints;
    Some([linkage.crank_pivot(), joints.crank_pin, joints.follower_pin, linkage.follower_pivot()])
}

/// Draws a curve faintly, and the stretches with a linkage in the colours of their classes.
fn draw_curve(
    canvas: &mut Canvas,
    view: &View,
    curves: &[Vec<PosePlace>],
    dashes: &str,
    at: impl Fn(&PosePlace) -> Complex,
) {
    for stretch in curves {
        let spots: Vec<Spot> = stretch.iter().map(|place| view.spot(at(place))).collect();
        canvas.path(&spots, false, &(outline(palette::MUTED, 1.4) + ROUND_CORNERS + dashes));
        let class = |place: &PosePlace| {
            place.transmission_deg.and_then(|deg| CLASSES.iter().position(|(least, ..)| deg >= *least))
        };
        let classes: Vec<Option<usize>> = stretch.iter().map(class).collect();
        let mut from = 0;
        for run in classes.chunk_by(|one, other| one == other) {
            let to = from + run.len();
            if let Some(class) = run[0] {
                // Up to the next place, so that neighbouring stretches meet.
                let spots = &spots[from..(to + 1).min(spots.len())];
                let mark = outline(CLASSES[class].1, WIDTH) + ROUND_CORNERS + dashes;
                canvas.path(spots, false, &(mark + r#" stroke-opacity="0.8""#));
            }
            from = to;
        }
    }
}

fn legend(canvas: &mut Canvas, y: f64, line: &str, words: &str) {
    canvas.line(
        Spot::new(INSET + 4.0, y - 4.0),
        Spot::new(INSET + 26.0, y - 4.0),
        &(line.to_owned() + ROUND_ENDS),
    );
    canvas.text(Spot::new(INSET + 38.0, y), Anchor::Start, &font(12.5, palette::INK), words);
}
