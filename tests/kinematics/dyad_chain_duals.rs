//! Derivatives of dyad chains against dual numbers, through positions of their own: circles that meet, extremes held where they are.

use crate::dyad_chains::{drawn, slope, weighted};
use linkwright::internals::mechanism::DyadChain;
use linkwright::internals::mechanism::DyadChainKind;
use linkwright::internals::mechanism::dyad_chain::MAX_DYADS;
use linkwright::internals::mechanism::dyad_chain::proportions::{
    Proportions, first_parameter, length_parameters,
};
use linkwright::internals::mechanism::dyad_chain::sizes::{Joint, sides};
use linkwright::internals::numbers::arithmetic::streams::{stream, uniform};
use num_dual::{Dual64, DualNum};
use std::f64::consts::PI;

/// A point of the plane.
#[derive(Clone, Copy)]
struct Point {
    x: Dual64,
    y: Dual64,
}

fn at(x: f64, y: f64) -> Point {
    Point { x: x.into(), y: y.into() }
}

impl Point {
    fn plus(self, other: Point) -> Point {
        Point { x: self.x + other.x, y: self.y + other.y }
    }

    fn minus(self, other: Point) -> Point {
        Point { x: self.x - other.x, y: self.y - other.y }
    }

    /// Returns the product as of complex numbers.
    fn times(self, other: Point) -> Point {
        Point { x: self.x * other.x - self.y * other.y, y: self.x * other.y + self.y * other.x }
    }

    fn length(self) -> Dual64 {
        (self.x * self.x + self.y * self.y).sqrt()
    }
}

/// A chain whose parameters are dual numbers.
struct Chain<'a> {
    own: &'a DyadChain,
    anchors: [[Point; 2]; MAX_DYADS],
    lengths: [[Dual64; 2]; MAX_DYADS],
    /// The least and the greatest distance of the ends of each dyad.
    extremes: [[Dual64; 2]; MAX_DYADS],
}

impl<'a> Chain<'a> {
    /// Returns the chain, `varied` being the parameter that varies; `of` tells where the distances have their extremes.
    fn new(own: &'a DyadChain, of: &Proportions, varied: Option<usize>) -> Self {
        let parameter = |k: usize| match varied == Some(k) {
            true => Dual64::from(own.shape.parameters[k]).derivative(),
            false => Dual64::from(own.shape.parameters[k]),
        };
        let zero = Dual64::from(0.0);
        let mut chain = Chain {
            own,
            anchors: [[at(0.0, 0.0); 2]; MAX_DYADS],
            lengths: [[zero; 2]; MAX_DYADS],
            extremes: [[zero; 2]; MAX_DYADS],
        };
        chain.anchors[0] = [Point { x: parameter(0).exp(), y: zero }, at(1.0, 0.0)];
        for dyad in 0..own.shape.kind.dyads() {
            if dyad > 0 {
                let first = first_parameter(dyad);
                let place = |k: usize| Point { x: parameter(first + k), y: parameter(first + k + 1) };
                chain.anchors[dyad] = [place(0), place(2)];
            }
            chain.extremes[dyad] = of.extremes[dyad].map(|extreme| {
                let bodies = chain.bodies(at(extreme.at.re, extreme.at.im), dyad);
                let [x, y] = chain.ends(&bodies, dyad);
                y.minus(x).length()
            });
            let [alpha, beta] = length_parameters(dyad).map(parameter);
            let [least, greatest] = chain.extremes[dyad];
            let (sum, difference) = (greatest * (alpha.exp() + 1.0), least * beta.tanh());
            chain.lengths[dyad] = [(sum + difference) * 0.5, (sum - difference) * 0.5];
        }
        chain
    }

    fn ends(&self, bodies: &[[Point; 2]], dyad: usize) -> [Point; 2] {
        let on = self.own.shape.kind.anchors(dyad);
        [0, 1].map(|end| {
            let [origin, along] = bodies[on[end]];
            origin.plus(along.times(self.anchors[dyad][end]))
        })
    }

    /// Returns the origin and the vector of the frame of each body, for the direction of the crank and the first dyads.
    fn bodies(&self, crank: Point, dyads: usize) -> Vec<[Point; 2]> {
        let mut bodies = vec![[at(0.0, 0.0), at(1.0, 0.0)], [at(0.0, 0.0), crank]];
        for dyad in 0..dyads {
            let [x, y] = self.ends(&bodies, dyad);
            let [l1, l2] = self.lengths[dyad];
            let apart = y.minus(x).length();
            // The circles about X and Y meet at these places along and across the line between them.
            let along = (apart * apart + l1 * l1 - l2 * l2) / (apart * 2.0);
            let across = (l1 * l1 - along * along).sqrt() * self.own.shape.assembly[dyad].sign();
            let direction = Point { x: y.minus(x).x / apart, y: y.minus(x).y / apart };
            let f = x.plus(direction.times(Point { x: along, y: across }));
            bodies.push([x, f.minus(x)]);
            bodies.push([y, f.minus(y)]);
        }
        bodies
    }

    /// Returns the derivative of the weighted sum that [`slope`] differentiates.
    fn slope(&self, phase: Dual64) -> f64 {
        let (kind, placement) = (self.own.shape.kind, &self.own.placement);
        let bodies = self.bodies(Point { x: phase.cos(), y: phase.sin() }, kind.dyads());
        let [o, v] = bodies[kind.traced()];
        let mut values = vec![o.x, o.y, v.x, v.y];
        for dyad in 0..kind.dyads() {
            let [l1, l2] = self.lengths[dyad];
            for apart in self.extremes[dyad] {
                values.push((l1 * l1 + l2 * l2 - apart * apart) / (l1 * l2 * 2.0));
            }
        }
        let traced = placement.pointer / placement.ground;
        let place = |joint: Joint| match joint {
            Joint::Fixed(x) => at(x, 0.0),
            Joint::CrankPin => self.anchors[0][0],
            Joint::End { dyad, end } => self.anchors[dyad][end],
            Joint::Traced => at(traced.re, traced.im),
        };
        for side in sides(kind) {
            let [one, other] = side.joints.map(place);
            let unit =
                if side.body < 2 { 1.0.into() } else { self.lengths[side.body / 2 - 1][side.body % 2] };
            values.push((one.minus(other).length() * unit * placement.ground.norm()).ln());
        }
        weighted(values.into_iter().map(|value| value.eps))
    }
}

/// Returns the largest error of the derivatives of a chain, relative to their size.
fn worst(chain: &DyadChain, phase: f64) -> f64 {
    let of = chain.proportions();
    let error = |k: usize| {
        let expected = match k {
            0 => Chain::new(chain, &of, None).slope(Dual64::from(phase).derivative()),
            k => Chain::new(chain, &of, Some(k - 1)).slope(phase.into()),
        };
        (expected - slope(chain, phase, k)).abs() / (10.0 + expected.abs())
    };
    (0..=chain.shape.count()).map(error).fold(0.0, f64::max)
}

#[test]
fn derivatives_are_those_of_dual_numbers() {
    for (stream_index, kind) in (0..).zip(DyadChainKind::SIX_BARS) {
        let draws = &mut stream(54, stream_index);
        for _ in 0..1000 {
            let chain = drawn(kind, draws);
            let worst = worst(&chain, uniform(draws, -PI, PI));
            assert!(worst < 1e-9, "{}: {worst:e} of {:?}", kind.name(), chain.shape);
        }
    }
    let draws = &mut stream(55, 0);
    for kind in DyadChainKind::eight_bars() {
        for _ in 0..20 {
            let chain = drawn(kind, draws);
            let worst = worst(&chain, uniform(draws, -PI, PI));
            assert!(worst < 1e-9, "{}: {worst:e} of {:?}", kind.name(), chain.shape);
        }
    }
}
