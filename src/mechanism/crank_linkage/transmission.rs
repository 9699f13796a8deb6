//! Transmission angles of a linkage that a crank drives: at one position, and their extremes over a motion.

use super::CrankLinkage;
use crate::mechanism::four_bar::transmission::TransmissionExtremes;
use crate::mechanism::{AssemblyMode, Complex, OnCircuit, SliderLinkage, least_and_greatest};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

impl CrankLinkage {
    /// Computes the transmission angle at a crank angle, radians, of a six-bar that of the dyad nearest to flat; of a four-bar the
    /// nearest flat angle, 0 or pi, if the loop is open, of other kinds 0.
    pub fn transmission_at(&self, crank_angle: f64) -> f64 {
        let crank = || Complex::from_polar(1.0, crank_angle);
        match self {
            CrankLinkage::FourBar(linkage) => linkage.angle_at_follower_pin(crank_angle),
            CrankLinkage::SliderCrank(linkage) => linkage.transmission_toward(crank()),
            CrankLinkage::InvertedSliderCrank(linkage) => linkage.transmission_toward(crank()),
            CrankLinkage::MultiLoop(linkage) => linkage.transmission_at(crank_angle),
        }
    }

    /// Computes the extremes of the transmission angle over the range of the crank; `None` without a position.
    pub fn transmission_over_cycle(&self) -> Option<TransmissionExtremes> {
        match self {
            CrankLinkage::FourBar(linkage) => Some(linkage.transmission_over_cycle()),
            CrankLinkage::SliderCrank(linkage) => linkage.transmission_over_range(),
            CrankLinkage::InvertedSliderCrank(linkage) => linkage.transmission_over_range(),
            CrankLinkage::MultiLoop(linkage) => Some(linkage.transmission_between([0.0, TAU])),
        }
    }
}

impl OnCircuit<CrankLinkage> {
    /// Computes the extremes of the transmission angle over an interval of the parameter, at most a whole turn, in closed
    /// form: they lie at its ends, at a toggle, and where the crank lies along the ground; of a slider at the
    /// [turning angles](SliderLinkage::transmission_turns) of its kind.
    pub fn transmission_between(&self, [low, high]: [f64; 2]) -> TransmissionExtremes {
        let inside = |t: &f64| low + (t - low).rem_euclid(TAU);
        match &self.linkage {
            CrankLinkage::FourBar(linkage) => {
                let ground = linkage.ground_angle();
                let extreme: &[f64] = if self.arc.is_some() {
                    &[0.0, FRAC_PI_2, PI, -FRAC_PI_2]
                } else {
                    &[ground, ground + PI]
                };
                let inside = extreme.iter().map(inside).filter(|t| *t <= high);
                let all = [low, high].into_iter().chain(inside);
                linkage.transmission_at(all.map(|t| linkage.diagonal(self.position_at(t).0)))
            }
            CrankLinkage::SliderCrank(linkage) => self.of_slider(linkage, [low, high]),
            CrankLinkage::InvertedSliderCrank(linkage) => self.of_slider(linkage, [low, high]),
            CrankLinkage::MultiLoop(linkage) => linkage.transmission_between([low, high]),
        }
    }

    fn of_slider<L: SliderLinkage>(&self, linkage: &L, [low, high]: [f64; 2]) -> TransmissionExtremes {
        let turns = linkage.transmission_turns();
        let extreme: Vec<f64> = match self.arc {
            None => turns.to_vec(),
            Some(arc) => {
                let on_arc = turns.into_iter().filter(|t| arc.offset(*t).abs() <= arc.half_width);
                let of_both =
                    |t: f64| [AssemblyMode::Plus, AssemblyMode::Minus].map(|sign| arc.parameter(t, sign));
                on_arc.flat_map(of_both).chain([FRAC_PI_2, -FRAC_PI_2]).collect()
            }
        };
        let inside = extreme.iter().map(|t| low + (t - low).rem_euclid(TAU)).filter(|t| *t <= high);
        let at = |t: f64| linkage.transmission_toward(Complex::from_polar(1.0, self.position_at(t).0));
        let [min, max] = least_and_greatest([low, high].into_iter().chain(inside).map(at));
        TransmissionExtremes { min, max }
    }
}
