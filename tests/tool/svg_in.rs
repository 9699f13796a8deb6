//! Targets from drawings: each element with a known geometry, transforms composed by hand, hostile text.

use linkwright::diagnostic::Diagnostic;
use linkwright::record::Unit;
use linkwright::svg_file::{SvgOptions, SvgTarget, parse};
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

fn read(svg: &str, options: SvgOptions<'_>) -> Result<SvgTarget, Box<Diagnostic>> {
    parse("d.svg", svg, &options)
}

fn target(content: &str, samples: usize) -> SvgTarget {
    let svg = format!("<svg xmlns='http://www.w3.org/2000/svg'>{content}</svg>");
    read(&svg, SvgOptions { samples, ..SvgOptions::default() }).unwrap_or_else(|d| panic!("{d}"))
}

#[track_caller]
fn near(found: &[[f64; 2]], expected: &[[f64; 2]], within: f64) {
    assert_eq!(found.len(), expected.len());
    for (f, e) in found.iter().zip(expected) {
        assert!((f[0] - e[0]).hypot(f[1] - e[1]) <= within, "{found:?}\n{expected:?}");
    }
}

#[test]
fn deep_elements_and_entities_are_refused() {
    let deep = format!("<svg>{}{}</svg>", "<g>".repeat(1_000_000), "</g>".repeat(1_000_000));
    assert!(read(&deep, SvgOptions::default()).unwrap_err().message.contains("deep"));
}
