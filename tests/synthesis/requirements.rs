//! What is required is held by the search, and what the search calls accepted the referee accepts.

use crate::common::{bytes, parse, run_on, thorough};
use linkwright::internals::files::problem_file::load_any;
use linkwright::internals::judge::verify::verify;
use linkwright::internals::record::{Figure, Record};
use linkwright::internals::report::Colour;
use linkwright::internals::report::table::candidates_table;
use proptest::prelude::*;

/// Twelve points of an egg-shaped curve with extra tables.
fn egg(tables: &str) -> String {
    let points: Vec<String> = (0..12)
        .map(|i| {
            let t = (30.0 * f64::from(i)).to_radians();
            format!(
                "[{:.4}, {:.4}]",
                40.0 * t.cos() + 6.0 * (2.0 * t).cos(),
                22.0 * t.sin() + 5.0 * (2.0 * t).sin()
            )
        })
        .collect();
    format!("format = 1\n[task.path]\npoints = [{}]\nclosed = true\n{tables}", points.join(", "))
}

fn accepted_and_true(text: &str) -> Record {
    let record = run_on(2, parse(text));
    assert_eq!(verify(&record).expect("the problem is one"), Vec::new(), "{text}");
    assert!(record.candidates.first().is_some_and(|c| c.accepted), "nothing acceptable for {text}");
    record
}

fn requirement(record: &Record, name: &str) -> Figure {
    let row = record.candidates[0].requirements.iter().find(|r| r.name == name);
    row.unwrap_or_else(|| panic!("{name} is listed")).value.clone()
}

#[test]
fn each_requirement_is_met_where_it_binds() {
    let solve = format!("[solve]\ncandidates = {}\n", thorough::cases(1, 3));
    let asked = |line: &str| egg(&format!("[require]\ntype = [\"crank-rocker\"]\n{line}\n{solve}"));
    let free = accepted_and_true(&asked(""));
    let cases = [
        "transmission_deg_min = 45",
        "link_ratio_max = 2.5",
        "pivots_in = [-60, -60, 60, 0]",
        "footprint_in = [-90, -90, 90, 90]",
        "direction = \"cw\"",
    ];
    for line in cases {
        let record = accepted_and_true(&asked(line));
        // A requirement can only cost.
        assert!(
            record.candidates[0].error.sum_sq >= free.candidates[0].error.sum_sq * (1.0 - 1e-6),
            "{line}"
        );
    }
}

#[test]
fn a_binding_transmission_angle_is_used_up_to_its_limit() {
    let record = accepted_and_true(&egg("[require]\ntype = [\"crank-rocker\"]\ntransmission_deg_min = 45\n"));
    let Figure::Number(worst) = requirement(&record, "transmission_deg_min") else { panic!("a number") };
    assert!((45.0 - 1e-5..45.1).contains(&worst), "{worst}");
}

#[test]
fn a_binding_extent_and_a_binding_longest_link_are_used_up_to_their_limits() {
    let any = egg("[require]\nlongest_max = \"any\"\n[solve]\ncandidates = 1\n");
    let free = accepted_and_true(&any);
    for name in ["extent_max", "longest_max"] {
        let asked = |limit: f64| {
            egg(&format!("[require]\ntype = [\"crank-rocker\"]\n{name} = {limit}\n[solve]\ncandidates = 1\n"))
        };
        let number = |record: &Record| match requirement(record, name) {
            Figure::Number(value) => value,
            other => panic!("{name} = {other}"),
        };
        let loose = accepted_and_true(&asked(1e6));
        let limit = 0.85 * number(&loose);
        let tight = accepted_and_true(&asked(limit));
        let value = number(&tight);
        assert!(value <= limit * (1.0 + 1e-7) && value >= limit * (1.0 - 1e-5), "{name}: {value} of {limit}");
        let sum_sq = |record: &Record| record.candidates[0].error.sum_sq;
        assert!(sum_sq(&tight) > sum_sq(&loose), "{name} costs");
        assert!(free.candidates[0].requirements.iter().all(|r| r.name != name), "{name} is not asked for");
    }
}

#[test]
fn a_bare_closed_path_is_drawn_by_links_of_three_sizes_at_most() {
    let folder = tempfile::tempdir().expect("a folder");
    let csv = folder.path().join("oval.csv");
    let rows: Vec<String> = (0..12)
        .map(|i| f64::from(30 * i).to_radians())
        .map(|t| format!("{:.1},{:.1}\n", 40.0 * t.cos(), 20.0 * t.sin()))
        .collect();
    std::fs::write(&csv, format!("x,y\n{}", rows.concat())).expect("written");
    let run = |longest: Option<&str>| {
        let mut set = vec![
            ("task.path.closed".to_owned(), "true".to_owned()),
            ("solve.candidates".into(), "1".into()),
            ("solve.evaluations".into(), "40000".into()),
        ];
        set.extend(longest.map(|value| ("require.longest_max".to_owned(), value.to_owned())));
        let record = run_on(2, load_any(&csv, &set).expect("a problem"));
        assert_eq!(verify(&record).expect("the problem is one"), Vec::new());
        assert!(record.candidates[0].accepted);
        record
    };
    // The oval is 80 wide and 40 high.
    let size = 80f64.hypot(40.0);
    let longest = |record: &Record| {
        let linkage = record.candidates[0].linkage.four_bar().expect("a four-bar");
        linkage.longest_link().max(linkage.crank_side()).max(linkage.follower_side())
    };
    let (plain, any, typed) = (run(None), run(Some("any")), run(Some(&(3.0 * size).to_string())));
    assert!(longest(&plain) <= 3.0 * size * (1.0 + 1e-7), "{}", longest(&plain));
    assert!(longest(&any) > 3.0 * size, "{}", longest(&any));
    assert!(bytes(&plain) != bytes(&any));
    // No record tells a limit that is typed from the default.
    assert_eq!(bytes(&plain), bytes(&typed));
    // The best answer is on the limit: the table says what it costs.
    let cost = plain.candidates[0].costs.iter().find(|cost| cost.name == "longest_max").expect("it binds");
    let rms = plain.candidates[0].error.rms;
    assert!(cost.rms_without.is_some_and(|without| without < 0.5 * rms), "{cost:?}, {rms}");
    let shown = candidates_table(&plain, Colour::Never);
    assert!(shown.contains("longest_max (3 sizes, the default) costs"), "{shown}");
}

#[test]
fn extent_and_longest_link_are_what_the_joints_and_the_lengths_say() {
    let text = egg("[require]\ntype = [\"crank-rocker\"]\nextent_max = 1e6\nlongest_max = 1e6\n");
    let record = accepted_and_true(&text);
    let linkage = record.candidates[0].linkage.four_bar().expect("a four-bar");
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for i in 0..36_000 {
        let joints = linkage.position(f64::from(i).to_radians() / 100.0).joints().expect("it turns fully");
        let [a, b] = [linkage.crank_pivot(), linkage.follower_pivot()];
        for p in [a, b, joints.crank_pin, joints.follower_pin, joints.coupler_point] {
            low = [low[0].min(p.re), low[1].min(p.im)];
            high = [high[0].max(p.re), high[1].max(p.im)];
        }
    }
    let Figure::Number(extent) = requirement(&record, "extent_max") else { panic!("a number") };
    let seen = (high[0] - low[0]).hypot(high[1] - low[1]);
    // Samples in steps of a hundredth of a degree miss an extreme by a few parts in 1e9.
    assert!((extent - seen).abs() <= 1e-7 * seen, "{extent} {seen}");
    let Figure::Number(longest) = requirement(&record, "longest_max") else { panic!("a number") };
    let [ground, crank, coupler, follower] = linkage.links();
    let lengths = [ground, crank, coupler, follower, linkage.crank_side(), linkage.follower_side()];
    assert_eq!(longest, lengths.into_iter().fold(0.0, f64::max));
}

#[test]
fn every_type_can_be_asked_for() {
    for kind in
        ["crank-rocker", "double-crank", "rocker-crank", "double-rocker", "triple-rocker", "change-point"]
    {
        let record = accepted_and_true(&format!(
            "format = 1\n[task.path]\npoints = [[0, 0], [10, 3], [20, 5], [30, 5], [40, 3], [50, 0]]\n\
             [require]\ntype = [\"{kind}\"]\n"
        ));
        assert_eq!(record.candidates[0].type_name(), kind);
    }
}

#[test]
fn fixed_and_derived_values_are_kept_to_the_last_figure() {
    let record = accepted_and_true(&egg(
        "[design]\nA = [-30, -40]\nB = [[20, 80], [-60, 20]]\nground = 70\na = 15\nd = [30, 90]\n",
    ));
    let linkage = record.candidates[0].linkage.four_bar().expect("a four-bar");
    assert_eq!((linkage.crank_pivot().re, linkage.crank_pivot().im), (-30.0, -40.0));
    assert_eq!(linkage.crank(), 15.0);
    assert!((linkage.ground() - 70.0).abs() <= 70.0 * 1e-7);
    assert!((30.0 - 1e-5..=90.0 + 1e-5).contains(&linkage.crank_side()));
}

#[test]
fn distances_to_the_coupler_point_can_be_the_coordinates() {
    let record = accepted_and_true(&egg("[design]\nb = 80\nd = [20, 90]\ne = [20, 90]\n"));
    let linkage = record.candidates[0].linkage.four_bar().expect("a four-bar");
    assert_eq!(linkage.coupler(), 80.0);
    assert!(
        (20.0..=90.0).contains(&linkage.crank_side()) && (20.0..=90.0).contains(&linkage.follower_side())
    );
}

#[test]
fn a_coupler_point_on_the_crank_pin_goes_round_with_it() {
    let record = accepted_and_true(&egg("[design]\nd = 0\n"));
    assert_eq!(record.candidates[0].linkage.crank_side(), 0.0);
}

#[test]
fn a_flat_ground_stays_flat() {
    let record = accepted_and_true(&egg("[design]\nground_angle_deg = 0\n"));
    let linkage = record.candidates[0].linkage.four_bar().expect("a four-bar");
    assert_eq!(linkage.crank_pivot().im, linkage.follower_pivot().im);
}

#[test]
fn ground_timing_counts_from_the_line_between_the_pivots() {
    let record = accepted_and_true(
        "format = 1\n[task.path]\npoints = [[0, 0], [2, 6], [7, 9], [13, 9], [18, 6], [20, 0]]\n\
         [task.path.timing]\ncrank_deg = [30, 60, 90, 120, 150, 180]\noffset = \"ground\"\n",
    );
    let candidate = &record.candidates[0];
    let off = candidate.crank_deg[0] - 30.0 - candidate.linkage.ground_angle().to_degrees();
    assert!((off / 360.0 - (off / 360.0).round()).abs() < 1e-12);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, failure_persistence: None, rng_seed: proptest::test_runner::RngSeed::Fixed(7), ..ProptestConfig::default() })]

    #[test]
    #[ignore = "slow: .ci/run runs it"]
    fn whatever_is_called_accepted_verifies(
        transmission in prop::option::of(0.0..50.0f64),
        ratio in prop::option::of(1.5..30.0f64),
        half in prop::option::of(30.0..200.0f64),
        footprint in prop::option::of(60.0..300.0f64),
        timed in any::<bool>(),
        branch_any in any::<bool>(),
        kinds in prop::sample::subsequence(vec!["crank-rocker", "double-crank", "rocker-crank", "double-rocker", "triple-rocker"], 0..4),
        seed in 0..1000u32,
    ) {
        let mut tables = String::new();
        if timed {
            let angles: Vec<String> = (0..12).map(|i| (30 * i).to_string()).collect();
            tables += &format!("[task.path.timing]\ncrank_deg = [{}]\n", angles.join(", "));
        }
        tables += "[require]\n";
        if let Some(x) = transmission { tables += &format!("transmission_deg_min = {x:.3}\n"); }
        if let Some(x) = ratio { tables += &format!("link_ratio_max = {x:.3}\n"); }
        if let Some(x) = half { tables += &format!("pivots_in = [-{x:.3}, -{x:.3}, {x:.3}, {x:.3}]\n"); }
        if let Some(x) = footprint { tables += &format!("footprint_in = [-{x:.3}, -{x:.3}, {x:.3}, {x:.3}]\n"); }
        if branch_any { tables += "branch = \"any\"\n"; }
        if !kinds.is_empty() { tables += &format!("type = {kinds:?}\n"); }
        tables += &format!("[solve]\nseed = {seed}\nevaluations = 12000\n");
        let text = egg(&tables);
        let record = run_on(2, parse(&text));
        prop_assert_eq!(verify(&record).expect("the problem is one"), Vec::new(), "{}", text);
    }
}

#[test]
fn a_footprint_counts_the_whole_turn_however_many_turns_the_timing_spans() {
    let text = "format = 1\n[task.path]\npoints = [[0, 0], [1, 0.3], [0.5, 1]]\n[task.path.timing]\n\
                crank_deg = [0, 86520, 172890]\n[require]\ntype = [\"crank-rocker\"]\nfootprint_in = [-1.2, -1.2, 2, 2]\n";
    let record = run_on(2, parse(text));
    for candidate in record.candidates.iter().filter(|c| c.accepted) {
        for i in 0..3600 {
            let joints = candidate
                .linkage
                .four_bar()
                .expect("a four-bar")
                .position(f64::from(i) * 1e-1f64.to_radians())
                .joints()
                .expect("a crank");
            for p in [joints.crank_pin, joints.follower_pin, joints.coupler_point] {
                assert!(
                    p.re > -1.2 - 1e-6 && p.im > -1.2 - 1e-6 && p.re < 2.0 + 1e-6 && p.im < 2.0 + 1e-6,
                    "{p}"
                );
            }
        }
    }
}

#[test]
fn the_answer_moves_with_the_target() {
    let shifted = |by: f64| {
        let points: Vec<String> = (0..12)
            .map(|i| {
                let t = (30.0 * f64::from(i)).to_radians();
                format!("[{}, {}]", 40.0 * t.cos() + 6.0 * (2.0 * t).cos() + by, 22.0 * t.sin() - by)
            })
            .collect();
        let text = format!(
            "format = 1\n[task.path]\npoints = [{}]\nclosed = true\n[require]\ntransmission_deg_min = 30\n",
            points.join(", ")
        );
        run_on(2, parse(&text)).candidates[0].error.sum_sq
    };
    let at_home = shifted(0.0);
    // Coordinates of 1e6 leave ten digits of the points themselves.
    assert!((shifted(1e6) - at_home).abs() <= 1e-6 * at_home, "{} {at_home}", shifted(1e6));
}
