//! report.html: small, alone, the same bytes each time, and nothing that a record says becomes markup or script.

use crate::common::root;
use crate::report::records::{candidate, detail, ellipse, k18, linkage, path, record, rocking, shapes};
use linkwright::internals::files::generator::FileKind;
use linkwright::internals::judge::practicality::{Build, Practicality};
use linkwright::internals::mechanism::{AssemblyMode, LinkageKind};
use linkwright::internals::record::*;
use linkwright::internals::report::html::{Extent, report_html, report_with_drawings};
use linkwright::internals::task::Defect;
use linkwright::internals::task::Problem;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

struct Answer {
    code: i32,
    stdout: String,
    stderr: String,
}

fn linkwright(folder: &Path, args: &[&str]) -> Answer {
    let mut command = assert_cmd::Command::cargo_bin("linkwright").expect("it is built");
    let output = command.current_dir(folder).env("NO_COLOR", "1").args(args).output().expect("it runs");
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("text");
    Answer {
        code: output.status.code().expect("it ends by itself"),
        stdout: text(output.stdout),
        stderr: text(output.stderr),
    }
}

fn shipped(name: &str) -> String {
    root().join("problems").join(name).display().to_string()
}

/// A quick result in the folder `r`.
fn quick_result(folder: &Path) {
    let problem = shipped("literature/k18.toml");
    let said =
        linkwright(folder, &["synth", &problem, "--out", "r", "--quiet", "--set", "solve.evaluations=6000"]);
    assert!(said.code < 2, "{}", said.stderr);
}

/// A proof within 0.01 % of K18's optimum.
fn certificate() -> Certificate {
    let part = |linkage_type: &str, direction: i8| CertificatePart {
        linkage_type: linkage_type.into(),
        direction,
        lower_bound: 0.009_028,
        closed: true,
        boxes: 1_200_000,
        leaves_sha256: "ab".repeat(32),
    };
    Certificate {
        statement: "No four-bar linkage has a sum of squared errors below 9.028e-3.".into(),
        lower_bound: 0.009_028,
        gap: 9.9e-5,
        closed: true,
        boxes: 4_800_000,
        covered: vec!["crank-rockers and double-cranks".into(), "both assemblies".into()],
        not_covered: vec!["linkages whose input rocks".into()],
        leaves_sha256: "cd".repeat(32),
        wanted_gap: 1e-4,
        parts: vec![part("crank-rocker", 1), part("double-crank", -1)],
    }
}

/// K18 with five candidates, warnings, cognates, costs and a buildable answer beside them.
fn five() -> Record {
    let mut record = k18();
    let mut fifth = record.candidates[2].clone();
    fifth.rank = 5;
    record.candidates.push(fifth);
    for candidate in &mut record.candidates {
        candidate.alternatives = vec![
            Alternative {
                linkage: candidate.linkage,
                crank_deg: candidate.crank_deg.clone(),
                t1_at: candidate.t1_at.to_vec(),
                linkage_type: candidate.linkage_type,
                accepted: false,
                sum_sq: candidate.error.sum_sq,
                transmission_worst_deg: 20.0,
                link_ratio: 3.0,
                not_met: vec!["type".into()],
            };
            2
        ];
        candidate.warnings = vec![Warning {
            kind: WarningKind::TransmissionAngle,
            text: "worst transmission angle 5 deg: it may jam under load".into(),
            key: "transmission_deg.worst".into(),
            value: 5.0,
            limit: 10.0,
        }];
        candidate.costs = vec![Cost {
            name: "link_ratio_max".into(),
            side: Some("max".into()),
            limit: 20.0,
            rms_per_unit: Some(-0.001),
            unit_of_limit: LimitUnit::Ratio,
            rms_without: Some(0.01),
        }];
    }
    record.certificate = Some(certificate());
    record.repeats = Some(Repeats::new(40, 6, 9).with_basins(34, 5));
    let mut buildable = record.candidates[1].clone();
    buildable.rank = 0;
    record.buildable = Some(buildable);
    record.family = Some(Family { dimension: 2, exact: true, text: "a family of exact answers".into() });
    record
}

fn with_exact(mut record: Record) -> Record {
    let best = record.candidates[0].clone();
    let linkage = ExactLinkage {
        rank: 1,
        linkage: best.linkage,
        crank_deg: best.crank_deg,
        t1_at: best.t1_at.to_vec(),
        miss: 1e-15,
        linkage_type: best.linkage_type,
        defects: vec![Defect::Order { at: vec![3] }],
        transmission_worst_deg: 20.0,
        link_ratio: 3.0,
        accepted: false,
        not_met: vec!["order".into(), "design.a".into()],
        one_circuit: true,
        in_order: false,
        free_of_defects: false,
        certified: Some(Certified { radius: 1e-14 }),
        others: Vec::new(),
    };
    record.exact = Some(ExactRecord {
        kind: LinkageKind::FourBar,
        poses: 0,
        pivots: 0,
        census: Census {
            tracked: 1442,
            finite: 1442,
            classes: 1442,
            real: 1,
            certified: 1442,
            ..Census::default()
        },
        generic: true,
        completeness: Completeness::Complete,
        linkages: vec![linkage],
    });
    record
}

/// Every text of a record that a file can hold, replaced.
fn named(mut record: Record, text: &str) -> Record {
    let name = || text.to_owned();
    record.problem.name = name();
    record.problem.source = Some(name());
    record.problem.digest = name();
    record.tool = Tool { name: name(), version: name() };
    record.method.used = vec![name()];
    record.family = record.family.map(|family| Family { text: name(), ..family });
    record.conflict = Some(Conflict { among: vec![name(), name()] });
    record.no_certificate = Some(name());
    if let Some(certificate) = &mut record.certificate {
        certificate.statement = name();
        certificate.covered = vec![name(), name()];
        certificate.not_covered = vec![name()];
        certificate.parts.iter_mut().for_each(|part| part.linkage_type = name());
    }
    let change = Change { key: name(), from: TypedValue::Word(name()), to: TypedValue::Words(vec![name()]) };
    record.relaxations = vec![Relaxation { set: vec![change], sum_sq: 1.0, rms: 0.2 }];
    for candidate in record.candidates.iter_mut().chain(&mut record.buildable) {
        candidate.warnings.iter_mut().for_each(|w| (w.text, w.key) = (name(), name()));
        candidate.alternatives.iter_mut().for_each(|a| a.not_met = vec![name(), name()]);
        let words = [Figure::Word(name()), Figure::Words(vec![name(), name()])];
        for (i, figure) in words.into_iter().enumerate() {
            let [value, limit] = [figure.clone(), figure];
            candidate.requirements.push(Requirement { name: name(), value, limit, met: i == 0 });
        }
        candidate.requirements.push(Requirement {
            name: format!("design.{text}"),
            value: Figure::Number(1.0),
            limit: Figure::Numbers(vec![0.0, 2.0]),
            met: true,
        });
        let cost = candidate.costs.first().cloned();
        candidate.costs.extend(cost.map(|cost| Cost { name: name(), side: Some(name()), ..cost }));
    }
    for linkage in record.exact.iter_mut().flat_map(|exact| &mut exact.linkages) {
        linkage.not_met = vec![name()];
    }
    record
}

/// The page's tags in their order, each with the names of its attributes: what a browser would build of it.
fn skeleton(page: &str) -> Vec<String> {
    let mut tags = Vec::new();
    let mut rest = page;
    while let Some(at) = rest.find('<') {
        rest = &rest[at..];
        let word: String = rest[1..].chars().take_while(|c| !c.is_whitespace() && *c != '>').collect();
        if word.is_empty() || !word.starts_with(|c: char| c.is_ascii_alphabetic() || "/!".contains(c)) {
            panic!("a bare < in {}", rest.chars().take(60).collect::<String>());
        }
        let mut tag = word.clone();
        let mut quoted = false;
        let mut length = 0;
        let mut name = String::new();
        for c in rest.chars() {
            length += c.len_utf8();
            match c {
                '"' => quoted = !quoted,
                '>' if !quoted => break,
                '=' if !quoted => tag.push_str(&format!(" {}", std::mem::take(&mut name))),
                c if !quoted && c.is_whitespace() => name.clear(),
                c if !quoted => name.push(c),
                _ => {}
            }
        }
        rest = &rest[length..];
        tags.push(tag);
        // What stands in a script or a style is no markup, up to its end.
        for raw in ["script", "style"] {
            if word == raw {
                rest = &rest[rest.find(&format!("</{raw}")).expect("an end")..];
            }
        }
    }
    tags
}

fn data_of(page: &str) -> serde_json::Value {
    let start = page.find("id=\"data\">").expect("data") + "id=\"data\">".len();
    let end = start + page[start..].find("</script>").expect("an end");
    serde_json::from_str(&page[start..end]).expect("JSON")
}

#[test]
fn five_candidates_take_less_than_500_kb() {
    let page = report_html(&with_exact(five()), 0);
    assert!(page.len() < 500_000, "{}", page.len());
    // Also where the target has more points than a drawing can show.
    let rocker = linkage([10.0, 20.0], [90.0, 30.0], [25.0, 70.0, 55.0, 60.0, 65.0], 1, 1);
    let angles: Vec<f64> = (0..5000).map(|i| 0.3 + f64::from(i) / 5000.0 * 6.2).collect();
    let points: Vec<[f64; 2]> = angles
        .iter()
        .map(|a| rocker.position(*a).joints().expect("closed").coupler_point)
        .map(|p| [p.re, p.im + 0.01])
        .collect();
    let mut many = record("five thousand points", path(&points, true));
    let task = many.problem.resolved.task.to_task().expect("a task");
    let t1 = vec![AssemblyMode::Plus; angles.len()];
    many.candidates = (1..=5).map(|rank| candidate(rank, rocker, &task, &angles, &t1)).collect();
    let page = report_html(&many, 0);
    assert!(page.len() < 500_000, "{}", page.len());
    assert!(page.contains("of the 5000 points"), "it says what it leaves out");
    let data = data_of(&page);
    let numbers = data["target"]["numbers"].as_array().expect("numbers");
    assert!(
        numbers.contains(&serde_json::json!(many.candidates[0].error.max_at)),
        "the worst point is there"
    );
}

#[test]
fn a_page_names_nothing_outside_of_itself() {
    for record in [with_exact(five()), rocking(), shapes(), detail(), ellipse()] {
        let page = report_html(&record, 0);
        // Types in the script's comments name modules.
        let told = |line: &&str| !["*", "/**"].iter().any(|start| line.trim_start().starts_with(start));
        let code = page.lines().filter(told).collect::<Vec<_>>().join("\n");
        for outside in
            ["src=", "@import", "url(h", "fetch(", "XMLHttpRequest", "WebSocket", "import(", "<link", "<base"]
        {
            assert!(!code.contains(outside), "{outside}");
        }
        for (at, _) in page.match_indices("href=") {
            assert!(page[at..].starts_with("href=\"#"), "{}", &page[at..at + 40]);
        }
        // The one address is the name of a language, which nothing fetches.
        assert_eq!(page.matches("http://").count() + page.matches("https://").count(), 1);
        assert!(page.contains("http://www.w3.org/2000/svg"));
    }
}

#[test]
fn the_same_record_gives_the_same_bytes() {
    let record = with_exact(five());
    let page = report_html(&record, 0);
    let text = serde_json::to_string(&record).expect("JSON");
    assert_eq!(page, report_html(&serde_json::from_str(&text).expect("a record"), 0));
    let is_report = |bytes: &[u8]| FileKind::Html.is_written_by_us(bytes, b"");
    assert!(is_report(page.as_bytes()) && !is_report(b"<!doctype html>\n<html><head>"));
}

#[test]
fn no_text_of_a_record_becomes_markup_or_script() {
    let plain = skeleton(&report_html(&named(with_exact(five()), "plain"), 0));
    assert_eq!(plain.iter().filter(|tag| tag.starts_with("script")).count(), 2);
    assert!(plain.len() > 500 && !plain.iter().any(|tag| tag.starts_with("img")));
    for hostile in [
        "</script><script>alert(1)</script>",
        "\"><img src=x onerror=alert(1)>",
        "'><svg onload=alert(1)>",
        "</style><style>*{display:none}",
        "</title><script>alert(1)</script>",
        "</pre></article></main><iframe srcdoc='<script>alert(1)</script>'>",
        "<!--<script>",
        "]]><x/>",
        "{{7*7}}${alert(1)}`",
        "javascript:alert(1)",
        "&lt;script&gt;alert(1)&lt;/script&gt;",
        "\u{2028}\u{0}\u{202e}<img>",
    ] {
        let page = report_html(&named(with_exact(five()), hostile), 0);
        assert_eq!(skeleton(&page), plain, "{hostile}");
        let data =
            page.split("id=\"data\">").nth(1).expect("data").split("</script>").next().expect("its end");
        assert!(!data.contains('<'), "{hostile}");
        data_of(&page);
    }
}

#[test]
fn a_proof_is_told_with_what_it_covers_and_how_often_the_best_came_back() {
    let mut record = five();
    let page = report_html(&record, 0);
    for said in [
        "<p class=\"lead good\">Proved optimum: no linkage that the proof covers is better by more than 0.0099 %.</p>",
        "Can it be better?",
        "below 9.028e-3",
        "Covered: crank-rockers and double-cranks; both assemblies.",
        "Not covered: linkages whose input rocks.",
        "crank-rocker, crank as prescribed: no sum below 0.009028000000, 1,200,000 boxes",
        "double-crank, crank the other way",
        "from 6 of 40 independent starts (3 more",
        "a better one has not been seen is 0.15",
    ] {
        assert!(page.contains(said), "{said}");
    }
    // Not to its end: what is proved is not called an optimum.
    if let Some(certificate) = &mut record.certificate {
        (certificate.closed, certificate.gap) = (false, 0.31);
    }
    let page = report_html(&record, 0);
    assert!(
        page.contains("Proved so far: no linkage that the proof covers is better by more than 31 %")
            && !page.contains("Proved optimum")
    );
    record.certificate = None;
    record.no_certificate = Some("no certificate is available for free timing".into());
    let page = report_html(&record, 0);
    assert!(page.contains("<p>No certificate is available for free timing.</p>") && !page.contains("Proved"));
    assert!(!report_html(&k18(), 0).contains("id=\"proof\""));
}

#[test]
fn what_it_takes_to_build_the_best_and_the_buildable_one_is_told() {
    let record = five();
    let page = report_html(&record, 0);
    let section =
        page.split("id=\"build\"").nth(1).expect("a section").split("</section>").next().expect("its end");
    for said in [
        "To build it",
        "<h3>Candidate 1</h3>",
        "<h3>The buildable answer</h3>",
        "over the full turn of the crank.",
        "layers, from below: ",
        "can share a plane",
        "Held by a link: A-C 0.3127",
        "<th scope=\"row\">B-P</th>",
        "The worst dimension is ",
        "What an error of each dimension does",
        "linkwright build RESULT",
    ] {
        assert!(section.contains(said), "{said}: {section}");
    }
    // The figures are those of `build`.
    let problem = Problem::new(record.problem.resolved.clone()).expect("a problem");
    let best = &record.candidates[0];
    let hole = Build::usual_hole(best.linkage.four_bar().expect("a four-bar"), record.problem.unit);
    let found = Practicality::of_candidate(&problem, best, Build::new(hole, hole)).expect("it can be joined");
    let felt = found.sensitivity.expect("it has derivatives");
    assert!(section.contains(&format!("The worst dimension is {}.", felt.worst_dimension().name)));
    let distances = found.distances.expect("it closes");
    let nearest = distances.iter().find(|d| !d.fixed).expect("one that changes");
    assert!(section.contains(&linkwright::internals::report::text::significant(nearest.closest.value, 4)));
    // One job of many leaves it to `report`.
    let brief = report_with_drawings(&record, 0, &[], Extent::Brief);
    assert!(
        brief.contains("linkwright report RESULT writes this page anew") && !brief.contains("from below")
    );
    let mut nothing = record;
    nothing.candidates.clear();
    nothing.buildable = None;
    assert!(!report_html(&nothing, 0).contains("id=\"build\""));
}

#[test]
fn the_player_gets_every_digit_of_every_mechanism() {
    let record = with_exact(five());
    let data = data_of(&report_html(&record, 2));
    assert_eq!(data["first"], "c3");
    let mechanisms = data["mechanisms"].as_array().expect("a list");
    let keys: Vec<&str> = mechanisms.iter().map(|m| m["key"].as_str().expect("a key")).collect();
    assert_eq!(keys.len(), 5 * 3 + 1 + 1);
    assert!(keys.starts_with(&["c1", "c1a1", "c1a2", "c2"]) && keys.ends_with(&["b", "x1"]), "{keys:?}");
    let first: linkwright::internals::mechanism::FourBar =
        serde_json::from_value(mechanisms[0]["linkage"].clone()).expect("a linkage");
    assert_eq!(&first, record.candidates[0].linkage.four_bar().expect("a four-bar"));
    let angles: Vec<f64> = serde_json::from_value(mechanisms[0]["crank_deg"].clone()).expect("angles");
    assert_eq!(angles, record.candidates[0].crank_deg);
}

#[test]
fn a_motion_is_driven_as_its_linkage_can_move() {
    let kind = |record: &Record, i: usize| {
        data_of(&report_html(record, 0))["mechanisms"][i]["drive"]["kind"].clone()
    };
    assert_eq!(kind(&k18(), 0), "turn");
    assert_eq!(kind(&rocking(), 0), "through", "it passes a toggle");
    let mut one_branch = rocking();
    one_branch.candidates[0].t1_at = vec![AssemblyMode::Plus; 3].into();
    assert_eq!(kind(&one_branch, 0), "rock");
    let mut apart = k18();
    apart.candidates[0].linkage = linkage([0.0, 0.0], [10.0, 0.0], [1.0, 1.0, 1.0, 1.0, 1.0], 1, 1).into();
    assert_eq!(kind(&apart, 0), "none");
}

#[test]
fn the_page_says_in_words_what_the_record_holds() {
    let page = report_html(&with_exact(five()), 0);
    for said in [
        "eighteen-point",
        "Kunjur &amp; Krishnamurty, 1997",
        "18 points, size 1.082 m, prescribed timing, offset free, closed",
        "Crank-rocker: the crank turns fully, the follower rocks",
        "No defect: the points are passed in order",
        "Not accepted: worst transmission angle 39.777°, at least 45° asked.",
        "costs 0.012 m of rms; 1 more than 20.00 gives back 0.0010 m",
        "it may jam under load",
        "cognate 2",
        "a = 0.31274881685597095",
        "linkwright synth eighteen-point.toml --method auto --seed 1",
        "as many as nine points in general position have",
        "The buildable answer",
    ] {
        assert!(page.contains(said), "{said}");
    }
    let mut empty = k18();
    empty.candidates.clear();
    let page = report_html(&empty, 0);
    assert!(page.contains("No linkage was found.") && page.contains("<svg") && !page.contains("id=\"live\""));
}

#[test]
fn a_result_holds_a_report_and_the_command_writes_the_same_one() {
    let folder = TempDir::new().expect("a folder");
    quick_result(folder.path());
    let place = folder.path().join("r/report.html");
    let written = fs::read_to_string(&place).expect("it is there");
    fs::remove_file(&place).expect("it can be removed");
    let said = linkwright(folder.path(), &["report", "r"]);
    assert_eq!((said.code, said.stdout.as_str(), said.stderr.as_str()), (0, "r/report.html\n", ""));
    assert_eq!(fs::read_to_string(&place).expect("it is there"), written);
    assert_eq!(linkwright(folder.path(), &["report", "r"]).code, 0, "its own report is replaced");
    // From a record alone, under another name, and with another candidate first.
    fs::copy(folder.path().join("r/record.json"), folder.path().join("mailed.json"))
        .expect("it can be copied");
    let said = linkwright(folder.path(), &["report", "mailed.json"]);
    assert_eq!((said.code, said.stdout.as_str()), (0, "mailed.html\n"));
    assert_eq!(fs::read_to_string(folder.path().join("mailed.html")).expect("it is there"), written);
    let said = linkwright(folder.path(), &["report", "r:1", "--out", "first.html"]);
    assert_eq!((said.code, said.stdout.as_str()), (0, "first.html\n"));
    let said = linkwright(folder.path(), &["report", "r:99"]);
    assert_eq!(said.code, 2, "{}", said.stderr);
}

#[test]
fn a_record_that_is_not_true_gets_no_report_and_foreign_pages_stay() {
    let folder = TempDir::new().expect("a folder");
    quick_result(folder.path());
    let place = folder.path().join("r/record.json");
    let mut record: Record =
        serde_json::from_slice(&fs::read(&place).expect("it is there")).expect("a record");
    fs::write(folder.path().join("mine.html"), "<!doctype html><p>mine").expect("it can be written");
    fs::copy(&place, folder.path().join("mine.json")).expect("it can be copied");
    let said = linkwright(folder.path(), &["report", "mine.json"]);
    assert_eq!(said.code, 2);
    assert!(
        said.stderr.contains("mine.html is there and is not an HTML page that linkwright wrote"),
        "{}",
        said.stderr
    );
    assert!(said.stderr.contains("--force"), "{}", said.stderr);
    record.candidates[0].error.rms *= 0.5;
    fs::write(folder.path().join("false.json"), serde_json::to_vec(&record).expect("JSON")).expect("written");
    let said = linkwright(folder.path(), &["report", "false.json"]);
    assert_eq!(said.code, 1);
    assert!(
        said.stderr.contains("this record is not true") && said.stderr.contains("rms"),
        "{}",
        said.stderr
    );
    assert!(!folder.path().join("false.html").exists());
    let said = linkwright(folder.path(), &["report", &shipped("linkages/hoeken.toml")]);
    assert_eq!(said.code, 2);
}

/// What hostile texts may look like, all in one.
const HOSTILE: &str =
    "</script><script>alert(1)</script>\"><img src=x onerror=alert(2)>'<svg onload=alert(3)>";

#[test]
fn pages_for_the_test_in_a_browser_are_written() {
    // `LINKWRIGHT_WRITE_PAGES=DIR cargo test --test tool pages_for` keeps them, for .ci/check-report.
    let temporary = TempDir::new().expect("a folder");
    let place = std::env::var_os("LINKWRIGHT_WRITE_PAGES").map_or(temporary.path().to_owned(), Into::into);
    let mut one_branch = rocking();
    one_branch.candidates[0].t1_at = vec![AssemblyMode::Plus; 3].into();
    let mut apart = k18();
    apart.candidates.truncate(1);
    apart.candidates[0].linkage = linkage([0.0, 0.0], [10.0, 0.0], [1.0, 1.0, 1.0, 1.0, 1.0], 1, 1).into();
    let mut empty = k18();
    empty.candidates.clear();
    let records = [
        ("five", with_exact(five())),
        ("hostile", named(with_exact(five()), HOSTILE)),
        ("through", rocking()),
        ("rock", one_branch),
        ("points", shapes()),
        ("small", detail()),
        ("ellipse", ellipse()),
        ("apart", apart),
        ("empty", empty),
    ];
    for (name, record) in records {
        let page = report_html(&record, 0);
        assert!(FileKind::Html.is_written_by_us(page.as_bytes(), b""));
        fs::write(place.join(name).with_extension("html"), page).expect("it can be written");
    }
}

#[test]
fn the_commands_of_a_page_name_the_folder_that_a_run_writes() {
    let mut record = k18();
    assert!(report_html(&record, 0).contains("linkwright verify results/eighteen-point\n"));
    record.problem.name = "my path".to_owned();
    let page = report_html(&record, 0);
    assert!(page.contains("linkwright synth &quot;my path.toml&quot; --method "), "{page}");
    assert!(page.contains("linkwright verify &quot;results/my path&quot;\n"), "{page}");
}

#[test]
fn a_page_has_one_verdict_on_a_transmission_angle() {
    use linkwright::internals::judge::warnings::warnings;
    use linkwright::internals::mechanism::four_bar::transmission::ForceTransmission;
    use linkwright::internals::task::Problem;
    let words = [
        ForceTransmission::Good,
        ForceTransmission::Fair,
        ForceTransmission::Poor,
        ForceTransmission::MayJamUnderLoad,
        ForceTransmission::Jams,
    ]
    .map(ForceTransmission::words);
    // At each limit a miss by rounding is none.
    for (worst, verdict) in
        [(50.0, 0), (40.0 - 1e-7, 0), (35.0, 1), (20.0, 2), (10.0 - 1e-7, 2), (5.0, 3), (1.0, 4), (0.0, 4)]
    {
        let mut record = k18();
        record.candidates.truncate(1);
        let problem = Problem::new(record.problem.resolved.clone()).expect("a problem");
        let candidate = &mut record.candidates[0];
        candidate.transmission_deg.worst = worst;
        candidate.warnings = warnings(&problem, candidate);
        let page = report_html(&record, 0);
        for (i, words) in words.iter().enumerate() {
            // "it will jam" is not a part of the others.
            assert_eq!(page.contains(words), i == verdict, "{worst}: {words}");
        }
    }
}
