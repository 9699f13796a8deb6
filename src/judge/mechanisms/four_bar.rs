//! The follower of a four-bar: the link (y, b) keeps its length, and can be driven as well as the crank.

use super::second_link::{First, Marks, Real, SecondLink, have_length};
use crate::mechanism::{AssemblyMode, Complex, CrankLinkage, FourBar, LoopJoints, cross};
use crate::numbers::nine_point::Target;

/// The second link of a four-bar.
pub(super) struct Follower;

impl SecondLink for Follower {
    fn cranks(&self) -> usize {
        2
    }

    fn linkage(&self, real: &Real, target: &Target) -> Option<CrankLinkage> {
        let ([x, y], [a, b], scale) = (real.pins, real.grounds, target.scale);
        let pivots = [target.points[0] + a * scale, target.points[0] + b * scale];
        let along = (y - x) / (y - x).norm();
        let links = [(x - a).norm() * scale, (y - x).norm() * scale, (y - b).norm() * scale];
        let offset = -x * along.conj() * scale;
        let assembly = self.assembly(real, x, Complex::new(1.0, 0.0));
        let linkage = FourBar::with_coupler_offset(pivots, links, offset, assembly).ok()?;
        linkage.linkage_type()?;
        have_length(&linkage.links(), &linkage.into(), scale).then(|| linkage.into())
    }

    fn assembly(&self, real: &Real, crank_pin: Complex, turn: Complex) -> AssemblyMode {
        let ([x, y], b) = (real.pins, real.grounds[1]);
        AssemblyMode::of(cross(b - crank_pin, (y - x) * turn))
    }

    fn leverage(&self, _: &CrankLinkage, _: &LoopJoints) -> f64 {
        1.0
    }

    fn solved(&self, linkage: &CrankLinkage, first: &First<'_>) -> Option<[Complex; 2]> {
        let follower_pivot = linkage.four_bar()?.follower_pivot();
        Some([first.moving(first.at.joints.follower_pin), first.fixed(follower_pivot)])
    }

    /// Returns A, B, C and D.
    fn marks(&self, linkage: &CrankLinkage, at: &LoopJoints) -> Marks {
        let pins = [at.joints.crank_pin, at.joints.follower_pin];
        Marks { points: linkage.pivots().chain(pins).collect(), line: None }
    }

    fn marks_of(&self, real: &Real) -> Marks {
        Marks { points: real.grounds.into_iter().chain(real.pins).collect(), line: None }
    }
}
