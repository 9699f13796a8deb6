//! The linkages with a slider as mechanisms of any kind.

use super::motion::{CrankMotion, PointMotion, SliderMotion, motion};
use super::{SliderJoints, SliderLinkage, SliderPosition};
use crate::mechanism::any::{
    CrankRange, Link, Mechanism, MechanismMotion, MechanismPose, Output, OutputRate, Slide, Status,
};
use crate::mechanism::four_bar::transmission::TransmissionExtremes;
use crate::mechanism::structure::{Body, Frame, Group, Line, OutputBody, Pair, Structure};
use crate::mechanism::{Complex, InvertedSliderCrank, SliderCrank, turned};

/// Names, joints and guide of a linkage with a slider, which make it a mechanism of any kind.
trait Described: SliderLinkage {
    /// The kind as a word of files.
    const KIND: &'static str;
    /// The names of the pivots, then C, D and P.
    const NAMES: &'static [&'static str];

    fn fixed(&self) -> Vec<Complex>;
    fn coupler_link(&self, first: usize) -> Link;
    fn guide(&self, first: usize) -> Slide;
    fn parts(&self) -> Structure;
    fn ratio(&self) -> f64;
}

fn along(x: f64) -> Complex {
    Complex::new(x, 0.0)
}

impl Described for SliderCrank {
    const KIND: &'static str = "slider-crank";
    const NAMES: &'static [&'static str] = &["A", "C", "D", "P"];

    fn fixed(&self) -> Vec<Complex> {
        vec![self.crank_pivot()]
    }

    fn coupler_link(&self, first: usize) -> Link {
        let joints = vec![first, first + 1, first + 2];
        Link { name: "coupler".into(), joints, length: Some(self.coupler()) }
    }

    fn guide(&self, first: usize) -> Slide {
        Slide::Rail { block: first + 1, through: self.line_point(), direction: self.line_direction() }
    }

    fn parts(&self) -> Structure {
        let [a, c, d, p] = [0, 1, 2, 3];
        let coupler = [(c, along(0.0)), (d, along(self.coupler())), (p, self.coupler_offset())];
        Structure {
            bodies: vec![
                Body::ground([(a, self.crank_pivot())]),
                Body::link("crank", &[(a, along(0.0)), (c, along(self.crank()))]),
                Body::link("coupler", &coupler),
                Body::block("block", Line::Fixed(self.line_direction()), &[(d, along(0.0))]),
            ],
            crank_pivot: a,
            groups: vec![Group {
                bodies: [2, 3],
                pairs: [Pair::pin(c, [1, 2]), Pair::pin(d, [2, 3]), Pair::slide(d, [0, 3])],
            }],
            output: Some(OutputBody::Slides(3)),
        }
    }

    fn ratio(&self) -> f64 {
        self.link_ratio()
    }
}

impl Described for InvertedSliderCrank {
    const KIND: &'static str = "inverted-slider-crank";
    const NAMES: &'static [&'static str] = &["A", "B", "C", "D", "P"];

    fn fixed(&self) -> Vec<Complex> {
        vec![self.crank_pivot(), self.block_pivot()]
    }

    fn coupler_link(&self, first: usize) -> Link {
        Link {
            name: "coupler".into(),
            joints: vec![first, first + 2],
            length: Some(self.coupler_offset().norm()),
        }
    }

    fn guide(&self, first: usize) -> Slide {
        Slide::Rod { from: first, foot: first + 1, pivot: 1 }
    }

    fn parts(&self) -> Structure {
        let [a, b, c, d, p] = [0, 1, 2, 3, 4];
        let coupler = Body {
            name: "coupler".to_owned(),
            frame: Frame::Coupler(c),
            joints: vec![(c, along(0.0)), (p, self.coupler_offset())],
            is_plain: false,
        };
        // B lies `offset` to the left of D, the foot on the rod.
        let foot = Complex::new(0.0, -self.offset());
        let line = Line::OnBody { body: 2, turn: along(1.0) };
        Structure {
            bodies: vec![
                Body::ground([(a, self.crank_pivot()), (b, self.block_pivot())]),
                Body::link("crank", &[(a, along(0.0)), (c, along(self.crank()))]),
                coupler,
                Body::block("block", line, &[(b, along(0.0)), (d, foot)]),
            ],
            crank_pivot: a,
            groups: vec![Group {
                bodies: [2, 3],
                pairs: [Pair::pin(c, [1, 2]), Pair::pin(b, [0, 3]), Pair::slide(b, [2, 3])],
            }],
            output: Some(OutputBody::Turns(3)),
        }
    }

    fn ratio(&self) -> f64 {
        self.link_ratio()
    }
}

fn described<L: Described>(
    linkage: &L,
    status: Status,
    crank_angle: f64,
    joints: Option<&SliderJoints>,
) -> MechanismPose {
    let crank_pin = match joints {
        Some(joints) => joints.crank_pin,
        None => linkage.crank_pivot() + Complex::from_polar(linkage.crank(), crank_angle),
    };
    let fixed = linkage.fixed();
    let slider_pin = fixed.len() + 1;
    let moving = [
        Some(crank_pin).filter(|c| c.is_finite()),
        joints.map(|j| j.slider_pin),
        joints.map(|j| j.coupler_point),
    ];
    MechanismPose {
        status,
        stuck: (status != Status::Ok).then_some(slider_pin),
        joints: fixed.into_iter().map(Some).chain(moving).collect(),
        coupler: joints.map(|j| j.coupler),
        output: joints.map(|j| Output::Slider(j.place)),
        transmission: joints.map(|_| linkage.transmission_toward(Complex::from_polar(1.0, crank_angle))),
    }
}

/// Computes velocity and acceleration of C; `None` if they are no finite numbers.
fn of_crank_pin<L: Described>(linkage: &L, pin: Complex, input: CrankMotion) -> Option<PointMotion> {
    let (arm, omega) = (pin - linkage.crank_pivot(), input.speed_rad_s);
    let moved = PointMotion {
        velocity: turned(arm) * omega,
        acceleration: turned(arm) * input.acceleration_rad_s2 - arm * (omega * omega),
    };
    (moved.velocity.is_finite() && moved.acceleration.is_finite()).then_some(moved)
}

macro_rules! mechanism {
    ($kind:ty) => {
        impl Mechanism for $kind {
            fn kind(&self) -> &'static str {
                Self::KIND
            }

            fn joint_names(&self) -> Vec<&str> {
                Self::NAMES.to_vec()
            }

            fn pivots(&self) -> usize {
                Self::NAMES.len() - 3
            }

            fn traced(&self) -> usize {
                Self::NAMES.len() - 1
            }

            fn pose_at(&self, crank_angle: f64) -> MechanismPose {
                match self.position(crank_angle) {
                    SliderPosition::Closed(joints) => described(self, Status::Ok, crank_angle, Some(&joints)),
                    SliderPosition::Open => described(self, Status::Open, crank_angle, None),
                    SliderPosition::Undetermined => described(self, Status::Undetermined, crank_angle, None),
                }
            }

            fn motion_at(&self, crank_angle: f64, input: CrankMotion) -> MechanismMotion {
                moved(self, crank_angle, input)
            }

            fn crank_range(&self) -> CrankRange {
                let mobility = self.mobility();
                CrankRange {
                    turns_fully: mobility.input_turns_fully(),
                    arcs: mobility.input.arcs().iter().map(|arc| arc.ends()).collect(),
                    toggles: mobility.toggles().iter().map(|toggle| toggle.crank_angle).collect(),
                    circuits: Some([mobility.circuits(), mobility.branches_per_circuit()]),
                    margin: Some(mobility.full_turn_margin),
                }
            }

            fn moving_links(&self) -> Vec<Link> {
                let first = self.pivots();
                let crank = Link { name: "crank".into(), joints: vec![0, first], length: Some(self.crank()) };
                vec![crank, self.coupler_link(first)]
            }

            fn structure(&self) -> Structure {
                self.parts()
            }

            fn slide(&self) -> Option<Slide> {
                Some(self.guide(self.pivots()))
            }

            fn transmission_extremes(&self) -> Option<TransmissionExtremes> {
                self.transmission_over_range()
            }

            fn longest_to_shortest(&self) -> Option<f64> {
                Some(self.ratio()).filter(|ratio| ratio.is_finite())
            }
        }
    };
}

mechanism!(SliderCrank);
mechanism!(InvertedSliderCrank);

fn moved<L: Described>(linkage: &L, crank_angle: f64, input: CrankMotion) -> MechanismMotion {
    let found = motion(linkage, crank_angle, input);
    let status = match found {
        SliderMotion::Definite(_) => Status::Ok,
        SliderMotion::Singular(_) => Status::Singular,
        SliderMotion::Open => Status::Open,
        SliderMotion::Undetermined => Status::Undetermined,
        SliderMotion::NotFinite => Status::NotFinite,
    };
    let pose = described(linkage, status, crank_angle, found.joints().as_ref());
    let (definite, pivots) = (found.definite(), L::NAMES.len() - 3);
    let crank_pin = pose.joints[pivots].and_then(|pin| of_crank_pin(linkage, pin, input));
    let points = [crank_pin, definite.map(|m| m.rates.slider_pin), definite.map(|m| m.coupler_point)];
    let of = |part: fn(PointMotion) -> Complex| {
        let still = std::iter::repeat_n(Some(Complex::new(0.0, 0.0)), pivots);
        still.chain(points.map(|point| point.map(part))).collect()
    };
    MechanismMotion {
        velocities: of(|p| p.velocity),
        accelerations: of(|p| p.acceleration),
        coupler: definite.map(|m| m.rates.coupler),
        output: definite.map(|m| OutputRate::Slider(m.rates.sliding)),
        pose,
    }
}
