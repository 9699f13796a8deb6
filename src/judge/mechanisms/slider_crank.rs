//! The slider of a slider-crank: the pin y runs on a fixed line, of which v = y - b is a normal.
//!
//! The line passes D_0 = P_0 + y along s = +-i v/|v|, of the two directions the one in which the coupler leans at the first
//! place, <s, u_0> >= 0, so that t1 = +1 there.

use super::second_link::{First, Line, Marks, Real, SecondLink, beside_point, have_length};
use crate::mechanism::{AssemblyMode, Complex, CrankLinkage, LoopJoints, SliderCrank, dot};
use crate::numbers::nine_point::Target;

/// The second link of a slider-crank.
pub(super) struct Slider;

/// Returns s, the direction of the line.
fn direction(real: &Real) -> Complex {
    let [x, y] = real.pins;
    let along = Complex::I * real.normal() / real.normal().norm();
    along * AssemblyMode::of(dot(along, y - x)).sign()
}

impl SecondLink for Slider {
    fn cranks(&self) -> usize {
        1
    }

    fn linkage(&self, real: &Real, target: &Target) -> Option<CrankLinkage> {
        let ([x, y], a, scale) = (real.pins, real.grounds[0], target.scale);
        let place = |z: Complex| target.points[0] + z * scale;
        let along = (y - x) / (y - x).norm();
        let lengths = [(x - a).norm() * scale, (y - x).norm() * scale];
        let line = (place(y), direction(real).arg());
        let offset = -x * along.conj() * scale;
        let linkage = SliderCrank::from_parts(place(a), lengths, line, offset, AssemblyMode::Plus).ok()?;
        have_length(&lengths, &linkage.into(), scale).then(|| linkage.into())
    }

    fn assembly(&self, real: &Real, _: Complex, turn: Complex) -> AssemblyMode {
        let [x, y] = real.pins;
        AssemblyMode::of(dot(direction(real), (y - x) * turn))
    }

    /// Returns |CD|/|CP|.
    fn leverage(&self, _: &CrankLinkage, at: &LoopJoints) -> f64 {
        beside_point(at.joints.follower_pin - at.joints.crank_pin, at)
    }

    fn solved(&self, linkage: &CrankLinkage, first: &First<'_>) -> Option<[Complex; 2]> {
        let line = linkage.slider_crank()?.line_direction();
        let y = first.moving(first.at.joints.follower_pin);
        Some([y, y - first.normal(line)])
    }

    /// Returns A, C, D and the slider's line.
    fn marks(&self, linkage: &CrankLinkage, at: &LoopJoints) -> Marks {
        let pin = at.joints.follower_pin;
        Marks {
            points: vec![linkage.crank_pivot(), at.joints.crank_pin, pin],
            line: linkage.slider_crank().map(|own| Line { through: pin, along: own.line_direction() }),
        }
    }

    fn marks_of(&self, real: &Real) -> Marks {
        let ([x, y], a) = (real.pins, real.grounds[0]);
        Marks { points: vec![a, x, y], line: Some(Line { through: y, along: direction(real) }) }
    }
}
