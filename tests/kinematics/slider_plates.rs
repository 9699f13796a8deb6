//! Practicality of linkages with a slider: clearances against fine sweeps, sensitivities against linkages with errors.

use crate::thorough::cases;
use linkwright::internals::judge::practicality::clearance::{Workpieces, pivot_distances};
use linkwright::internals::judge::practicality::closest::{MARGIN, RELATIVE};
use linkwright::internals::judge::practicality::layers::{Layering, layering};
use linkwright::internals::judge::practicality::sensitivity::{Crank, along, sensitivity};
use linkwright::internals::judge::practicality::{Build, Closest, Joint, Sweep};
use linkwright::internals::mechanism::plates::Link;
use linkwright::internals::mechanism::{
    AssemblyMode, Complex, CrankLinkage, InvertedSliderCrank, InvertedSliderCrankParameters, LoopJoints,
    SliderCrank, SliderCrankParameters, SliderLinkage,
};
use linkwright::internals::numbers::arithmetic::streams::{stream, uniform};

/// Linkages of both kinds in turn whose crank turns fully.
fn linkages(seed: u64, count: u64) -> Vec<CrankLinkage> {
    let draw = |i: u64| -> CrankLinkage {
        let draws = &mut stream(seed, i);
        let assembly = AssemblyMode::of(uniform(draws, -1.0, 1.0));
        let (a, x, y) = (uniform(draws, 0.5, 2.0), uniform(draws, -4.0, 8.0), uniform(draws, 1.0, 4.0));
        let (h, pivot) = (uniform(draws, -1.5, 1.5), [uniform(draws, -1.0, 1.0), uniform(draws, -1.0, 1.0)]);
        let far = a + h.abs() + uniform(draws, 0.8, 4.0);
        if i.is_multiple_of(2) {
            let line_deg = uniform(draws, -180.0, 180.0);
            let across = Complex::from_polar(h, (line_deg + 90.0).to_radians());
            let line_point = [pivot[0] + across.re, pivot[1] + across.im];
            let (crank, coupler) = (a, far);
            let p = SliderCrankParameters {
                crank_pivot: pivot,
                crank,
                coupler,
                line_point,
                line_deg,
                coupler_x: x,
                coupler_y: y,
                assembly,
            };
            SliderCrank::new(p).expect("lengths").into()
        } else {
            let turn = uniform(draws, -3.0, 3.0);
            let block_pivot = [pivot[0] + far * turn.cos(), pivot[1] + far * turn.sin()];
            let p = InvertedSliderCrankParameters {
                crank_pivot: pivot,
                block_pivot,
                crank: a,
                offset: h,
                coupler_x: x,
                coupler_y: y,
                assembly,
            };
            InvertedSliderCrank::new(p).expect("lengths").into()
        }
    };
    (0..count).map(draw).collect()
}

/// Positions of the first stretch of a motion, `n` steps and its ends.
pub fn positions(sweep: &Sweep, n: u32) -> Vec<LoopJoints> {
    let stretch = sweep.stretches[0];
    let angle = |i| stretch.from + (stretch.to - stretch.from) * f64::from(i) / f64::from(n);
    (0..=n).map(|i| sweep.linkage.joints_with(angle(i), stretch.assembly).expect("it closes")).collect()
}

/// Returns the layering of a linkage with holes of the usual size, whose distances are checked: none is below its bound, and each
/// is near the least of a fine sweep.
pub fn layered(label: usize, sweep: &Sweep) -> Layering {
    let hole = Build::usual_hole_of(sweep, None).expect("there is room");
    let build = Build::new(hole, hole);
    let found = layering(sweep, &build).expect("it closes");
    let pieces = Workpieces::new(sweep, &build).expect("it closes");
    let positions = positions(sweep, 2000);
    let size = sweep.linkage.longest_link();
    let check = |what: &str, closest: &Closest, of: &dyn Fn(&LoopJoints) -> f64| {
        let sampled = positions.iter().map(of).fold(f64::INFINITY, f64::min);
        let margin = (MARGIN * size).max(RELATIVE * closest.value.abs()) + 1e-9 * size;
        assert!(closest.bound <= sampled + 1e-9 * size, "{label} {what}: {closest:?}, sampled {sampled}");
        assert!(closest.value <= sampled + margin, "{label} {what}: {closest:?}, sampled {sampled}");
        assert!(closest.value - closest.bound <= 1.01 * margin, "{label} {what}: {closest:?}");
    };
    for pair in &found.free_pairs {
        let [one, other] = pair.plates;
        check("plates", &pair.closest, &|at| pieces.between_plates_at(one, other, at));
    }
    for p in &found.pins_plates {
        check("pin and plate", &p.closest, &|at| pieces.pin_to_plate_at(p.pin, p.plate, at));
    }
    found
}

#[test]
fn distances_of_sliders_are_bounded_and_near_the_least_of_a_fine_sweep() {
    let (mut stacked, wanted) = (0, cases(16, 40));
    for (i, linkage) in linkages(51, wanted).into_iter().enumerate() {
        let sweep = Sweep::of_linkage(linkage).expect("joined");
        let found = layered(i, &sweep);
        for distance in pivot_distances(&sweep).expect("it closes") {
            assert!(distance.closest.value >= 0.0);
        }
        assert_eq!(found.links[3], Link::Block);
        if let Some(stack) = &found.stack {
            stacked += 1;
            // The block lies beside the plate that it runs in, with its pins through no other plate without room.
            let layer =
                |link: Link| stack.layers.iter().position(|all| all.contains(&link)).expect("a layer");
            for pin in &found.all_pins {
                assert_ne!(layer(pin.joins[0]), layer(pin.joins[1]), "{i}: {pin:?}");
            }
        }
    }
    assert!(4 * stacked > 3 * wanted, "{stacked} of {wanted} can be stacked");
}

#[test]
fn least_distances_of_a_slider_crank_are_those_of_its_closed_forms() {
    for linkage in linkages(52, 20).into_iter().step_by(2) {
        let slider = *linkage.slider_crank().expect("one of them");
        let sweep = Sweep::of_linkage(linkage).expect("joined");
        let found = pivot_distances(&sweep).expect("it closes");
        let of = |between: [&str; 2]| found.iter().find(|d| d.between == between).expect("both are joints");
        assert_eq!(found.len(), 6);
        assert!(of(["A", "C"]).fixed && of(["C", "D"]).fixed && !of(["A", "D"]).fixed);
        let (a, b) = (SliderLinkage::crank(&slider), slider.coupler());
        // D is nearest where the crank lies over the coupler.
        let (near, least) = (of(["A", "D"]).closest.value, b - a);
        let margin = (MARGIN * linkage.longest_link()).max(RELATIVE * least) + 1e-9 * b;
        assert!((least - 1e-9 * b..=least + margin).contains(&near), "{near} instead of {least}");
        assert!((of(["A", "C"]).closest.value - a).abs() < 1e-9 * a);
    }
}

/// The slider-crank with errors of its eight dimensions; the rail moves at two places of D.
fn slider_crank_with(l: &SliderCrank, [low, high]: [f64; 2], e: &[f64]) -> CrankLinkage {
    let p = l.parameters();
    let (line, across) = (l.line_direction(), l.line_direction() * Complex::i());
    let from = l.line_point() + line * low + across * e[4];
    let to = l.line_point() + line * high + across * e[5];
    let turned = (to - from).arg();
    // From either end, so that a place far from Q stays as exact.
    let line_point = from - Complex::from_polar(low, turned);
    SliderCrank::new(SliderCrankParameters {
        crank_pivot: [p.crank_pivot[0] + e[0], p.crank_pivot[1] + e[1]],
        crank: p.crank + e[2],
        coupler: p.coupler + e[3],
        line_point: [line_point.re, line_point.im],
        line_deg: turned.to_degrees(),
        coupler_x: p.coupler_x + e[6],
        coupler_y: p.coupler_y + e[7],
        assembly: p.assembly,
    })
    .expect("lengths")
    .into()
}

/// The inverted slider-crank with errors of its eight dimensions.
fn inverted_with(l: &InvertedSliderCrank, e: &[f64]) -> CrankLinkage {
    let p = l.parameters();
    InvertedSliderCrank::new(InvertedSliderCrankParameters {
        crank_pivot: [p.crank_pivot[0] + e[0], p.crank_pivot[1] + e[1]],
        block_pivot: [p.block_pivot[0] + e[2], p.block_pivot[1] + e[3]],
        crank: p.crank + e[4],
        offset: p.offset + e[5],
        coupler_x: p.coupler_x + e[6],
        coupler_y: p.coupler_y + e[7],
        assembly: p.assembly,
    })
    .expect("lengths")
    .into()
}

#[test]
fn a_dimension_of_a_slider_shifts_the_path_as_a_linkage_with_that_error() {
    for (i, linkage) in linkages(53, 30).into_iter().enumerate() {
        let sweep = Sweep::of_linkage(linkage).expect("joined");
        let at = along(&sweep, 14);
        let place = |l: &CrankLinkage, k: usize| {
            l.joints_with(at[k].crank_angle, at[k].assembly).expect("it closes").joints
        };
        let found = sensitivity(linkage, &at, Crank::Stays).expect("derivatives");
        assert_eq!((found.dimensions.len(), found.ground.is_some()), (8, linkage.second_pivot().is_some()));
        let step = 1e-6;
        let with = |errors: &[f64]| match (linkage.slider_crank(), linkage.inverted_slider_crank()) {
            (Some(l), _) => {
                let places = (0..at.len()).map(|k| {
                    let d = place(&linkage, k).follower_pin - l.line_point();
                    (d * l.line_direction().conj()).re
                });
                let places: Vec<f64> = places.collect();
                let low = places.iter().copied().fold(f64::INFINITY, f64::min);
                let high = places.iter().copied().fold(f64::NEG_INFINITY, f64::max);
                slider_crank_with(l, [low, high], errors)
            }
            (_, Some(l)) => inverted_with(l, errors),
            _ => panic!("no slider"),
        };
        for (k, dimension) in found.dimensions.iter().enumerate() {
            let mut errors = [0.0; 8];
            errors[k] = step;
            let plus = with(&errors);
            errors[k] = -step;
            let minus = with(&errors);
            let shift = |j: usize| {
                (place(&plus, j).coupler_point - place(&minus, j).coupler_point).norm() / (2.0 * step)
            };
            let shifts: Vec<f64> = (0..at.len()).map(shift).collect();
            let rms = (shifts.iter().map(|s| s * s).sum::<f64>() / shifts.len() as f64).sqrt();
            assert!((dimension.rms - rms).abs() < 1e-5 * (1.0 + rms), "{i}: {dimension:?}, {rms}");
        }
        // P moves with its coupler: an error of coupler_x or coupler_y is a shift of the same length.
        assert!(found.dimensions[6..].iter().all(|d| (d.rms - 1.0).abs() < 1e-12));
    }
}

#[test]
fn a_guide_pin_stands_as_far_from_its_block_pin_as_it_was_made() {
    for linkage in linkages(54, 10) {
        let sweep = Sweep::of_linkage(linkage).expect("joined");
        let build = Build::new(0.02, 0.03);
        let parts = build.parts(&sweep).expect("it closes");
        let half = parts.guide().expect("a slider").half;
        for at in positions(&sweep, 50) {
            let [d, e, f] = [Joint::D, Joint::E, Joint::F].map(|joint| parts.joint(joint, &at));
            assert!(((e - f).norm() - 2.0 * half).abs() < 1e-12 && (0.5 * (e + f) - d).norm() < 1e-12);
        }
    }
}
