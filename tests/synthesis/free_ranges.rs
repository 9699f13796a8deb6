//! Functions whose ranges are free: derivatives, seven pairs exactly, the bounds of the ranges, and what a record may say.

use crate::common::parse;
use crate::common::thorough::cases;
use crate::functions::{OFFSETS, assert_true, follower_angle, generated, movable, problem, steps};
use crate::motion::{ALONE, assert_mostly_small, solved, wrapped};
use linkwright::internals::judge::assess::assess;
use linkwright::internals::judge::rank::is_exact;
use linkwright::internals::judge::verify::verify;
use linkwright::internals::numbers::arithmetic::streams::{stream, uniform};
use linkwright::internals::numbers::optimise::levenberg_marquardt::derivative_error;
use linkwright::internals::report::Colour;
use linkwright::internals::report::csv::candidates_csv;
use linkwright::internals::report::html::report_html;
use linkwright::internals::report::table::candidates_table;
use linkwright::internals::synthesis::nearest::nearest_positions;
use linkwright::internals::task::forms::timed::RangedFit;
use linkwright::{Problem, load_problem};
use std::path::Path;

const FREE: &str = "input_range_deg = [10, 360]\noutput_range_deg = [5, 180]\n";

#[test]
fn derivatives_by_the_scales_agree_with_central_differences_under_requirements_of_the_motion() {
    let draws = &mut stream(96, 0);
    for (case, offsets) in OFFSETS.into_iter().enumerate() {
        let mut errors = Vec::new();
        for _ in 0..30 {
            let require = "transmission_deg_min = 30\ntransmission_over = \"used\"\nfootprint_in = [-1, -1, 2, 2]\n\
                           extent_max = 3\n";
            let (problem, setting, design) = movable(draws, offsets, FREE, require);
            let fit = RangedFit::new(&problem, setting).expect("it is a function");
            // Shorter ranges than the linkage closes over.
            let mut x = fit.unknowns(&design, [0.9, 1.0]);
            x[2] += 0.01;
            x[3] += 0.02;
            x[12] = 1.2;
            let steps: [f64; 13] = steps(offsets);
            // Residuals are in degrees.
            let error = derivative_error(&fit, &x, &Vec::new(), &steps, 1e-6);
            errors.extend(error.map(|error| error / 60.0));
        }
        assert!(errors.len() > 20, "case {case}");
        assert_mostly_small(errors);
    }
}

#[test]
fn seven_pairs_of_the_sine_are_met_exactly_from_every_seed_and_the_error_between_them_is_the_known_one() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("problems/function/sine-seven-pairs.toml");
    let mut spec = load_problem(&path, &[]).expect("a problem").spec;
    spec.solve.candidates = 1;
    spec.solve.advice = false;
    for seed in 1..=20 {
        spec.solve.seed = seed;
        let record = solved(spec.clone());
        assert_true(&record);
        let best = &record.candidates[0];
        let checked = Problem::new(spec.clone()).expect("a problem");
        assert!(best.accepted && is_exact(&checked, best), "seed {seed}: {}", best.error.rms);
        // Over the whole quarter of a turn, a little beyond the first and the last pair.
        let [written, _] = spec.task.written_ranges_deg();
        let scale = best.input_range_deg.expect("it is free") / written;
        let k = best.output_range_deg.expect("it is free") / spec.task.written_ranges_deg()[1];
        let [input, output] = [best.input_offset_deg, best.output_offset_deg].map(|o| o.expect("a function"));
        let t1 = best.linkage.assembly().sign();
        let error = |x: f64| {
            let crank = best.linkage.ground_angle() + (input + scale * x).to_radians();
            let turned = follower_angle(best.linkage.four_bar().expect("a four-bar"), crank, t1)
                .expect("it closes")
                - best.linkage.four_bar().expect("a four-bar").ground_angle();
            let sign = best.sense.expect("a function").signs()[0];
            let wanted = output + sign * k * 90.0 * x.to_radians().sin();
            wrapped(wanted.to_radians() - turned).to_degrees().abs()
        };
        let most = (0..=60).map(|i| error(1.5 * f64::from(i))).fold(0.0, f64::max);
        assert!(most < 0.002_145, "seed {seed}: {most}");
        assert!((scale * 90.0 - 151.393).abs() < 1e-3 && (k * 90.0 - 60.234).abs() < 1e-3, "seed {seed}");
    }
}

#[test]
fn functions_of_random_linkages_are_found_again_from_the_proportions_of_their_pairs() {
    let draws = &mut stream(97, 0);
    let mut missed = Vec::new();
    for case in 0..cases(9, 24) {
        let of = generated(draws, [8, 12, 31][case % 3]);
        let base = |all: &[f64]| all.iter().map(|a| a - all[0]).collect::<Vec<f64>>();
        let (inputs, outputs) = (base(&of.crank), base(&of.follower));
        // One of the ranges or both; written at another scale.
        let (free, by) = [
            ("input_range_deg = [10, 360]\n", [uniform(draws, 0.4, 2.5), 1.0]),
            ("output_range_deg = [5, 180]\n", [1.0, uniform(draws, 0.4, 2.5)]),
            (FREE, [uniform(draws, 0.4, 2.5), uniform(draws, 0.4, 2.5)]),
        ][case / 3 % 3];
        let scaled = |all: &[f64], by: f64| all.iter().map(|a| a * by).collect::<Vec<f64>>();
        let lines = format!("{free}sense = \"same\"\n[require]\nlink_ratio_max = 100\n{ALONE}");
        let record = solved(problem(&scaled(&inputs, by[0]), &scaled(&outputs, by[1]), &lines));
        assert_true(&record);
        let best = &record.candidates[0];
        assert_eq!(best.input_range_deg.is_some(), free.contains("input"));
        assert_eq!(best.output_range_deg.is_some(), free.contains("output"));
        let checked = Problem::new(record.problem.resolved.clone()).expect("a problem");
        if !(best.accepted && is_exact(&checked, best)) {
            missed.push((case, best.error.rms));
        }
        // The linkage by itself has the same figures: its ranges and its offset are found.
        let (crank_deg, t1_at) =
            nearest_positions(&checked, best.linkage.four_bar().expect("a four-bar")).expect("it closes");
        let found = assess(&checked, best.linkage, &crank_deg, &t1_at).expect("it closes");
        assert!(
            found.error.rms < best.error.rms + 1e-3,
            "case {case}: {} {}",
            found.error.rms,
            best.error.rms
        );
    }
    assert!(missed.len() <= 2, "{missed:?}");
}

#[test]
fn ranges_keep_their_bounds_and_errors_count_in_parts_of_the_range() {
    let of = |ranges: &str| {
        let text = format!(
            "format = 1\n[task.function]\nof = \"x^2\"\nover = [0, 1]\nsense = \"same\"\n{ranges}\n{ALONE}"
        );
        let record = solved(parse(&text).spec);
        assert_true(&record);
        record.candidates[0].clone()
    };
    let both = of("input_range_deg = \"free\"\noutput_range_deg = \"free\"");
    let wide = of("input_range_deg = [80, 120]\noutput_range_deg = [60, 100]");
    let fixed = of("input_range_deg = 90\noutput_range_deg = 90");
    let within = |range: Option<f64>, low: f64, high: f64| {
        let range = range.expect("it is free");
        assert!(range >= low * (1.0 - 1e-9) && range <= high * (1.0 + 1e-9), "{range}");
    };
    within(both.input_range_deg, 30.0, 180.0);
    within(both.output_range_deg, 30.0, 180.0);
    within(wide.input_range_deg, 80.0, 120.0);
    within(wide.output_range_deg, 60.0, 100.0);
    assert_eq!((fixed.input_range_deg, fixed.output_range_deg), (None, None));
    // More room never makes it worse. A fixed range of 90 degrees is measured in the same degrees.
    assert!(both.error.objective <= wide.error.objective * (1.0 + 1e-9));
    assert!(wide.error.objective <= fixed.error.objective * (1.0 + 1e-9));
    assert!(fixed.error.objective > 0.1 && both.error.objective < 1e-3);
    let part = both.error.rms / both.output_range_deg.expect("it is free");
    assert!((part - both.error.rms_over_size).abs() < 1e-12);
}

#[test]
fn a_record_whose_ranges_are_not_its_linkages_is_refused() {
    let text = format!(
        "format = 1\n[task.function]\ninput_deg = [0, 20, 40, 60, 80]\noutput_deg = [0, 3, 11, 24, 40]\n\
         input_range_deg = [60, 100]\noutput_range_deg = [30, 60]\n[require]\ntransmission_deg_min = 40\n{ALONE}"
    );
    let record = solved(parse(&text).spec);
    assert_true(&record);
    let refused = |change: &dyn Fn(&mut linkwright::internals::record::Candidate), about: &str| {
        let mut other = record.clone();
        change(&mut other.candidates[0]);
        let mismatches = verify(&other).expect("a record");
        assert!(mismatches.iter().any(|m| m.to_string().contains(about)), "{about}: {mismatches:?}");
    };
    refused(&|c| c.input_range_deg = c.input_range_deg.map(|range| range * 1.01), "input_range_deg");
    refused(&|c| c.output_range_deg = c.output_range_deg.map(|range| range * 1.01), "error");
    refused(&|c| c.output_range_deg = None, "output_range_deg");
    refused(&|c| c.output_range_deg = Some(20.0), "output_range_deg");
    refused(&|c| c.crank_deg[2] += 0.5, "crank_deg");
}

#[test]
fn tables_say_how_far_the_links_turn_where_that_is_free() {
    let of = |ranges: &str| {
        let text = format!("format = 1\n[task.function]\nof = \"x^2\"\nover = [0, 1]\n{ranges}\n{ALONE}");
        solved(parse(&text).spec)
    };
    let free = of("input_range_deg = \"free\"\noutput_range_deg = 50");
    let (table, csv) = (candidates_table(&free, Colour::Never), candidates_csv(&free));
    let range = free.candidates[0].input_range_deg.expect("it is free");
    for said in ["crank 30 to 180°, follower 50°", &format!(" +{range:.2}°"), "sum of sq"] {
        assert!(table.contains(said), "{said}\n{table}");
    }
    assert!(
        csv.contains(",input_offset_deg,output_offset_deg,input_range_deg,output_range_deg,sense,"),
        "{csv}"
    );
    let page = report_html(&free, 0);
    assert!(page.contains(&format!("+{range:.2}°")));
    let both = of("input_range_deg = [40, 90]\noutput_range_deg = \"free\"");
    let table = candidates_table(&both, Colour::Never);
    assert!(
        table.contains("crank 40 to 90°, follower 30 to 180°") && table.contains("sq in range"),
        "{table}"
    );
    let fixed = of("input_range_deg = 60\noutput_range_deg = 50");
    let (table, csv) = (candidates_table(&fixed, Colour::Never), candidates_csv(&fixed));
    assert!(table.contains("crank 60°, follower 50°") && !table.contains("° +"), "{table}");
    assert!(csv.contains(",input_offset_deg,output_offset_deg,sense,"), "{csv}");
}
