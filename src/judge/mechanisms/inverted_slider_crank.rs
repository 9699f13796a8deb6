//! The block of an inverted slider-crank: a line of the coupler, at the first place with the normal v = y - b, slides through
//! the fixed pivot b.
//!
//! The coupler's line has at the first place the direction u_0 = +-i v/|v|, of the two the one in which B lies ahead of C, so
//! that t1 = +1 there, and passes C; B lies h = Im((b - x) conj u_0) to the left of it.

use super::second_link::{First, Line, Marks, Real, SecondLink, beside_point, have_length};
use crate::mechanism::{AssemblyMode, Complex, CrankLinkage, InvertedSliderCrank, LoopJoints, cross, dot};
use crate::numbers::nine_point::Target;

/// The second link of an inverted slider-crank.
pub(super) struct Block;

/// Returns u_0, the direction of the coupler at the first place.
fn direction(real: &Real) -> Complex {
    let along = Complex::I * real.normal() / real.normal().norm();
    along * AssemblyMode::of(dot(along, real.grounds[1] - real.pins[0])).sign()
}

impl SecondLink for Block {
    fn cranks(&self) -> usize {
        1
    }

    fn linkage(&self, real: &Real, target: &Target) -> Option<CrankLinkage> {
        let (x, [a, b], scale) = (real.pins[0], real.grounds, target.scale);
        let pivots = [a, b].map(|z| target.points[0] + z * scale);
        let along = direction(real);
        let (crank, offset) = ((x - a).norm() * scale, cross(along, b - x) * scale);
        let point = -x * along.conj() * scale;
        let linkage =
            InvertedSliderCrank::from_parts(pivots, crank, offset, point, AssemblyMode::Plus).ok()?;
        have_length(&[crank, linkage.ground()], &linkage.into(), scale).then(|| linkage.into())
    }

    fn assembly(&self, real: &Real, crank_pin: Complex, turn: Complex) -> AssemblyMode {
        AssemblyMode::of(dot(direction(real) * turn, real.grounds[1] - crank_pin))
    }

    /// Returns |CB|/|CP|.
    fn leverage(&self, linkage: &CrankLinkage, at: &LoopJoints) -> f64 {
        linkage.second_pivot().map_or(1.0, |block| beside_point(block - at.joints.crank_pin, at))
    }

    fn solved(&self, linkage: &CrankLinkage, first: &First<'_>) -> Option<[Complex; 2]> {
        let b = first.fixed(linkage.inverted_slider_crank()?.block_pivot());
        Some([b + first.normal(first.at.coupler), b])
    }

    /// Returns A, B, C and the coupler's line.
    fn marks(&self, linkage: &CrankLinkage, at: &LoopJoints) -> Marks {
        let pin = at.joints.crank_pin;
        Marks {
            points: linkage.pivots().chain([pin]).collect(),
            line: Some(Line { through: pin, along: at.coupler }),
        }
    }

    fn marks_of(&self, real: &Real) -> Marks {
        let (x, [a, b]) = (real.pins[0], real.grounds);
        Marks { points: vec![a, b, x], line: Some(Line { through: x, along: direction(real) }) }
    }
}
