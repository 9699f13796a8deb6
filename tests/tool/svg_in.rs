//! Targets from drawings: each element with a known geometry, transforms composed by hand, hostile text.

use linkwright::internals::files::diagnostic::Diagnostic;
use linkwright::internals::files::svg_file::{SvgOptions, SvgTarget, parse};
use linkwright::internals::mechanism::Unit;
use proptest::prelude::*;
use std::f64::consts::{PI, SQRT_2, TAU};

fn read(svg: &str, options: SvgOptions<'_>) -> Result<SvgTarget, Box<Diagnostic>> {
    parse("d.svg", svg, &options)
}

/// The points of a drawing with this content.
#[track_caller]
fn target(content: &str, samples: usize) -> SvgTarget {
    inside("", content, SvgOptions { samples, ..SvgOptions::default() })
}

#[track_caller]
fn inside(attributes: &str, content: &str, options: SvgOptions<'_>) -> SvgTarget {
    let xlink = "xmlns:xlink='http://www.w3.org/1999/xlink'";
    let svg = format!("<svg xmlns='http://www.w3.org/2000/svg' {xlink} {attributes}>{content}</svg>");
    read(&svg, options).unwrap_or_else(|d| panic!("{d}"))
}

#[track_caller]
fn refusal(content: &str, id: Option<&str>) -> Box<Diagnostic> {
    let svg = format!("<svg xmlns='http://www.w3.org/2000/svg'>{content}</svg>");
    read(&svg, SvgOptions { id, ..SvgOptions::default() }).unwrap_err()
}

#[track_caller]
fn near(found: &[[f64; 2]], expected: &[[f64; 2]], within: f64) {
    assert_eq!(found.len(), expected.len());
    for (f, e) in found.iter().zip(expected) {
        assert!((f[0] - e[0]).hypot(f[1] - e[1]) <= within, "{found:?}\n{expected:?}");
    }
}

/// The complete elliptic integral by the arithmetic-geometric mean: the circumference of an ellipse.
fn circumference(a: f64, b: f64) -> f64 {
    let (mut x, mut y, mut power, mut sum) = (a, b, 0.5, 0.5 * (a * a - b * b));
    for _ in 0..20 {
        let (next, mean) = (0.5 * (x + y), (x * y).sqrt());
        power *= 2.0;
        sum += power * (0.5 * (x - y)).powi(2);
        (x, y) = (next, mean);
    }
    TAU / x * (a * a - sum)
}

#[test]
fn each_element_has_its_length_and_its_points() {
    let open = target("<line x1='1' y1='2' x2='4' y2='6'/>", 3);
    near(&open.points, &[[1.0, -2.0], [2.5, -4.0], [4.0, -6.0]], 1e-15 * 10.0);
    assert!((open.length - 5.0).abs() < 1e-14 && !open.closed);
    let polyline = target("<polyline points='0,0 3,0 3,4'/>", 8);
    near(&polyline.points[3..5], &[[3.0, 0.0], [3.0, -1.0]], 1e-14);
    assert!(!polyline.closed);
    let polygon = target("<polygon points='0 0 3 0 3-4'/>", 12);
    assert!(polygon.closed && (polygon.length - 12.0).abs() < 1e-13);
    near(&polygon.points[7..9], &[[3.0, 4.0], [2.4, 3.2]], 1e-13);
    let circle = target("<circle cx='5' cy='-1' r='2'/>", 4);
    near(&circle.points, &[[7.0, 1.0], [5.0, -1.0], [3.0, 1.0], [5.0, 3.0]], 1e-9);
    assert!(circle.closed && (circle.length - 2.0 * TAU).abs() < 1e-8);
    let ellipse = target("<ellipse rx='5' ry='2'/>", 4);
    near(&ellipse.points, &[[5.0, 0.0], [0.0, -2.0], [-5.0, 0.0], [0.0, 2.0]], 1e-8);
    assert!((ellipse.length - circumference(5.0, 2.0)).abs() < 1e-8, "{}", ellipse.length);
    let rect = target("<rect x='1' y='1' width='4' height='2'/>", 12);
    near(&rect.points[3..6], &[[4.0, -1.0], [5.0, -1.0], [5.0, -2.0]], 1e-14 * 10.0);
    let round = target("<rect width='10' height='6' rx='2'/>", 60);
    assert!(round.closed && (round.length - (12.0 + 4.0 + 2.0 * TAU)).abs() < 1e-8, "{}", round.length);
}

#[test]
fn path_data_draws_what_the_standard_says() {
    // Relative and absolute, short forms, numbers that run together.
    let path = target("<path d='m1,1h2v2H1z'/>", 8);
    assert!(path.closed && (path.length - 8.0).abs() < 1e-14);
    near(&path.points[2..4], &[[3.0, -1.0], [3.0, -2.0]], 1e-14);
    let same = target("<path d='M1 1L3 1 3 3 1 3Z'/>", 8);
    near(&same.points, &path.points, 1e-14);
    // A parabola, as a quadratic and with its end mirrored: y = x^2 / 4 from -2 to 2 has this length.
    let parabola = SQRT_2 * 2.0 + 2.0 * 1f64.asinh();
    for d in [
        "M-2 1Q0-1 2 1",
        "M-2 1C-.6666666666666666-.3333333333333333 .6666666666666666-.3333333333333333 2 1",
    ] {
        let found = target(&format!("<path d='{d}'/>"), 3);
        assert!((found.length - parabola).abs() < 1e-8, "{d} {}", found.length);
        near(&found.points, &[[-2.0, -1.0], [0.0, 0.0], [2.0, -1.0]], 1e-8);
    }
    let waves = target("<path d='M0 0q1-2 2 0t2 0t2 0'/>", 4);
    near(&waves.points, &[[0.0, 0.0], [2.0, 0.0], [4.0, 0.0], [6.0, 0.0]], 1e-7);
    let smooth = target("<path d='M0 0c0-1 2-1 2 0s2 1 2 0'/>", 3);
    near(&smooth.points, &[[0.0, 0.0], [2.0, 0.0], [4.0, 0.0]], 1e-7);
}

#[test]
fn arcs_are_arcs_at_every_scale() {
    for scale in [1e-9, 1e-3, 1.0, 1e6] {
        let [r, twice] = [3.0 * scale, 6.0 * scale];
        for (flags, part) in [("0 0", 0.5), ("0 1", 0.5), ("1 0", 0.5)] {
            let half = target(&format!("<path d='M0 0A{r} {r} 0 {flags} {twice} 0'/>"), 3);
            assert!((half.length - part * TAU * r).abs() < 1e-8 * r, "{scale} {flags} {}", half.length);
        }
        let large = target(&format!("<path d='M0 0A{r} {r} 0 1 1 {r} {r}'/>"), 3);
        assert!((large.length - 0.75 * TAU * r).abs() < 1e-8 * r);
        let small = target(&format!("<path d='M0 0A{r} {r} 0 0 1 {r} {r}'/>"), 3);
        assert!((small.length - 0.25 * TAU * r).abs() < 1e-8 * r);
        // Sweep 1 turns clockwise with y down: from (0, 0) over the right.
        near(&small.points[1..2], &[[r / SQRT_2, -r * (1.0 - 1.0 / SQRT_2)]], 1e-8 * r);
        // Radii that cannot reach are scaled up: half an ellipse of that shape.
        let scaled = target(&format!("<path d='M0 0A{} {} 0 0 1 {twice} 0'/>", 1e-4 * r, 5e-5 * r), 3);
        assert!((scaled.length - 0.5 * circumference(r, 0.5 * r)).abs() < 1e-8 * r);
    }
    let turned = target("<path d='M0 0A4 2 90 0 1 4 0'/>", 3);
    near(&turned.points[1..2], &[[2.0, 4.0]], 1e-8);
    assert!(
        (target("<path d='M0 0A0 2 0 0 1 4 0'/>", 2).length - 4.0).abs() < 1e-14,
        "a line without a radius"
    );
}

#[test]
fn transforms_are_composed_from_the_outside_in() {
    let line = |group: &str, own: &str| {
        target(&format!("<g transform='{group}'><g><line x1='1' y1='0' x2='2' y2='0' {own}/></g></g>"), 2)
            .points
    };
    near(&line("translate(10 20) rotate(90)", ""), &[[10.0, -21.0], [10.0, -22.0]], 1e-14 * 40.0);
    near(
        &line("rotate(90)", "transform='translate(10,20)'"),
        &[[-20.0, -11.0], [-20.0, -12.0]],
        1e-14 * 40.0,
    );
    near(&line("rotate(180 1 1)", "transform='scale(2 3)'"), &[[0.0, -2.0], [-2.0, -2.0]], 1e-14 * 10.0);
    near(&line("matrix(1 2 3 4 5 6)", ""), &[[6.0, -8.0], [7.0, -10.0]], 1e-14 * 10.0);
    near(&line("skewX(45)", "transform='skewY(45)'"), &[[2.0, -1.0], [4.0, -2.0]], 1e-14 * 10.0);
    // A circle that is squeezed is an ellipse, evenly sampled as that.
    let squeezed = target("<g transform='scale(5 2)'><circle r='1'/></g>", 4);
    assert!((squeezed.length - circumference(5.0, 2.0)).abs() < 1e-8);
}

#[test]
fn uses_symbols_and_nested_drawings_are_followed() {
    let content = "<defs><g id='g' transform='scale(2)'><line id='l' x1='1' x2='2'/></g></defs>\
                   <use xlink:href='#g' x='10' y='1' transform='scale(3)'/>";
    near(&target(content, 2).points, &[[36.0, -3.0], [42.0, -3.0]], 1e-14 * 50.0);
    let symbol = "<symbol id='s' viewBox='0 0 10 10'><line x2='10'/></symbol>\
                  <use href='#s' x='1' width='30' height='20'/>";
    // 30 x 20 holds 10 x 10 twice as large, in the middle.
    near(&target(symbol, 2).points, &[[6.0, 0.0], [26.0, 0.0]], 1e-14 * 50.0);
    let nested = "<svg x='5' y='5' width='20' height='20' viewBox='0 0 10 10'><line id='n' x2='10'/></svg>";
    near(&target(nested, 2).points, &[[5.0, -5.0], [25.0, -5.0]], 1e-14 * 50.0);
    let named = inside("", nested, SvgOptions { id: Some("n"), samples: 2, ..SvgOptions::default() });
    near(&named.points, &target(nested, 2).points, 0.0);
    assert!(refusal("<use id='u' href='#u'/>", None).message.contains("deep inside each other"));
    assert!(refusal("<use href='other.svg#x'/>", None).message.contains("which is not in the drawing"));
}

#[test]
fn bombs_of_uses_and_entities_are_refused() {
    let mut content = String::from("<defs><g id='g0'><path d='M0 0'/></g>");
    for i in 1..40 {
        let inner = i - 1;
        content += &format!("<g id='g{i}'><use href='#g{inner}'/><use href='#g{inner}'/></g>");
    }
    content += "</defs><use href='#g39'/>";
    assert!(refusal(&content, None).message.contains("more than 200000 elements"));
    let entities = "<!DOCTYPE svg [<!ENTITY a 'aaaa'><!ENTITY b '&a;&a;'>]><svg><path d='&b;'/></svg>";
    let refused = read(entities, SvgOptions::default()).unwrap_err();
    assert!(refused.message.contains("DOCTYPE"), "{refused}");
    for depth in [300, 1_000_000] {
        let deep = format!("<svg>{}{}</svg>", "<g>".repeat(depth), "</g>".repeat(depth));
        let message = read(&deep, SvgOptions::default()).unwrap_err().message;
        assert!(message.contains("deep inside") || message.contains("more than 200000"), "{message}");
    }
    let long = format!("<path d='M0 0{}'/>", "h1v1".repeat(60_000));
    assert!(refusal(&long, None).message.contains("more than 100000 segments"));
}

#[test]
fn physical_units_come_from_the_page() {
    let line = "<line x1='10' y1='10' x2='20' y2='10'/>";
    let read =
        |page: &str, unit| inside(page, line, SvgOptions { samples: 2, unit, ..SvgOptions::default() });
    let cases: [(&str, Option<Unit>, Option<Unit>, f64); 9] = [
        ("width='100mm' height='50mm' viewBox='0 0 200 100'", None, Some(Unit::Mm), 5.0),
        ("width='10cm' viewBox='0 0 200 100'", None, Some(Unit::Mm), 5.0),
        ("height='50mm' viewBox='0 0 200 100'", None, Some(Unit::Mm), 5.0),
        ("width='100mm' height='50mm' viewBox='0 0 200 100'", Some(Unit::Cm), Some(Unit::Cm), 0.5),
        ("width='100mm' height='50mm' viewBox='0 0 200 100'", Some(Unit::M), Some(Unit::M), 0.005),
        ("width='2in' viewBox='0 0 20 20'", Some(Unit::In), Some(Unit::In), 1.0),
        ("width='100mm'", None, Some(Unit::Mm), 254.0 / 96.0),
        ("width='100' height='50' viewBox='0 0 200 100'", None, None, 10.0),
        ("width='100%' height='100%'", Some(Unit::In), None, 10.0),
    ];
    for (page, asked, unit, length) in cases {
        let found = read(page, asked);
        assert_eq!(found.unit, unit, "{page}");
        assert!((found.length - length).abs() < 1e-12 * length, "{page}: {}", found.length);
    }
    // A viewBox of another shape stands in the middle, or is stretched.
    let middle = read("width='100mm' height='100mm' viewBox='0 0 200 100'", None);
    near(&middle.points, &[[5.0, -30.0], [10.0, -30.0]], 1e-12);
    let corner =
        read("width='100mm' height='100mm' viewBox='0 0 200 100' preserveAspectRatio='xMinYMax'", None);
    near(&corner.points, &[[5.0, -55.0], [10.0, -55.0]], 1e-12);
    let sliced =
        read("width='100mm' height='100mm' viewBox='0 0 200 100' preserveAspectRatio='xMinYMin slice'", None);
    near(&sliced.points, &[[10.0, -10.0], [20.0, -10.0]], 1e-12);
    let stretched =
        read("width='100mm' height='100mm' viewBox='0 0 200 100' preserveAspectRatio='none'", None);
    near(&stretched.points, &[[5.0, -10.0], [10.0, -10.0]], 1e-12);
}

#[test]
fn the_target_is_the_named_shape_or_the_first_curve() {
    let content = "<rect width='100' height='100'/><defs><circle r='9'/></defs><circle r='8' display='none'/>\
                   <path d=''/><g id='layer'><ellipse id='leg' rx='3' ry='3'/></g><circle r='5' id='foot'/>";
    let first = target(content, 12);
    assert!((first.length - 3.0 * TAU).abs() < 1e-7);
    let warning = first.warnings.first().expect("there are others").to_string();
    assert!(
        warning.contains("the target is the first, ellipse \"leg\"") && warning.contains("circle \"foot\""),
        "{warning}"
    );
    for (id, radius) in [("leg", 3.0), ("layer", 3.0), ("foot", 5.0)] {
        let named = inside("", content, SvgOptions { id: Some(id), ..SvgOptions::default() });
        assert!((named.length - radius * TAU).abs() < 1e-7 && named.warnings.is_empty(), "{id}");
    }
    let unknown = refusal(content, Some("fot"));
    assert_eq!(unknown.message, "no element of the drawing has the id \"fot\"");
    let help = unknown.help.unwrap();
    assert!(help.starts_with("did you mean \"foot\"? shapes: rect without id (line 1), circle"), "{help}");
    assert!(
        (target("<rect width='3' height='2'/>", 12).length - 10.0).abs() < 1e-12,
        "the only shape there is"
    );
}

#[test]
fn closed_is_what_is_drawn_unless_it_is_said() {
    let ring = "<path d='M0 0L4 0 4 3 0.00001 0.00001'/>";
    assert!(target(ring, 12).closed, "ends that meet");
    let open = "<path d='M0 0L4 0 4 3'/>";
    let asked = |content, closed, samples| {
        inside("", content, SvgOptions { closed, samples, ..SvgOptions::default() })
    };
    assert!(!asked(open, None, 8).closed);
    let closed = asked(open, Some(true), 12);
    assert!(closed.closed && (closed.length - 12.0).abs() < 1e-13);
    let cut = asked("<circle r='1'/>", Some(false), 5);
    assert!(!cut.closed && (cut.length - 2.0 * PI).abs() < 1e-8);
    near(&[cut.points[0]], &[cut.points[4]], 1e-9);
}

#[test]
fn a_title_and_a_byte_order_mark_do_no_harm() {
    let svg = "\u{feff}<?xml version='1.0'?>\r\n<!DOCTYPE svg PUBLIC '-//W3C//DTD SVG 1.1//EN' 'http://a/svg11.dtd'>\
               <!-- <path d='x'/> -->\r\n<svg xmlns='http://www.w3.org/2000/svg'>\
               <title>a</title><metadata/><path d='M0,0 L1,0'/></svg>";
    assert_eq!(read(svg, SvgOptions { samples: 2, ..SvgOptions::default() }).unwrap().points.len(), 2);
}

/// A curve of lines, quadratics, cubics and arcs.
fn commands() -> impl Strategy<Value = String> {
    let n = -20.0..20.0f64;
    let one = prop_oneof![
        (n.clone(), n.clone()).prop_map(|(x, y)| format!("L{x} {y}")),
        (n.clone(), n.clone(), n.clone(), n.clone()).prop_map(|(a, b, x, y)| format!("q{a} {b} {x} {y}")),
        (n.clone(), n.clone(), n.clone(), n.clone(), n.clone(), n.clone())
            .prop_map(|(a, b, c, d, x, y)| format!("C{a} {b} {c} {d} {x} {y}")),
        (0.5..9.0f64, 0.5..9.0f64, n.clone(), any::<bool>(), any::<bool>(), n.clone(), n.clone()).prop_map(
            |(rx, ry, turn, large, sweep, x, y)| {
                format!("a{rx} {ry} {turn} {} {} {x} {y}", u8::from(large), u8::from(sweep))
            }
        ),
    ];
    (prop::collection::vec(one, 1..6), any::<bool>())
        .prop_map(|(list, close)| format!("M1 2{}{}", list.join(""), if close { "z" } else { "" }))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, failure_persistence: None, ..ProptestConfig::default() })]

    /// Every step has the same arc length: the drawing is taken apart again into the steps' own pieces, each measured
    /// by how its chords add up when it is sampled ever more finely.
    #[test]
    fn samples_are_even_by_arc_length(d in commands(), count in 3usize..9) {
        let svg = format!("<svg><path d='{d}'/></svg>");
        // Steps of the coarse samples hold FINE steps of the fine ones: their chords add up to the arc.
        const FINE: usize = 3000;
        let coarse = read(&svg, SvgOptions { samples: count, closed: Some(false), ..SvgOptions::default() });
        let Ok(coarse) = coarse else { return Ok(()) };
        let total = (count - 1) * FINE + 1;
        let fine = read(&svg, SvgOptions { samples: total, closed: Some(false), ..SvgOptions::default() }).unwrap();
        for (i, point) in coarse.points.iter().enumerate() {
            let same = fine.points[i * FINE];
            prop_assert!((same[0] - point[0]).hypot(same[1] - point[1]) < 1e-6 * coarse.length);
        }
        let step = fine.length / (total - 1) as f64;
        let mut short = 0;
        for pair in fine.points.windows(2) {
            let chord = (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1]);
            // A chord is never longer than its arc; shorter only where the curve bends or has a corner.
            prop_assert!(chord < step + 1e-8 * fine.length, "{} {}", chord, step);
            short += usize::from(chord < step * (1.0 - 1e-4));
        }
        prop_assert!(short < total / 20, "{} of {} steps are short", short, total);
    }

    #[test]
    fn no_text_makes_the_reader_panic(text in ".{0,200}", d in "[MmLlHhVvCcSsQqTtAaZz0-9eE., -]{0,80}", t in "[a-zA-Z0-9(), .-]{0,40}") {
        let _ = read(&text, SvgOptions::default());
        let _ = read(&format!("<svg><g transform='{t}'><path d='{d}'/></g></svg>"), SvgOptions::default());
        let _ = read(&format!("<svg width='{t}' viewBox='{d}'><polygon points='{d}'/></svg>"), SvgOptions::default());
        let _ = read(&format!("<svg><path d='M0 0A{d}'/></svg>"), SvgOptions::default());
    }

    #[test]
    fn no_size_of_numbers_makes_it_panic(e in prop::array::uniform7(-330i32..330), flags in 0u8..4) {
        let n = e.map(|e| format!("1e{e}"));
        let arc = format!("M0 0A{} {} {} {} {} {} {}", n[0], n[1], n[2], flags & 1, flags >> 1, n[3], n[4]);
        for shape in [
            format!("<path d='{arc}'/>"),
            format!("<path d='M0 0C{} {} {} {} {} {}'/>", n[0], n[1], n[2], n[3], n[4], n[5]),
            format!("<ellipse cx='{}' rx='{}' ry='{}'/>", n[0], n[1], n[2]),
            format!("<rect x='{}' width='{}' height='{}' rx='{}'/>", n[0], n[1], n[2], n[3]),
        ] {
            let svg = format!("<svg width='{}mm' viewBox='0 0 {} 1'><g transform='scale({})'>{shape}</g></svg>", n[5], n[6], n[0]);
            if let Ok(read) = read(&svg, SvgOptions::default()) {
                prop_assert!(read.points.iter().flatten().all(|v| v.abs() <= 1e12) && read.length > 0.0);
            }
        }
    }
}
