//! Functions by linkages with a slider: tables of places and of angles are found again, records verify, and a stroke with its time
//! ratio is met by the slider-crank that transmits best.

use crate::common::parse;
use crate::motion::solved;
use linkwright::internals::judge::practicality::sensitivity::{At, Crank, output_sensitivity};
use linkwright::internals::judge::verify::verify;
use linkwright::internals::mechanism::{
    AssemblyMode, Complex, CrankLinkage, InvertedSliderCrank, LinkageKind, SliderCrank,
};
use linkwright::internals::numbers::arithmetic::streams::{Stream, stream, uniform};
use linkwright::internals::record::Candidate;
use linkwright::internals::report::grid::Colour;
use linkwright::internals::report::html::report_html;
use linkwright::internals::report::table::candidates_table;
use linkwright::internals::task::Output;
use std::f64::consts::PI;

/// Draws a linkage of a kind whose crank turns fully with a transmission angle of 5 degrees at least.
fn drawn(kind: LinkageKind, draws: &mut Stream) -> CrankLinkage {
    loop {
        let pivot = Complex::new(uniform(draws, -2.0, 2.0), uniform(draws, -2.0, 2.0));
        let turn = Complex::from_polar(1.0, uniform(draws, -PI, PI));
        let (crank, offset) = (uniform(draws, 0.3, 2.0), uniform(draws, -1.5, 1.5));
        let point = Complex::new(0.0, 0.0);
        let linkage = match kind {
            LinkageKind::SliderCrank => {
                let line = (pivot + Complex::i() * turn * offset, turn.arg());
                let lengths = [crank, uniform(draws, 1.0, 5.0)];
                SliderCrank::from_parts(pivot, lengths, line, point, AssemblyMode::Plus)
                    .map(CrankLinkage::SliderCrank)
            }
            _ => {
                let pivots = [pivot, pivot + turn * uniform(draws, 0.3, 5.0)];
                InvertedSliderCrank::from_parts(pivots, crank, offset, point, AssemblyMode::Plus)
                    .map(CrankLinkage::InvertedSliderCrank)
            }
        };
        let Ok(linkage) = linkage else { continue };
        let worst = linkage.transmission_over_cycle().map_or(0.0, |over| over.worst().to_degrees());
        if linkage.mobility().input_turns_fully() && worst > 5.0 && linkage.link_ratio() < 10.0 {
            return linkage;
        }
    }
}

/// The problem of a table of outputs of a linkage, which count from the first one.
fn problem(linkage: &CrankLinkage, key: &str, angles: &[f64], more: &str) -> String {
    let output = |angle: &f64| {
        let at = linkage.joints_with(*angle, linkage.assembly()).expect("it closes");
        match key {
            "output" => linkage.slider_place(&at).expect("a slider"),
            _ => linkage.output_angle(&at).expect("an output link").to_degrees(),
        }
    };
    let outputs: Vec<f64> = angles.iter().map(output).collect();
    let outputs: Vec<f64> = outputs.iter().map(|output| output - outputs[0]).collect();
    let inputs: Vec<f64> = angles.iter().map(|angle| (angle - angles[0]).to_degrees()).collect();
    format!(
        "format = 1\n[task.function]\ninput_deg = {inputs:?}\n{key} = {outputs:?}\n[design]\nmechanism = \"{}\"\n\
         [solve]\ncandidates = 1\nadvice = false\n{more}",
        linkage.kind()
    )
}

/// Recomputes the outputs of a candidate from its own numbers and compares them with those of the problem.
fn assert_generates(candidate: &Candidate, pairs: &[[f64; 2]], is_place: bool) {
    let sign = candidate.sense.expect("a sense").signs()[0];
    for (([_, wanted], deg), t1) in pairs.iter().zip(&candidate.crank_deg).zip(&candidate.t1_at) {
        let at = candidate.linkage.joints_with(deg.to_radians(), *t1).expect("it closes");
        let error = if is_place {
            let place = candidate.linkage.slider_place(&at).expect("a slider");
            sign * place - candidate.output_offset.expect("an offset") - wanted
        } else {
            let from = candidate.output_offset_deg.expect("an offset")
                + candidate.linkage.ground_angle().to_degrees();
            let turned = candidate.linkage.output_angle(&at).expect("an output link").to_degrees();
            (turned - from - sign * wanted + 180.0).rem_euclid(360.0) - 180.0
        };
        assert!(error.abs() < 1e-7, "{error} at {wanted}");
    }
}

#[test]
fn tables_of_places_and_angles_are_found_again() {
    let classes = [
        (LinkageKind::SliderCrank, "output"),
        (LinkageKind::InvertedSliderCrank, "output"),
        (LinkageKind::InvertedSliderCrank, "output_deg"),
    ];
    for (kind, key) in classes {
        for case in 0..12 {
            let draws = &mut stream(21, case);
            let linkage = drawn(kind, draws);
            let (from, span) = (uniform(draws, -PI, PI), uniform(draws, 0.5 * PI, 1.6 * PI));
            let angles: Vec<f64> = (0..12).map(|j| from + span * f64::from(j) / 11.0).collect();
            let text = problem(&linkage, key, &angles, "");
            let record = solved(parse(&text).spec);
            let best = &record.candidates[0];
            assert!(
                best.accepted && best.error.rms_over_size < 1e-9,
                "{kind} {key} {case}: {}",
                best.error.rms
            );
            assert_eq!((best.linkage.kind(), best.output_offset.is_some()), (kind, key == "output"));
            assert_generates(best, &record.problem.resolved.task.pairs(), key == "output");
            assert_eq!(verify(&record).expect("a record"), []);
        }
    }
}

#[test]
fn offsets_from_the_ground_are_kept() {
    let line = (Complex::new(0.0, 0.4), 0.0);
    let zero = Complex::new(0.0, 0.0);
    let made = SliderCrank::from_parts(zero, [1.0, 3.0], line, zero, AssemblyMode::Plus).expect("a linkage");
    let linkage = CrankLinkage::SliderCrank(made);
    let pairs: Vec<(f64, f64)> = (0..9)
        .map(|j| {
            let deg = 25.0 * f64::from(j);
            let at = linkage.joints_with(deg.to_radians(), AssemblyMode::Plus).expect("it closes");
            (deg, linkage.slider_place(&at).expect("a slider"))
        })
        .collect();
    let (inputs, outputs): (Vec<f64>, Vec<f64>) = pairs.into_iter().unzip();
    let text = format!(
        "format = 1\n[task.function]\ninput_deg = {inputs:?}\noutput = {outputs:?}\ninput_offset = \"ground\"\n\
         output_offset = \"ground\"\ntolerance = 0.001\n[solve]\ncandidates = 1\n"
    );
    let record = solved(parse(&text).spec);
    let best = &record.candidates[0];
    assert!(best.accepted && best.error.max < 1e-9, "{:?}", best.error);
    assert_eq!((best.input_offset_deg, best.output_offset), (Some(0.0), Some(0.0)));
    assert!((best.linkage.crank() - 1.0).abs() < 1e-8, "{}", best.linkage);
    assert!(best.requirements.iter().any(|row| row.name == "tolerance" && row.met));
}

/// The linkage with one of its dimensions changed: Ax, Ay, Bx, By, a, b, the block's offset, or an end of the rail moved across it.
fn changed(linkage: &CrankLinkage, name: &str, by: f64, rail: [f64; 2]) -> CrankLinkage {
    let shift = match name {
        "Ax" | "Bx" => Complex::new(by, 0.0),
        "Ay" | "By" => Complex::new(0.0, by),
        _ => Complex::new(0.0, 0.0),
    };
    let (a, b) =
        if name.starts_with('A') { (shift, Complex::new(0.0, 0.0)) } else { (Complex::new(0.0, 0.0), shift) };
    let crank = linkage.crank() + if name == "a" { by } else { 0.0 };
    let (pivot, offset, t1) = (linkage.crank_pivot() + a, linkage.coupler_offset(), linkage.assembly());
    match linkage {
        CrankLinkage::SliderCrank(l) => {
            let (s, q) = (l.line_direction(), l.line_point());
            let ends = [("rail_from", rail[0]), ("rail_to", rail[1])]
                .map(|(end, place)| q + s * place + Complex::i() * s * if name == end { by } else { 0.0 });
            let turned = (ends[1] - ends[0]).arg();
            let coupler = l.coupler() + if name == "b" { by } else { 0.0 };
            let made = SliderCrank::from_parts(pivot, [crank, coupler], (ends[0], turned), offset, t1);
            CrankLinkage::SliderCrank(made.expect("a linkage"))
        }
        CrankLinkage::InvertedSliderCrank(l) => {
            let h = l.offset() + if name == "offset" { by } else { 0.0 };
            let made = InvertedSliderCrank::from_parts([pivot, l.block_pivot() + b], crank, h, offset, t1);
            CrankLinkage::InvertedSliderCrank(made.expect("a linkage"))
        }
        CrankLinkage::FourBar(_) | CrankLinkage::MultiLoop(_) => unreachable!("no four-bar is drawn"),
    }
}

#[test]
fn sensitivities_of_outputs_agree_with_changed_dimensions() {
    let classes = [
        (LinkageKind::SliderCrank, Output::Place),
        (LinkageKind::InvertedSliderCrank, Output::Place),
        (LinkageKind::InvertedSliderCrank, Output::Angle),
    ];
    for (kind, output) in classes {
        for case in 0..8 {
            let draws = &mut stream(33, case);
            let linkage = drawn(kind, draws);
            let angles: Vec<f64> = (0..6).map(|_| uniform(draws, -PI, PI)).collect();
            let at: Vec<At> = angles
                .iter()
                .map(|&crank_angle| At { crank_angle, assembly: linkage.assembly(), is_free: false })
                .collect();
            let measured = |linkage: &CrankLinkage, angle: f64| {
                let at = linkage.joints_with(angle, linkage.assembly()).expect("the crank turns fully");
                match output {
                    Output::Place => linkage.slider_place(&at).expect("a slider"),
                    Output::Angle => (linkage.output_angle(&at).expect("an output link")
                        - linkage.ground_angle())
                    .to_degrees(),
                }
            };
            // The rail's ends as the judge takes them: the least and the greatest place, from Q.
            let from =
                |l: &SliderCrank| ((linkage.crank_pivot() - l.line_point()) * l.line_direction().conj()).re;
            let places: Vec<f64> = angles.iter().map(|angle| measured(&linkage, *angle)).collect();
            let rail = linkage.slider_crank().map_or([0.0; 2], |l| {
                let [low, high] =
                    places.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], place| {
                        [low.min(*place), high.max(*place)]
                    });
                [low + from(l), high + from(l)]
            });
            let felt = output_sensitivity(linkage, output, &at, (Crank::Stays, false)).expect("derivatives");
            for dimension in &felt.dimensions {
                let step = 1e-6;
                let [up, down] = [step, -step].map(|by| changed(&linkage, dimension.name, by, rail));
                let differences = angles.iter().map(|angle| {
                    let apart = measured(&up, *angle) - measured(&down, *angle);
                    let apart = if output == Output::Angle {
                        (apart + 180.0).rem_euclid(360.0) - 180.0
                    } else {
                        apart
                    };
                    (apart / (2.0 * step)).abs()
                });
                let most = differences.fold(0.0, f64::max);
                let near = (dimension.worst - most).abs() < 1e-5 * (1.0 + most);
                assert!(near, "{kind} {output:?} {case} {}: {} {most}", dimension.name, dimension.worst);
            }
        }
    }
}

/// The stroke and the time ratio by 36,000 positions.
fn sampled(linkage: &CrankLinkage) -> [f64; 2] {
    const STEPS: u32 = 36_000;
    let place = |step: u32| {
        let angle = 2.0 * PI * f64::from(step) / f64::from(STEPS);
        let at = linkage.joints_with(angle, linkage.assembly()).expect("the crank turns fully");
        linkage.slider_place(&at).expect("a slider")
    };
    let places: Vec<f64> = (0..STEPS).map(place).collect();
    let least = (0..STEPS as usize).min_by(|i, j| places[*i].total_cmp(&places[*j])).expect("a least");
    let most = (0..STEPS as usize).max_by(|i, j| places[*i].total_cmp(&places[*j])).expect("a greatest");
    let apart = least.abs_diff(most) as f64;
    let slow = apart.max(f64::from(STEPS) - apart);
    [places[most] - places[least], slow / (f64::from(STEPS) - slow)]
}

#[test]
fn a_stroke_with_its_time_ratio_is_met_by_the_slider_crank_that_transmits_best() {
    let text = "format = 1\nunit = \"mm\"\n[task.function]\n[require]\nstroke = 100\ntime_ratio = 1.2\n";
    let record = solved(parse(text).spec);
    let best = &record.candidates[0];
    assert!(best.accepted, "{:?}", best.requirements);
    let [stroke, ratio] = sampled(&best.linkage);
    assert!((stroke - 100.0).abs() < 1e-5 && (ratio - 1.2).abs() < 5e-4, "{stroke} {ratio}");
    // The best of all slider-cranks with that stroke and ratio, by a scan of the angle at the far end.
    let alpha: f64 = PI * 0.2 / 2.2;
    let of = |delta: f64| {
        let [far, near] = [(alpha + delta).sin(), delta.sin()].map(|sin| 100.0 * sin / alpha.sin());
        let (crank, coupler) = (0.5 * (far - near), 0.5 * (far + near));
        let height = far * delta.sin();
        (((crank + height) / coupler).acos().to_degrees(), crank, coupler, height)
    };
    let scanned = (1..200_000)
        .map(|k| of(0.5 * PI * f64::from(k) / 200_000.0))
        .filter(|found| found.0.is_finite())
        .max_by(|one, other| one.0.total_cmp(&other.0))
        .expect("a best one");
    let (worst, crank, coupler, _) = scanned;
    assert!((best.transmission_deg.worst - worst).abs() < 1e-6, "{} {worst}", best.transmission_deg.worst);
    assert!((best.linkage.crank() / crank - 1.0).abs() < 1e-4, "{} {crank}", best.linkage.crank());
    assert!((best.linkage.coupler().expect("a coupler") / coupler - 1.0).abs() < 1e-4);
    assert_eq!(verify(&record).expect("a record"), []);
}

#[test]
fn a_path_may_ask_for_a_stroke_and_any_kind_for_a_full_turn() {
    let text = "format = 1\n[task.path]\npoints = [[0, 0], [2, 1.5], [4, 2], [6, 1.5], [8, 0]]\n[design]\n\
                mechanism = \"slider-crank\"\n[require]\nstroke = [6, 9]\ntime_ratio = [1, 1.3]\n[solve]\nadvice = false\n";
    let best = &solved(parse(text).spec).candidates[0];
    assert!(best.accepted, "{:?}", best.requirements);
    let [stroke, ratio] = sampled(&best.linkage);
    assert!((5.999..9.001).contains(&stroke) && ratio < 1.301, "{stroke} {ratio}");
    for kind in ["four-bar", "inverted-slider-crank"] {
        let text = format!(
            "format = 1\n[task.path]\npoints = [[0, 0], [2, 1.5], [4, 2], [6, 1.5], [8, 0]]\n[design]\nmechanism = \
             \"{kind}\"\n[require]\ninput = \"full-turn\"\n[solve]\nadvice = false\n"
        );
        let best = &solved(parse(&text).spec).candidates[0];
        assert!(best.accepted && best.linkage.mobility().input_turns_fully(), "{kind}");
        assert!(best.requirements.iter().any(|row| row.name == "input" && row.met));
    }
}

#[test]
fn the_table_and_the_page_speak_of_the_slider() {
    let text = "format = 1\nname = \"piston\"\nunit = \"mm\"\n[task.function]\ninput_deg = [0, 40, 80, 120, 160]\n\
                output = [0, 12, 40, 68, 90]\n[solve]\ncandidates = 2\n";
    let record = solved(parse(text).spec);
    let shown = candidates_table(&record, Colour::Never);
    assert!(shown.contains("slider 90,") && shown.contains("errors of the slider's place"), "{shown}");
    assert!(!shown.contains("follower"), "{shown}");
    let page = report_html(&record, 0);
    assert!(page.contains("slider from") && page.contains("output wanted"));
}

#[test]
fn a_csv_of_places_and_a_formula_are_read() {
    let beside = [("table.csv", "input_deg,output,tolerance\n0,0,0.5\n30,8,0.5\n60,27,0.5\n90,50,1\n")];
    let text = "format = 1\n[task.function]\nfile = \"table.csv\"\n";
    let file = linkwright::internals::files::problem_file::parse_beside("p.toml", text, &beside, &[])
        .expect("a problem");
    assert!(file.spec.task.is_of_places());
    assert_eq!(file.spec.task.pairs()[3], [90.0, 50.0]);
    let of = "format = 1\n[task.function]\nof = \"x^2\"\nover = [0, 1]\ninput_range_deg = 90\noutput_range = 80\nsamples = 5\n";
    let task = parse(of).spec.task;
    assert!(task.is_of_places());
    assert_eq!(task.pairs()[4], [90.0, 80.0]);
}
