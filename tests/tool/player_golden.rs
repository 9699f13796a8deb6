//! What the report's player must agree with: positions, velocities and accelerations of the kernel, and where the
//! points of whole motions are reached. tests/browser/player.test.mjs reads the file.
//!
//! After a change that is meant to change it: `LINKWRIGHT_WRITE_GOLDEN=1 cargo test --test tool golden`.

use crate::common::root;
use crate::random::{TYPES, linkage};
use crate::report::records::{detail, k18, rocking, shapes};
use linkwright::internals::mechanism::four_bar::motion::{CrankMotion, Motion};
use linkwright::internals::mechanism::{
    AssemblyMode, Complex, CrankLinkage, FourBar, InvertedSliderCrank, SliderCrank, Status, xy,
};
use linkwright::internals::numbers::arithmetic::streams::{Stream, stream, uniform};
use linkwright::internals::record::Record;
use linkwright::internals::report::html::report_html;
use serde_json::{Value, json};

/// The crank's motion in the file.
const INPUT: CrankMotion = CrankMotion { speed_rad_s: 1.7, acceleration_rad_s2: -0.6 };
/// Nearer to a toggle rounding alone may make more than the test's tolerance.
const CLEAR_SINE: f64 = 0.05;

fn pair(z: Complex) -> Value {
    json!(xy(z))
}

/// A linkage at a crank angle, as far as the kernel has an answer.
fn position(linkage: &FourBar, angle: f64, t1: AssemblyMode) -> Option<Value> {
    let mut row = json!({ "linkage": linkage, "angle": angle, "t1": i64::from(t1) });
    match linkage.motion_with(angle, t1, INPUT) {
        Motion::Definite(motion) if motion.posture.sine.abs() > CLEAR_SINE => {
            let joints = motion.posture.joints;
            row["C"] = pair(joints.crank_pin);
            row["D"] = pair(joints.follower_pin);
            row["P"] = pair(joints.coupler_point);
            row["mu"] = json!(linkage.with_assembly(t1).transmission_angle(angle)?);
            row["vP"] = pair(motion.coupler_point.velocity);
            row["aP"] = pair(motion.coupler_point.acceleration);
            row["omega3"] = json!(motion.coupler.speed_rad_s);
            row["omega4"] = json!(motion.follower.speed_rad_s);
            Some(row)
        }
        // Open by more than rounding.
        Motion::Open => {
            let d = linkage.diagonal(angle);
            let (b, c) = (linkage.coupler(), linkage.follower());
            let clear = 1e-6 * (b + c);
            (d > b + c + clear || d < (b - c).abs() - clear).then_some(row)
        }
        _ => None,
    }
}

/// Draws a linkage with a slider.
fn slider(draws: &mut Stream, inverted: bool) -> CrankLinkage {
    let mut number = |low: f64, high: f64| uniform(draws, low, high);
    let pivot = Complex::new(number(-2.0, 2.0), number(-2.0, 2.0));
    let other = pivot + Complex::new(number(-3.0, 3.0), number(-3.0, 3.0));
    let offset = Complex::new(number(-3.0, 3.0), number(-3.0, 3.0));
    let (a, b, h) = (number(0.3, 2.0), number(1.0, 4.0), number(-1.0, 1.0));
    let (angle, t1) = (number(-3.0, 3.0), AssemblyMode::of(number(-1.0, 1.0)));
    if inverted {
        let made = InvertedSliderCrank::from_parts([pivot, other], a, h, offset, t1);
        CrankLinkage::InvertedSliderCrank(made.expect("a linkage"))
    } else {
        let made = SliderCrank::from_parts(pivot, [a, b], (other, angle), offset, t1);
        CrankLinkage::SliderCrank(made.expect("a linkage"))
    }
}

/// A linkage with a slider at a crank angle, as far as the kernel has an answer.
fn slider_position(linkage: &CrankLinkage, angle: f64) -> Option<Value> {
    let mechanism = linkage.mechanism();
    let moved = mechanism.motion_at(angle, INPUT);
    let mut row = json!({ "linkage": linkage, "angle": angle, "t1": i64::from(linkage.assembly()) });
    let last = mechanism.traced();
    match moved.pose.status {
        Status::Ok if moved.pose.transmission?.sin() > CLEAR_SINE => {
            for (name, joint) in [("C", last - 2), ("D", last - 1), ("P", last)] {
                row[name] = pair(moved.pose.joints[joint]?);
            }
            row["mu"] = json!(moved.pose.transmission?);
            row["vP"] = pair(moved.velocities[last]?);
            row["aP"] = pair(moved.accelerations[last]?);
            row["omega3"] = json!(moved.coupler?.speed_rad_s);
            Some(row)
        }
        Status::Open => Some(row),
        _ => None,
    }
}

fn motions(record: &Record) -> Vec<Value> {
    let page = report_html(record, 0);
    let data =
        page.split("id=\"data\">").nth(1).and_then(|rest| rest.split("</script>").next()).expect("data");
    let data: Value = serde_json::from_str(data).expect("JSON");
    let of = |(i, candidate): (usize, &linkwright::internals::record::Candidate)| {
        let reached: Vec<Value> = candidate
            .crank_deg
            .iter()
            .zip(&candidate.t1_at)
            .map(|(angle, t1)| {
                candidate.linkage.four_bar().expect("a four-bar").position_with(angle.to_radians(), *t1)
            })
            .map(|position| pair(position.joints().expect("closed").coupler_point))
            .collect();
        let key = format!("c{}", i + 1);
        let all = data["mechanisms"].as_array().expect("a list");
        let mechanism = all.iter().find(|m| m["key"] == key.as_str()).expect("it is there");
        json!({ "target": data["target"], "mechanism": mechanism, "reached": reached })
    };
    record.candidates.iter().take(2).enumerate().map(of).collect()
}

fn golden() -> Value {
    let mut positions = Vec::new();
    let mut draws = stream(7, 0);
    for i in 0..40 {
        let linkage = linkage(&mut draws, TYPES[i % TYPES.len()]);
        for j in 0..4 {
            let angle = 0.37 + 1.61 * j as f64 + 0.11 * i as f64;
            let t1 = if (i + j).is_multiple_of(2) { AssemblyMode::Plus } else { AssemblyMode::Minus };
            positions.extend(position(&linkage, angle, t1));
        }
    }
    let mut sliders = Vec::new();
    for i in 0..40 {
        let linkage = slider(&mut draws, i % 2 == 1);
        sliders.extend((0..3).filter_map(|j| slider_position(&linkage, 0.4 + 2.1 * f64::from(j))));
    }
    let mut one_branch = rocking();
    one_branch.candidates[0].crank_deg.truncate(2);
    one_branch.candidates[0].t1_at = one_branch.candidates[0].t1_at[..2].to_vec().into();
    one_branch.problem.resolved.task.points.truncate(2);
    let records = [k18(), rocking(), one_branch, shapes(), detail()];
    json!({
        "omega": INPUT.speed_rad_s,
        "alpha": INPUT.acceleration_rad_s2,
        "positions": positions,
        "sliders": sliders,
        "motions": records.iter().flat_map(motions).collect::<Vec<_>>(),
    })
}

/// Whether two values agree, numbers to 1e-13 of themselves or of one: another machine's sine may differ in the last bit.
fn agree(x: &Value, y: &Value) -> bool {
    match (x, y) {
        (Value::Number(x), Value::Number(y)) => {
            let (x, y) = (x.as_f64().unwrap_or(f64::NAN), y.as_f64().unwrap_or(f64::NAN));
            (x - y).abs() <= 1e-13 * x.abs().max(1.0)
        }
        (Value::Array(x), Value::Array(y)) => x.len() == y.len() && x.iter().zip(y).all(|(x, y)| agree(x, y)),
        (Value::Object(x), Value::Object(y)) => {
            x.len() == y.len() && x.iter().all(|(key, x)| y.get(key).is_some_and(|y| agree(x, y)))
        }
        _ => x == y,
    }
}

#[test]
fn the_golden_file_of_the_player_is_what_the_kernel_says() {
    let place = root().join("tests/browser/golden.json");
    let found = golden();
    if std::env::var_os("LINKWRIGHT_WRITE_GOLDEN").is_some() {
        let row = |value: &Value| format!("    {value}");
        let list = |key: &str| {
            let rows: Vec<String> = found[key].as_array().expect("a list").iter().map(row).collect();
            format!("  \"{key}\": [\n{}\n  ]", rows.join(",\n"))
        };
        let text = format!(
            "{{\n  \"omega\": {},\n  \"alpha\": {},\n{},\n{},\n{}\n}}\n",
            found["omega"],
            found["alpha"],
            list("positions"),
            list("sliders"),
            list("motions")
        );
        std::fs::write(&place, text).expect("it can be written");
    }
    let recorded: Value =
        serde_json::from_slice(&std::fs::read(&place).expect("the file is there")).expect("JSON");
    let open =
        found["positions"].as_array().expect("a list").iter().filter(|row| row.get("P").is_none()).count();
    assert!(open > 5 && found["positions"].as_array().expect("a list").len() > 100, "{open}");
    assert!(agree(&recorded, &found), "the golden file is out of date: see the head of this file");
}
