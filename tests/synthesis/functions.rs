//! Functions, an angle turned into another: derivatives, what the search finds, and that every figure of a record is that of
//! the linkage.

use crate::common::parse;
use crate::common::thorough::cases;
use crate::motion::{ALONE, assert_mostly_small, solved, wrapped};
use linkwright::internals::judge::assess::assess;
use linkwright::internals::judge::practicality::sensitivity::{At, Crank, output_sensitivity};
use linkwright::internals::judge::rank::is_exact;
use linkwright::internals::judge::verify::verify;
use linkwright::internals::mechanism::{Complex, Dyad, Pose};
use linkwright::internals::numbers::arithmetic::streams::{Stream, stream, uniform};
use linkwright::internals::numbers::optimise::levenberg_marquardt::derivative_error;
use linkwright::internals::synthesis::dyads::through_five;
use linkwright::internals::synthesis::nearest::nearest_positions;
use linkwright::internals::task::forms::design_space::{Design, Shape};
use linkwright::internals::task::forms::timed::FunctionFit;
use linkwright::internals::task::{Output, Sense, Setting};
use linkwright::spec::{Objective, ProblemSpec};
use linkwright::{AssemblyMode, CouplerSide, FourBar, Problem, Record, load_problem};
use std::path::Path;

/// A linkage with the angles of its crank, and of its follower from the ground line, radians.
pub(crate) struct Generated {
    pub(crate) linkage: FourBar,
    pub(crate) crank: Vec<f64>,
    pub(crate) follower: Vec<f64>,
}

/// The four-bar with these ratios on the ground from (0, 0) to (1, 0).
fn four_bar(p: f64, q: f64, r: f64, t1: i32) -> Option<FourBar> {
    let assembly = if t1 < 0 { AssemblyMode::Minus } else { AssemblyMode::Plus };
    let pivots = [[0.0, 0.0], [1.0, 0.0]].map(|[x, y]| linkwright::Complex::new(x, y));
    FourBar::with_coupler_offset(pivots, [p, q, r], linkwright::Complex::new(q, 0.0), assembly).ok()
}

/// The follower's angle by circles that meet, without any of the library's kinematics; `None` where they do not.
pub(crate) fn follower_angle(linkage: &FourBar, crank: f64, t1: f64) -> Option<f64> {
    let (a, b) = (linkage.crank_pivot(), linkage.follower_pivot());
    let (cx, cy) = (a.re + linkage.crank() * crank.cos(), a.im + linkage.crank() * crank.sin());
    let (x, y) = (b.re - cx, b.im - cy);
    let (s, q, r) = (x.hypot(y), linkage.coupler(), linkage.follower());
    let cosine = (q * q + s * s - r * r) / (2.0 * q * s);
    if cosine.abs() > 1.0 {
        return None;
    }
    let theta = y.atan2(x) + t1 * cosine.acos();
    let (dx, dy) = (cx + q * theta.cos() - b.re, cy + q * theta.sin() - b.im);
    Some(dy.atan2(dx))
}

/// Draws a linkage whose follower moves smoothly over `n` inputs.
pub(crate) fn generated(draws: &mut Stream, n: usize) -> Generated {
    loop {
        let [p, q, r] = [(); 3].map(|()| uniform(draws, -0.9, 0.9).exp());
        let t1 = if uniform(draws, 0.0, 1.0) < 0.5 { 1 } else { -1 };
        let Some(linkage) = four_bar(p, q, r, t1) else { continue };
        let (from, over) = (uniform(draws, -3.0, 3.0), uniform(draws, 0.8, 1.8));
        let crank: Vec<f64> = (0..n).map(|j| from + over * j as f64 / (n - 1) as f64).collect();
        let follower: Option<Vec<f64>> =
            crank.iter().map(|angle| follower_angle(&linkage, *angle, f64::from(t1))).collect();
        let Some(mut follower) = follower else { continue };
        for j in 1..n {
            follower[j] = follower[j - 1] + wrapped(follower[j] - follower[j - 1]);
        }
        // Away from toggles, where nothing is smooth, and not standing still.
        let steps = || follower.windows(2).map(|w| (w[1] - w[0]).abs() / (over / (n - 1) as f64));
        let range = follower.iter().fold(0.0_f64, |range, angle| range.max((angle - follower[0]).abs()));
        let on_one_branch = linkage.mobility().branch(crank[0], linkage.assembly()).circuit
            == linkage.mobility().branch(crank[n - 1], linkage.assembly()).circuit;
        if steps().fold(0.0, f64::max) < 4.0 && range > 0.3 && on_one_branch {
            return Generated { linkage, crank, follower };
        }
    }
}

/// The problem of these pairs, radians.
pub(crate) fn problem(inputs: &[f64], outputs: &[f64], lines: &str) -> ProblemSpec {
    let degrees = |list: &[f64]| list.iter().map(|angle| angle.to_degrees()).collect::<Vec<f64>>();
    parse(&format!(
        "format = 1\n[task.function]\ninput_deg = {:?}\noutput_deg = {:?}\n{lines}",
        degrees(inputs),
        degrees(outputs)
    ))
    .spec
}

/// Checks the figures of a record's candidates against [`follower_angle`], and the record by `verify`.
pub(crate) fn assert_true(record: &Record) {
    let spec = &record.problem.resolved;
    let pairs = spec.task.pairs();
    let written = spec.task.written_ranges_deg();
    for candidate in &record.candidates {
        let linkage = candidate.linkage.four_bar().expect("a four-bar");
        let ground = linkage.ground_angle();
        let (input_offset, output_offset) = (
            candidate.input_offset_deg.expect("a function"),
            candidate.output_offset_deg.expect("a function"),
        );
        let sign = if candidate.sense == Some(Sense::Opposite) { -1.0 } else { 1.0 };
        // Where a range is free the pairs tell proportions alone.
        let h = candidate.input_range_deg.map_or(1.0, |range| range / written[0]);
        let k = candidate.output_range_deg.map_or(1.0, |range| range / written[1]);
        let (mut sum, mut most) = (0.0, 0.0_f64);
        for (j, [input, output]) in pairs.iter().enumerate() {
            // The crank stands where the offset and the input say.
            let crank = ground + (input_offset + h * input).to_radians();
            assert!(wrapped(crank - candidate.crank_deg[j].to_radians()).abs() < 1e-9);
            let turned = follower_angle(linkage, crank, candidate.t1_at[j].sign()).expect("it closes");
            let error =
                wrapped(ground + (output_offset + sign * k * output).to_radians() - turned).to_degrees();
            sum += error * error;
            most = most.max(error.abs());
        }
        let rms = (sum / pairs.len() as f64).sqrt();
        let of_output = candidate.error.output.expect("a function");
        assert!((of_output.rms_deg - rms).abs() < 1e-9 * (1.0 + rms), "{} {rms}", of_output.rms_deg);
        assert!((of_output.max_deg - most).abs() < 1e-9 * (1.0 + most), "{} {most}", of_output.max_deg);
        assert!((candidate.error.rms - of_output.rms_deg).abs() < 1e-9);
        if spec.solve.objective == Objective::SumOfSquares && spec.task.weight.is_none() {
            let (objective, in_range) = (candidate.error.objective, sum / (k * k));
            assert!((objective - in_range).abs() < 1e-9 * (1.0 + in_range), "{objective} {in_range}");
        }
    }
    assert_eq!(verify(record).expect("a record"), []);
}

fn collection() -> Vec<(ProblemSpec, f64, f64)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("problems/function");
    let mut all = Vec::new();
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.extension().is_some_and(|e| e == "toml") {
            let file = load_problem(&path, &[]).expect("a problem");
            let expect = file.expect.expect("it says what is known");
            if let (Some(rms), Some(max)) = (expect.rms_deg, expect.max_deg) {
                all.push((file.spec, rms, max));
            }
        }
    }
    assert!(all.len() >= 7);
    all
}

#[test]
fn functions_of_the_textbooks_are_as_good_as_is_known_from_every_seed() {
    for (mut spec, rms, max) in collection() {
        spec.solve.candidates = 1;
        spec.solve.advice = false;
        for seed in 1..=cases(1, 4) {
            spec.solve.seed = seed;
            for (objective, known) in [(Objective::SumOfSquares, rms), (Objective::MaxDeviation, max)] {
                spec.solve.objective = objective;
                let record = solved(spec.clone());
                assert_true(&record);
                let best = &record.candidates[0];
                let error = best.error.output.expect("a function");
                let reached =
                    if objective == Objective::SumOfSquares { error.rms_deg } else { error.max_deg };
                assert!(best.accepted && reached <= known * (1.0 + 1e-6), "{reached} {known} (seed {seed})");
            }
        }
    }
}

/// The references of inputs and outputs, in every mixture.
pub(crate) const OFFSETS: [(&str, &str); 4] =
    [("free", "free"), ("ground", "free"), ("free", "ground"), ("ground", "ground")];

/// The problem of seven pairs of a random linkage that count from `offsets`, with further lines of the function and of what is
/// required, and the linkage as its design. Its pivots may move, so that the ground line turns.
pub(crate) fn movable(
    draws: &mut Stream,
    (input, output): (&str, &str),
    lines: &str,
    require: &str,
) -> (Problem, Setting, Design) {
    let of = generated(draws, 7);
    let base = |offset: &str, all: &[f64]| if offset == "ground" { 0.0 } else { all[0] };
    let inputs: Vec<f64> = of.crank.iter().map(|a| a - base(input, &of.crank)).collect();
    let outputs: Vec<f64> = of.follower.iter().map(|a| a - base(output, &of.follower)).collect();
    let lines = format!(
        "{lines}input_offset = \"{input}\"\noutput_offset = \"{output}\"\nsense = \"same\"\n[design]\n\
         A = [[-0.5, 0.5], [-0.5, 0.5]]\nB = [[0.5, 1.5], [-0.5, 0.5]]\n[require]\n{require}"
    );
    let problem = Problem::new(problem(&inputs, &outputs, &lines)).expect("a problem");
    let side = CouplerSide::Plus;
    let setting = Setting { aim: None, assembly: of.linkage.assembly(), direction: 1.0, side };
    let turn = if input == "free" { of.crank[0] } else { 0.0 };
    let design = problem.space(side).design(&Shape::from(&of.linkage), turn);
    (problem, setting, design)
}

/// The steps of central differences by the unknowns of a function: none by what the fit does not move.
pub(crate) fn steps<const N: usize>((input, output): (&str, &str)) -> [f64; N] {
    let mut steps = [1e-6; N];
    (steps[7], steps[8]) = (0.0, 0.0);
    steps[9] = if input == "free" { 1e-6 } else { 0.0 };
    steps[10] = if output == "free" { 1e-6 } else { 0.0 };
    steps
}

#[test]
fn derivatives_of_a_function_agree_with_central_differences() {
    let draws = &mut stream(91, 0);
    for (case, offsets) in OFFSETS.into_iter().enumerate() {
        let mut errors = Vec::new();
        for _ in 0..30 {
            let require = "transmission_deg_min = 30\ntype = [\"crank-rocker\"]\n";
            let (problem, setting, design) = movable(draws, offsets, "", require);
            let fit = FunctionFit::new(&problem, setting).expect("it is a function");
            let mut x = fit.unknowns(&design, [1.0; 2]);
            x[2] += 0.01;
            x[3] += 0.02;
            let steps: [f64; 11] = steps(offsets);
            // Residuals are in degrees.
            let error = derivative_error(&fit, &x, &Vec::new(), &steps, 1e-6);
            errors.extend(error.map(|error| error / 60.0));
        }
        assert!(errors.len() > 20, "case {case}");
        assert_mostly_small(errors);
    }
}

#[test]
fn functions_of_random_linkages_are_found_again_in_either_sense_and_from_the_ground() {
    let draws = &mut stream(92, 0);
    let mut missed = Vec::new();
    for case in 0..48 {
        let of = generated(draws, [7, 9, 15, 40][case % 4]);
        let (input, output) =
            [("free", "free"), ("ground", "free"), ("free", "ground"), ("ground", "ground")][case / 4 % 4];
        // Every other function counts its outputs clockwise.
        let sign = if case % 2 == 0 { 1.0 } else { -1.0 };
        let base = |offset: &str, all: &[f64]| if offset == "ground" { 0.0 } else { all[0] };
        let inputs: Vec<f64> = of.crank.iter().map(|a| a - base(input, &of.crank)).collect();
        let outputs: Vec<f64> = of.follower.iter().map(|a| sign * (a - base(output, &of.follower))).collect();
        let sense = ["any", if sign > 0.0 { "same" } else { "opposite" }][case / 2 % 2];
        let lines = format!(
            "input_offset = \"{input}\"\noutput_offset = \"{output}\"\nsense = \"{sense}\"\n[require]\n\
             link_ratio_max = 100\n{ALONE}"
        );
        let record = solved(problem(&inputs, &outputs, &lines));
        assert_true(&record);
        let best = &record.candidates[0];
        let checked = Problem::new(record.problem.resolved.clone()).expect("a problem");
        if !(best.accepted && is_exact(&checked, best)) {
            missed.push((case, best.error.rms));
        }
        let [input_offset, output_offset] = [best.input_offset_deg, best.output_offset_deg];
        assert!(input == "free" || input_offset == Some(0.0), "case {case}");
        assert!(output == "free" || output_offset == Some(0.0), "case {case}");
    }
    assert!(missed.len() <= 1, "{missed:?}");
}

#[test]
fn three_four_and_five_pairs_are_met_exactly_and_fewer_leave_the_better_transmission() {
    let draws = &mut stream(93, 0);
    for case in 0..12 {
        let n = [3, 4, 5][case % 3];
        let of = generated(draws, n);
        let inputs: Vec<f64> = of.crank.iter().map(|a| a - of.crank[0]).collect();
        let outputs: Vec<f64> = of.follower.iter().map(|a| a - of.follower[0]).collect();
        let record = solved(problem(&inputs, &outputs, &format!("[require]\nlink_ratio_max = 100\n{ALONE}")));
        assert_true(&record);
        let checked = Problem::new(record.problem.resolved.clone()).expect("a problem");
        let best = &record.candidates[0];
        assert!(best.accepted && is_exact(&checked, best), "case {case}: {}", best.error.rms);
        // Of a family the best transmitting member is wanted: at least as good as the linkage it came from.
        let own = of.crank.iter().zip(&of.follower).map(|(crank, follower)| {
            let (a, b) = (of.linkage.crank_pivot(), of.linkage.follower_pivot());
            let c = a + linkwright::Complex::from_polar(of.linkage.crank(), *crank);
            let d = b + linkwright::Complex::from_polar(of.linkage.follower(), *follower);
            let between = ((c - d) / (b - d)).arg().abs();
            between.min(std::f64::consts::PI - between).to_degrees()
        });
        let own = own.fold(90.0, f64::min);
        assert!(n == 5 || best.transmission_deg.worst >= own - 1.0, "{} {own}", best.transmission_deg.worst);
    }
}

#[test]
fn a_function_and_its_mirror_image_have_the_same_answers() {
    let outputs = [0.0, 2.0, 8.0, 18.0, 31.0, 48.0, 67.0];
    let of = |sign: f64, sense: &str| {
        let outputs = outputs.map(|deg: f64| sign * deg);
        let text = format!(
            "format = 1\n[task.function]\ninput_deg = [0, 15, 30, 45, 60, 75, 90]\noutput_deg = {outputs:?}\n\
             sense = \"{sense}\"\n[require]\ntransmission_deg_min = 35\n[solve]\ncandidates = 3\nadvice = false\n"
        );
        let record = solved(parse(&text).spec);
        assert_true(&record);
        assert!(record.candidates.iter().all(|c| c.accepted && c.transmission_deg.worst > 35.0 - 1e-6));
        record.candidates.iter().map(|c| c.error.rms).collect::<Vec<f64>>()
    };
    // Outputs that count clockwise are those of the other sign that count counter-clockwise.
    for (one, other) in [(of(1.0, "same"), of(-1.0, "opposite")), (of(1.0, "opposite"), of(-1.0, "same"))] {
        assert!((one[0] - other[0]).abs() < 1e-9 * (1.0 + one[0]), "{one:?} {other:?}");
    }
    let best = of(1.0, "same")[0].min(of(1.0, "opposite")[0]);
    assert!((of(1.0, "any")[0] - best).abs() < 1e-6 * (1.0 + best));
}

#[test]
fn the_ground_scales_a_function_and_moves_it_along() {
    let text = |design: &str| {
        format!(
            "format = 1\n[task.function]\nof = \"x^2\"\nover = [0, 1]\ninput_range_deg = 90\noutput_range_deg = 90\n\
             sense = \"same\"\n[design]\n{design}\n{ALONE}"
        )
    };
    let of = |design: &str| {
        let record = solved(parse(&text(design)).spec);
        assert_true(&record);
        record.candidates[0].clone()
    };
    let unit = of("");
    for (design, scale, turn) in [
        ("ground = 80\n", 80.0, 0.0),
        ("A = [10, -5]\nB = [50, 25]\n", 50.0, (30.0_f64).atan2(40.0)),
        ("A = [10, -5]\n", 1.0, 0.0),
    ] {
        let other = of(design);
        assert!((other.error.rms - unit.error.rms).abs() < 1e-8, "{design}");
        assert!((other.linkage.crank() - scale * unit.linkage.crank()).abs() < 1e-4 * scale, "{design}");
        assert!((wrapped(other.linkage.ground_angle() - turn)).abs() < 1e-9, "{design}");
        let [one, two] = [unit.input_offset_deg, other.input_offset_deg].map(|deg| deg.expect("a function"));
        assert!(wrapped((one - two).to_radians()).abs() < 1e-4, "{design}");
    }
}

#[test]
fn tolerances_of_outputs_are_kept_one_by_one() {
    let lines = |tolerance: f64| {
        format!(
            "format = 1\n[task.function]\nof = \"sin(x*PI/180)\"\nover = [0, 90]\ninput_range_deg = 90\n\
             output_range_deg = 90\nsense = \"same\"\ntolerance_deg = {tolerance}\n{ALONE}"
        )
    };
    // The least largest error is 0.19013 degrees.
    let within = solved(parse(&lines(0.1902)).spec);
    assert_true(&within);
    assert!(within.candidates[0].accepted && within.candidates[0].error.max <= 0.1902 * (1.0 + 1e-9));
    let beyond = solved(parse(&lines(0.19)).spec);
    assert_true(&beyond);
    let nearest = &beyond.candidates[0];
    assert!(!nearest.accepted && (nearest.error.max - 0.190_129_9).abs() < 1e-6, "{}", nearest.error.max);
}

#[test]
fn a_linkage_by_itself_is_measured_in_its_own_sense_and_no_record_may_run_its_inputs_back() {
    for (outputs, sense) in
        [([0.0, 5.0, 12.0, 22.0, 37.0], Sense::Same), ([0.0, 4.0, 11.0, 23.0, 36.0], Sense::Opposite)]
    {
        let name = if sense == Sense::Same { "same" } else { "opposite" };
        let of = |sense: &str| {
            let text = format!(
                "format = 1\n[task.function]\ninput_deg = [0, 20, 40, 60, 80]\noutput_deg = {outputs:?}\nsense = \"{sense}\"\n\
                 [require]\ntransmission_deg_min = 30\n{ALONE}"
            );
            parse(&text).spec
        };
        let mut record = solved(of(name));
        let best = record.candidates[0].clone();
        // Nothing is said of the sense: it is found.
        let problem = Problem::new(of("any")).expect("a problem");
        let (crank_deg, t1_at) =
            nearest_positions(&problem, best.linkage.four_bar().expect("a four-bar")).expect("it closes");
        let found = assess(&problem, best.linkage, &crank_deg, &t1_at).expect("it closes");
        assert_eq!(found.sense, Some(sense));
        assert!((found.error.rms - best.error.rms).abs() < 1e-6, "{} {}", found.error.rms, best.error.rms);
        for (has, own) in crank_deg.iter().zip(&best.crank_deg) {
            assert!(wrapped((has - own).to_radians()).abs() < 1e-4, "{has} {own}");
        }
        let ends = best.crank_deg[0] + best.crank_deg[4];
        record.candidates[0].crank_deg.iter_mut().for_each(|deg| *deg = ends - *deg);
        let mismatches = verify(&record).expect("a record");
        assert!(mismatches.iter().any(|m| m.to_string().contains("crank_deg")), "{mismatches:?}");
    }
}

#[test]
fn a_wrong_dimension_changes_the_output_as_its_derivative_says() {
    let draws = &mut stream(94, 0);
    for _ in 0..20 {
        let of = generated(draws, 11);
        let linkage = of.linkage.with_assembly(of.linkage.assembly());
        let t1 = linkage.assembly().sign();
        let at: Vec<At> = of
            .crank
            .iter()
            .map(|angle| At { crank_angle: *angle, assembly: linkage.assembly(), is_free: false })
            .collect();
        let felt = output_sensitivity(linkage, Output::Angle, &at, (Crank::OffsetIsSet, true))
            .expect("it has derivatives");
        let outputs = |linkage: &FourBar, turn: f64| -> Vec<f64> {
            let ground = linkage.ground_angle();
            let turned = |angle: &f64| {
                let psi = follower_angle(linkage, angle + turn + ground, t1).expect("it closes");
                wrapped(psi - ground).to_degrees()
            };
            of.crank.iter().map(turned).collect()
        };
        let step = 1e-6;
        for (k, name) in ["a", "b", "c"].into_iter().enumerate() {
            let mut lengths = [linkage.crank(), linkage.coupler(), linkage.follower()];
            lengths[k] += step;
            let other = four_bar(lengths[0], lengths[1], lengths[2], t1 as i32).expect("a linkage");
            let change = |turn: f64| -> Vec<f64> {
                let (one, two) = (outputs(&linkage, 0.0), outputs(&other, turn));
                let apart: Vec<f64> =
                    one.iter().zip(&two).map(|(a, b)| wrapped((b - a).to_radians()).to_degrees()).collect();
                let mean = apart.iter().sum::<f64>() / apart.len() as f64;
                apart.iter().map(|a| a - mean).collect()
            };
            // The crank's offset that changes the outputs least, by a line through two of them.
            let (still, turned) = (change(0.0), change(step));
            let by: Vec<f64> = still.iter().zip(&turned).map(|(a, b)| (b - a) / step).collect();
            let along = still.iter().zip(&by).map(|(s, b)| s * b).sum::<f64>()
                / by.iter().map(|b| b * b).sum::<f64>();
            let left = still.iter().zip(&by).map(|(s, b)| (s - along * b) / step);
            let rms = (left.map(|x| x * x).sum::<f64>() / still.len() as f64).sqrt();
            let felt = felt.dimensions.iter().find(|d| d.name == name).expect("it is one of nine").rms;
            assert!((felt - rms).abs() < 2e-3 * (1.0 + rms), "{name}: {felt} {rms}");
        }
    }
}

/// Every four-bar through five pairs with both offsets free, by the dyads of the input link as it is seen from the output link
/// (one of them is the ground): p, q, r, the offsets, and t1 where it is the same at all pairs.
fn through_five_pairs(inputs: &[f64], outputs: &[f64]) -> Vec<(FourBar, [f64; 2])> {
    let pose = |j: usize| Pose {
        position: -Complex::from_polar(1.0, -outputs[j]),
        direction: Complex::from_polar(1.0, inputs[j] - outputs[j]),
    };
    let mut found = Vec::new();
    for dyad in through_five(&[0, 1, 2, 3, 4].map(pose)) {
        let Dyad::RR { pin, pivot, length } = dyad else { continue };
        if pin.norm().max(pivot.norm()) < 1e-6 {
            continue;
        }
        let t1 = |j: usize| {
            let crank = pin * Complex::from_polar(1.0, inputs[j]);
            let follower = 1.0 + pivot * Complex::from_polar(1.0, outputs[j]);
            ((1.0 - crank).conj() * (follower - crank)).im.signum()
        };
        if (1..5).all(|j| t1(j) == t1(0)) {
            let linkage = four_bar(pin.norm(), length, pivot.norm(), t1(0) as i32);
            found.extend(linkage.map(|linkage| (linkage, [pin.arg(), pivot.arg()])));
        }
    }
    found
}

#[test]
fn every_linkage_through_five_pairs_is_among_the_answers() {
    let draws = &mut stream(98, 0);
    let (mut several, mut all) = (0, 0);
    for case in 0..25 {
        let of = generated(draws, 5);
        let base = |list: &[f64]| list.iter().map(|angle| angle - list[0]).collect::<Vec<f64>>();
        let (inputs, outputs) = (base(&of.crank), base(&of.follower));
        let lines =
            "sense = \"same\"\n[require]\nlink_ratio_max = 1000\n[solve]\ncandidates = 6\nadvice = false\n";
        let spec = problem(&inputs, &outputs, lines);
        let record = solved(spec.clone());
        // Some of the answers stand at a toggle, where circles meet by rounding alone.
        assert_eq!(verify(&record).expect("a record"), [], "case {case}");
        let checked = Problem::new(spec).expect("a problem");
        let mut known = 0;
        for (linkage, [input, _]) in through_five_pairs(&inputs, &outputs) {
            let crank_deg: Vec<f64> = inputs.iter().map(|angle| (input + angle).to_degrees()).collect();
            let judged = assess(&checked, linkage, &crank_deg, &[linkage.assembly(); 5]);
            if !judged.is_some_and(|candidate| candidate.accepted && is_exact(&checked, &candidate)) {
                continue;
            }
            known += 1;
            let is_it = |candidate: &linkwright::Candidate| {
                let l = candidate.linkage.four_bar().expect("a four-bar");
                let links = [l.crank(), l.coupler(), l.follower()];
                let wanted = [linkage.crank(), linkage.coupler(), linkage.follower()];
                links.iter().zip(wanted).all(|(one, other)| (one - other).abs() < 1e-5 * (1.0 + other))
            };
            assert!(record.candidates.iter().any(is_it), "case {case}: {linkage}");
        }
        assert!(known >= 1, "case {case}");
        several += usize::from(known > 1);
        all += known;
    }
    assert!(several > 0 && all >= 25, "{several} {all}");
}
