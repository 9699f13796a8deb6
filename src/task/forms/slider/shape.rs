//! The closure of a linkage with a slider, with its derivatives by the position and by the unknowns.

use crate::mechanism::{
    AssemblyMode, Complex, CrankLinkage, InvertedSliderCrank, LinkageError, LinkageKind, SliderCrank, cross,
    dot,
};

/// The number of unknowns of a linkage with a slider.
pub const SHAPE: usize = 8;
/// The unknowns of the fit: those of the linkage, the offset of prescribed crank angles and the frame of the body.
pub const UNKNOWNS: usize = SHAPE + 2;
/// The place of the offset of prescribed crank angles among the unknowns.
pub const OFFSET: usize = SHAPE;
/// The place of the frame of a motion's body, the angle from the coupler's direction to its x axis, among the unknowns.
pub const FRAME: usize = SHAPE + 1;

/// The unknowns: Ax, Ay, a; then b, q and the line's angle of a slider-crank, whose line is Im(p conj s) = q, or Bx, By and h
/// of an inverted one; Zx, Zy; the offset and the frame.
pub type Unknowns = [f64; UNKNOWNS];

/// The closure of a kind with its parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Closure {
    /// D = C + b u lies on the line Im(p conj s) = q.
    Line {
        /// b, the length of the coupler.
        coupler: f64,
        /// q, the distance of the line to the left of the origin, seen along s.
        height: f64,
        /// s, the unit direction of the line.
        direction: Complex,
    },
    /// The coupler's line passes B at the distance h: Im((B - C) conj u) = h.
    Block {
        /// B, the pivot of the block.
        pivot: Complex,
        /// h, the distance of B to the left of the coupler's line.
        offset: f64,
    },
}

/// A linkage with a slider in its unknowns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SliderShape {
    /// A, the crank's pivot.
    pub crank_pivot: Complex,
    /// a, the length of the crank.
    pub crank: f64,
    /// Z, the coupler point along and across the coupler from C.
    pub offset: Complex,
    /// The closure.
    pub closure: Closure,
}

/// The closure's miss at a position, with its derivatives.
#[derive(Clone, Copy, Debug)]
pub struct Miss {
    /// The miss, a length.
    pub value: f64,
    /// Its derivative by the crank's angle.
    pub by_crank: f64,
    /// Its derivative by the coupler's angle.
    pub by_coupler: f64,
    /// Its derivatives by the unknowns.
    pub by_shape: [f64; SHAPE],
}

impl SliderShape {
    /// Returns the linkage of a kind in its unknowns; `None` of a four-bar, and without positive lengths.
    pub fn of(kind: LinkageKind, x: &Unknowns) -> Option<SliderShape> {
        let [ax, ay, crank, one, two, three, zx, zy, ..] = *x;
        let closure = match kind {
            LinkageKind::FourBar | LinkageKind::SixBar | LinkageKind::EightBar => return None,
            LinkageKind::SliderCrank => {
                Closure::Line { coupler: one, height: two, direction: Complex::from_polar(1.0, three) }
            }
            LinkageKind::InvertedSliderCrank => {
                Closure::Block { pivot: Complex::new(one, two), offset: three }
            }
        };
        let is_length = crank > 0.0 && !(kind == LinkageKind::SliderCrank && one <= 0.0);
        is_length.then_some(SliderShape {
            crank_pivot: Complex::new(ax, ay),
            crank,
            offset: Complex::new(zx, zy),
            closure,
        })
    }

    /// Returns a linkage in its unknowns; `None` of a four-bar.
    pub fn from_linkage(linkage: &CrankLinkage) -> Option<SliderShape> {
        let closure = match linkage {
            CrankLinkage::FourBar(_) | CrankLinkage::MultiLoop(_) => return None,
            CrankLinkage::SliderCrank(l) => Closure::Line {
                coupler: l.coupler(),
                height: cross(l.line_direction(), l.line_point()),
                direction: l.line_direction(),
            },
            CrankLinkage::InvertedSliderCrank(l) => {
                Closure::Block { pivot: l.block_pivot(), offset: l.offset() }
            }
        };
        Some(SliderShape {
            crank_pivot: linkage.crank_pivot(),
            crank: linkage.crank(),
            offset: linkage.coupler_offset(),
            closure,
        })
    }

    /// Returns its unknowns, with an offset of prescribed crank angles and the frame of a body.
    pub fn unknowns(&self, offset: f64, frame: f64) -> Unknowns {
        let (a, z) = (self.crank_pivot, self.offset);
        let [one, two, three] = match self.closure {
            Closure::Line { coupler, height, direction } => [coupler, height, direction.arg()],
            Closure::Block { pivot, offset } => [pivot.re, pivot.im, offset],
        };
        [a.re, a.im, self.crank, one, two, three, z.re, z.im, offset, frame]
    }

    /// Returns the image p -> shift + scale p, where `scale` turns too.
    #[must_use]
    pub fn carried(&self, scale: Complex, shift: Complex) -> SliderShape {
        let length = scale.norm();
        let turn = scale / length;
        SliderShape {
            crank_pivot: shift + scale * self.crank_pivot,
            crank: length * self.crank,
            offset: length * self.offset,
            closure: match self.closure {
                Closure::Line { coupler, height, direction } => {
                    let direction = turn * direction;
                    Closure::Line {
                        coupler: length * coupler,
                        height: length * height + cross(direction, shift),
                        direction,
                    }
                }
                Closure::Block { pivot, offset } => {
                    Closure::Block { pivot: shift + scale * pivot, offset: length * offset }
                }
            },
        }
    }

    /// Returns the linkage with the assembly that one of its positions has, in the form in which that is t1 = +1: a line
    /// seen the other way, or a coupler whose direction points back, has the other sign.
    ///
    /// # Errors
    /// If a number is beyond the range of lengths.
    pub fn linkage(&self, assembly: AssemblyMode) -> Result<CrankLinkage, LinkageError> {
        let sign = assembly.sign();
        match self.closure {
            Closure::Line { coupler, height, direction } => {
                let direction = direction * sign;
                // The foot of the perpendicular from A.
                let foot = self.crank_pivot
                    + direction * Complex::i() * (sign * height - cross(direction, self.crank_pivot));
                let lengths = [self.crank, coupler];
                let line = (foot, direction.arg());
                SliderCrank::from_parts(self.crank_pivot, lengths, line, self.offset, AssemblyMode::Plus)
                    .map(CrankLinkage::SliderCrank)
            }
            Closure::Block { pivot, offset } => {
                let pivots = [self.crank_pivot, pivot];
                let (h, z) = (sign * offset, sign * self.offset);
                InvertedSliderCrank::from_parts(pivots, self.crank, h, z, AssemblyMode::Plus)
                    .map(CrankLinkage::InvertedSliderCrank)
            }
        }
    }

    /// Computes the coupler's unit direction u with the crank along e in an assembly; `None` if the loop is open.
    pub fn coupler_direction(&self, e: Complex, sign: f64) -> Option<Complex> {
        let c = self.crank_pivot + e * self.crank;
        match self.closure {
            Closure::Line { coupler, height, direction } => {
                let h = (cross(direction, c) - height) / coupler;
                let left = (1.0 - h) * (1.0 + h);
                (left > 0.0).then(|| direction * Complex::new(sign * left.sqrt(), -h))
            }
            Closure::Block { pivot, offset } => {
                let v = pivot - c;
                let (length, sq) = (v.norm(), v.norm_sqr());
                let left = (length - offset) * (length + offset);
                (left > 0.0).then(|| v * Complex::new(sign * left.sqrt(), -offset) / sq)
            }
        }
    }

    /// Returns the assembly of a position.
    pub fn assembly_of(&self, [e, u]: [Complex; 2]) -> AssemblyMode {
        AssemblyMode::of(match self.closure {
            Closure::Line { direction, .. } => dot(u, direction),
            Closure::Block { pivot, .. } => dot(pivot - self.crank_pivot - e * self.crank, u),
        })
    }

    /// Returns P = A + a e + Z u.
    pub fn coupler_point(&self, [e, u]: [Complex; 2]) -> Complex {
        self.crank_pivot + e * self.crank + u * self.offset
    }

    /// Computes the miss of the closure at a position:
    ///
    /// ```text
    /// line    Im((A + a e + b u) conj s) - q        block    Im((B - A - a e) conj u) - h
    /// ```
    // Where only the value and the slopes are used, the rest is not computed.
    #[inline(always)]
    pub fn miss(&self, [e, u]: [Complex; 2]) -> Miss {
        match self.closure {
            Closure::Line { coupler, height, direction: s } => {
                let d = self.crank_pivot + e * self.crank + u * coupler;
                Miss {
                    value: cross(s, d) - height,
                    by_crank: self.crank * dot(e, s),
                    by_coupler: coupler * dot(u, s),
                    by_shape: [-s.im, s.re, cross(s, e), cross(s, u), -1.0, -dot(d, s), 0.0, 0.0],
                }
            }
            Closure::Block { pivot, offset } => {
                let v = pivot - self.crank_pivot - e * self.crank;
                Miss {
                    value: cross(u, v) - offset,
                    by_crank: -self.crank * dot(e, u),
                    by_coupler: -dot(v, u),
                    by_shape: [u.im, -u.re, -cross(u, e), -u.im, u.re, -1.0, 0.0, 0.0],
                }
            }
        }
    }

    /// Returns the largest length that enters the closure.
    pub fn largest(&self) -> f64 {
        match self.closure {
            Closure::Line { coupler, height, .. } => self.crank.max(coupler).max(height.abs()),
            Closure::Block { pivot, offset } => {
                self.crank.max((pivot - self.crank_pivot).norm()).max(offset.abs())
            }
        }
    }
}
