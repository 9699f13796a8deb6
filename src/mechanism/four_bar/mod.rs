//! Planar four-bar linkages: parameters, position, motion, mobility, coupler curve and cognates.
//!
//! ```text
//!                    P                A, B   fixed pivots (A drives)
//!                   / \               C, D   moving pins
//!                d /   \ e            P      coupler point
//!                 /  b  \             a = |AC| crank      b = |CD| coupler   c = |BD| follower
//!                C-------D            d = |CP|  e = |DP|  g = |AB| ground
//!             a /         \ c         phi    crank angle from the x axis, counter-clockwise, radians
//!              A-----------B          t1 = +1: D lies left of the line C -> B
//!                    g                t2 = +1: P lies left of the line C -> D
//! ```
//!
//! The nine parameters and two signs are those of N. N. Romero Nunez (2016), "Analisis de posicion de un mecanismo de
//! cuatro barras utilizando coordenadas naturales" ("Romero" in this module). Points of the plane are complex numbers.
//!
//! | module | holds |
//! |---|---|
//! | [`assembly_condition`] | assembly conditions of a four-bar at a crank angle: Romero's necessary condition and the sufficient one |
//! | [`cognate`] | the Roberts-Chebyshev cognates: the two other four-bars that trace the same coupler curve |
//! | [`coupler_curve`] | the coupler curve of a circuit: samples, length, and the distance from a point |
//! | [`gradient`] | gradient of the coupler point by the linkage's parameters and by the crank angle |
//! | `kind` | the four-bar as a mechanism of any kind |
//! | [`loop_closure`] | loop-closure methods of position analysis from the literature, as reference solvers beside the natural coordinates of `position.rs` |
//! | [`mobility`] | mobility of a four-bar: its type by Grashof, the range of its input, and its circuits, branches and toggles |
//! | [`motion`] | velocity and acceleration at one crank angle, in natural coordinates |
//! | [`position`] | position analysis of the four-bar in closed form, in natural coordinates: the kernel that the other modules call |
//! | [`positions`] | positions at many crank angles, in blocks of lanes |
//! | [`transmission`] | the transmission angle mu between coupler and follower at D, in [0, 180] degrees, and its extremes |

pub mod assembly_condition;
pub mod cognate;
pub mod coupler_curve;
pub mod gradient;
mod kind;
pub mod loop_closure;
pub mod mobility;
pub mod motion;
pub mod position;
pub mod positions;
pub mod transmission;

pub use coupler_curve::CouplerCurve;
pub use mobility::{Branch, Circuit, InputArc, InputRange, LinkageType, Mobility, OnCircuit, Toggle};
pub use position::{Joints, Position};

use crate::numbers::arithmetic::{Complex, point, xy};
use serde::{Deserialize, Serialize};

macro_rules! sign_type {
    ($(#[$doc:meta])* $name:ident, $plus:literal, $minus:literal) => {
        $(#[$doc])*
        #[derive(
            Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize, schemars::JsonSchema,
        )]
        #[serde(try_from = "i64", into = "i64")]
        #[schemars(extend("enum" = [1, -1]))]
        pub enum $name {
            #[doc = $plus]
            Plus,
            #[doc = $minus]
            Minus,
        }

        impl $name {
            /// Returns +1 or -1.
            #[inline(always)]
            pub fn sign(self) -> f64 {
                match self {
                    $name::Plus => 1.0,
                    $name::Minus => -1.0,
                }
            }

            /// Returns Plus for positive numbers and zero, Minus for negative ones.
            pub fn of(value: f64) -> Self {
                if value < 0.0 { $name::Minus } else { $name::Plus }
            }

            /// Returns the opposite sign.
            pub fn opposite(self) -> Self {
                match self {
                    $name::Plus => $name::Minus,
                    $name::Minus => $name::Plus,
                }
            }
        }

        impl From<$name> for i64 {
            fn from(value: $name) -> i64 {
                value.sign() as i64
            }
        }

        impl TryFrom<i64> for $name {
            type Error = String;
            fn try_from(value: i64) -> Result<Self, String> {
                match value {
                    1 => Ok($name::Plus),
                    -1 => Ok($name::Minus),
                    other => Err(format!("a sign is 1 or -1, not {other}")),
                }
            }
        }
    };
}

sign_type!(
    /// t1: which of the two intersections the pin D takes.
    AssemblyMode,
    "D lies left of the line from C to B.",
    "D lies right of the line from C to B."
);
sign_type!(
    /// t2: on which side of the coupler the point P lies.
    CouplerSide,
    "P lies left of the line from C to D.",
    "P lies right of the line from C to D."
);

/// The error of parameters that do not describe a four-bar linkage.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LinkageError {
    /// A number that is NaN, infinite or beyond [`MAX_MAGNITUDE`].
    #[error("{key} = {value} is not a finite number below {max:e} in magnitude", max = MAX_MAGNITUDE)]
    NotFinite {
        /// The parameter's letter.
        key: &'static str,
        /// The parameter's value.
        value: f64,
    },
    /// A link of zero or negative length.
    #[error("{key} = {value}: a link's length must be positive")]
    LengthNotPositive {
        /// The parameter's letter.
        key: &'static str,
        /// The parameter's value.
        value: f64,
    },
    /// A negative distance from a pin to the coupler point.
    #[error("{key} = {value}: the distance from a pin to the coupler point cannot be negative")]
    DistanceNegative {
        /// The parameter's letter.
        key: &'static str,
        /// The parameter's value.
        value: f64,
    },
    /// Sides of no triangle C-D-P (Romero's equation 17 would need the root of a negative number).
    #[error(
        "no triangle has the sides b = {b}, d = {d}, e = {e}: each must be at most the sum of the other two"
    )]
    NoCouplerTriangle {
        /// |CD|, the coupler.
        b: f64,
        /// |CP|, the distance from the crank pin to the coupler point.
        d: f64,
        /// |DP|, the distance from the follower pin to the coupler point.
        e: f64,
    },
}

/// The largest magnitude of a coordinate or length.
pub const MAX_MAGNITUDE: f64 = 1e12;

/// Relative tolerance of closure: a triangle or a loop that misses closure by less than this part of its scale counts
/// as flat, because the roots of collinear points round below zero in a third of the cases.
pub const FLAT_TOLERANCE: f64 = 1e-12;

/// A four-bar linkage: fixed pivots, five lengths and two signs.
///
/// ```
/// use linkwright::{AssemblyMode, CouplerSide, FourBar, NaturalCoordinates};
/// let linkage = FourBar::new(NaturalCoordinates {
///     crank_pivot: [0.0, 0.0], follower_pivot: [4.0, 1.0],
///     crank: 2.0, coupler: 5.0, follower: 5.0, crank_side: 5.0, follower_side: 5.0,
///     assembly: AssemblyMode::Plus, side: CouplerSide::Plus,
/// })?;
/// let joints = linkage.position(0.3).joints().unwrap();
/// assert!(((joints.follower_pin - joints.crank_pin).norm() - 5.0).abs() < 1e-14);
/// # Ok::<(), linkwright::LinkageError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(try_from = "NaturalCoordinates", into = "NaturalCoordinates")]
pub struct FourBar {
    parameters: NaturalCoordinates,
    /// Ground |AB|, kept because everything asks for it.
    ground: f64,
    /// z = (l2 + i h2)/b of seed equation 18: P = C + z (D - C).
    coupler_ratio: Complex,
}

/// The nine parameters and two signs in the letters of the seed paper, as they stand in files.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NaturalCoordinates {
    /// The fixed pivot of the crank.
    #[serde(rename = "A")]
    pub crank_pivot: [f64; 2],
    /// The fixed pivot of the follower.
    #[serde(rename = "B")]
    pub follower_pivot: [f64; 2],
    /// |AC|.
    #[serde(rename = "a")]
    pub crank: f64,
    /// |CD|.
    #[serde(rename = "b")]
    pub coupler: f64,
    /// |BD|.
    #[serde(rename = "c")]
    pub follower: f64,
    /// |CP|.
    #[serde(rename = "d")]
    pub crank_side: f64,
    /// |DP|.
    #[serde(rename = "e")]
    pub follower_side: f64,
    /// Which intersection D takes: 1 = left of C -> B.
    #[serde(rename = "t1")]
    #[schemars(with = "i64")]
    pub assembly: AssemblyMode,
    /// Which side of C -> D carries P: 1 = left.
    #[serde(rename = "t2")]
    #[schemars(with = "i64")]
    pub side: CouplerSide,
}

impl NaturalCoordinates {
    /// Returns the numbers in the order Ax, Ay, Bx, By, a, b, c, d, e.
    pub fn numbers(&self) -> [f64; 9] {
        let ([ax, ay], [bx, by]) = (self.crank_pivot, self.follower_pivot);
        [ax, ay, bx, by, self.crank, self.coupler, self.follower, self.crank_side, self.follower_side]
    }
}

/// A four-bar as a vector loop (De Castro; Norton): pivots, link lengths and a polar coupler point.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct VectorLoop {
    /// O1, the crank's pivot.
    #[serde(rename = "O1")]
    pub crank_pivot: [f64; 2],
    /// O2, the follower's pivot.
    #[serde(rename = "O2")]
    pub follower_pivot: [f64; 2],
    /// L2, the crank.
    #[serde(rename = "L2")]
    pub crank: f64,
    /// L3, the coupler.
    #[serde(rename = "L3")]
    pub coupler: f64,
    /// L4, the follower.
    #[serde(rename = "L4")]
    pub follower: f64,
    /// Z1, the distance from the crank pin to the coupler point.
    #[serde(rename = "Z1")]
    pub coupler_point: f64,
    /// beta, from the coupler's line to the coupler point, in degrees.
    pub beta_deg: f64,
    /// Which intersection the follower pin takes.
    #[serde(rename = "t1")]
    #[schemars(with = "i64")]
    pub assembly: AssemblyMode,
}

impl FourBar {
    /// Builds a linkage from its natural coordinates.
    ///
    /// # Errors
    /// [`LinkageError`] when a number is not finite, a link a, b, c is not positive, d or e is negative or
    /// no triangle C-D-P exists (beyond [`FLAT_TOLERANCE`] of its perimeter).
    pub fn new(parameters: NaturalCoordinates) -> Result<Self, LinkageError> {
        let p = &parameters;
        for (key, value) in ["A", "A", "B", "B", "a", "b", "c", "d", "e"].into_iter().zip(p.numbers()) {
            if value.is_nan() || value.abs() > MAX_MAGNITUDE {
                return Err(LinkageError::NotFinite { key, value });
            }
        }
        for (key, value) in [("a", p.crank), ("b", p.coupler), ("c", p.follower)] {
            if value <= 0.0 {
                return Err(LinkageError::LengthNotPositive { key, value });
            }
        }
        Ok(FourBar {
            parameters,
            ground: (point(p.follower_pivot) - point(p.crank_pivot)).norm(),
            coupler_ratio: coupler_ratio(p.coupler, [p.crank_side, p.follower_side], p.side)?,
        })
    }

    /// Builds a linkage whose coupler point is given in the coupler's own frame: `offset` = P along and across C -> D,
    /// measured from C, as lengths.
    ///
    /// # Errors
    /// As [`FourBar::new`].
    pub fn with_coupler_offset(
        pivots: [Complex; 2],
        links: [f64; 3],
        offset: Complex,
        assembly: AssemblyMode,
    ) -> Result<Self, LinkageError> {
        let [crank, coupler, follower] = links;
        FourBar::new(NaturalCoordinates {
            crank_pivot: xy(pivots[0]),
            follower_pivot: xy(pivots[1]),
            crank,
            coupler,
            follower,
            crank_side: offset.norm(),
            follower_side: (offset - coupler).norm(),
            assembly,
            side: CouplerSide::of(offset.im),
        })
    }

    /// Builds a linkage from a vector loop: d = Z1, P at the angle beta from the coupler's line.
    ///
    /// # Errors
    /// As [`FourBar::new`]; a negative Z1 is a negative distance d.
    pub fn from_vector_loop(vector_loop: VectorLoop) -> Result<Self, LinkageError> {
        let v = vector_loop;
        if v.coupler_point < 0.0 {
            return Err(LinkageError::DistanceNegative { key: "Z1", value: v.coupler_point });
        }
        for (key, value) in [("Z1", v.coupler_point), ("beta_deg", v.beta_deg)] {
            if value.is_nan() || value.abs() > MAX_MAGNITUDE {
                return Err(LinkageError::NotFinite { key, value });
            }
        }
        FourBar::with_coupler_offset(
            [point(v.crank_pivot), point(v.follower_pivot)],
            [v.crank, v.coupler, v.follower],
            Complex::from_polar(v.coupler_point, v.beta_deg.to_radians()),
            v.assembly,
        )
    }

    /// Returns the linkage with every length and coordinate multiplied by a factor.
    ///
    /// # Errors
    /// As [`FourBar::new`], if a length leaves the allowed range.
    pub fn scaled(&self, factor: f64) -> Result<Self, LinkageError> {
        let p = self.parameters;
        FourBar::new(NaturalCoordinates {
            crank_pivot: p.crank_pivot.map(|x| x * factor),
            follower_pivot: p.follower_pivot.map(|x| x * factor),
            crank: p.crank * factor,
            coupler: p.coupler * factor,
            follower: p.follower * factor,
            crank_side: p.crank_side * factor,
            follower_side: p.follower_side * factor,
            ..p
        })
    }

    /// Returns the nine parameters and two signs.
    pub fn natural_coordinates(&self) -> NaturalCoordinates {
        self.parameters
    }

    /// Returns A, the fixed pivot of the crank.
    pub fn crank_pivot(&self) -> Complex {
        point(self.parameters.crank_pivot)
    }

    /// Returns B, the fixed pivot of the follower.
    pub fn follower_pivot(&self) -> Complex {
        point(self.parameters.follower_pivot)
    }

    /// Returns g = |AB|, the length of the ground link.
    pub fn ground(&self) -> f64 {
        self.ground
    }

    /// Returns a = |AC|, the length of the crank.
    pub fn crank(&self) -> f64 {
        self.parameters.crank
    }

    /// Returns b = |CD|, the length of the coupler.
    pub fn coupler(&self) -> f64 {
        self.parameters.coupler
    }

    /// Returns c = |BD|, the length of the follower.
    pub fn follower(&self) -> f64 {
        self.parameters.follower
    }

    /// Returns d = |CP|, the distance from the crank pin to the coupler point.
    pub fn crank_side(&self) -> f64 {
        self.parameters.crank_side
    }

    /// Returns e = |DP|, the distance from the follower pin to the coupler point.
    pub fn follower_side(&self) -> f64 {
        self.parameters.follower_side
    }

    /// Returns t1, the assembly mode.
    pub fn assembly(&self) -> AssemblyMode {
        self.parameters.assembly
    }

    /// Returns t2, the side of the coupler on which P lies.
    pub fn side(&self) -> CouplerSide {
        self.parameters.side
    }

    /// Returns the same linkage with the given assembly mode.
    #[must_use]
    pub fn with_assembly(mut self, assembly: AssemblyMode) -> Self {
        self.parameters.assembly = assembly;
        self
    }

    /// Returns the same linkage moved by the vector `by`.
    ///
    /// # Errors
    /// As [`FourBar::new`], if a coordinate leaves the allowed range.
    pub fn shifted(&self, by: Complex) -> Result<Self, LinkageError> {
        let mut parameters = self.parameters;
        parameters.crank_pivot = xy(self.crank_pivot() + by);
        parameters.follower_pivot = xy(self.follower_pivot() + by);
        FourBar::new(parameters)
    }

    /// Returns z = (l2 + i h2)/b, so that P = C + z (D - C) (Romero, equations 16 to 18).
    pub fn coupler_ratio(&self) -> Complex {
        self.coupler_ratio
    }

    /// Returns P along and across C -> D, measured from C, as lengths: b z.
    pub fn coupler_offset(&self) -> Complex {
        self.coupler_ratio * self.coupler()
    }

    /// Returns the lengths of ground, crank, coupler and follower.
    pub fn links(&self) -> [f64; 4] {
        [self.ground, self.crank(), self.coupler(), self.follower()]
    }

    /// Returns the length of the longest of ground, crank, coupler and follower.
    pub fn longest_link(&self) -> f64 {
        self.links().into_iter().fold(0.0, f64::max)
    }

    /// Returns longest / shortest of ground, crank, coupler, follower; infinite for coincident pivots.
    pub fn link_ratio(&self) -> f64 {
        self.longest_link() / self.links().into_iter().fold(f64::INFINITY, f64::min)
    }

    /// Returns arg(B - A), the direction of the ground line; 0 for coincident pivots.
    pub fn ground_angle(&self) -> f64 {
        if self.ground == 0.0 { 0.0 } else { (self.follower_pivot() - self.crank_pivot()).arg() }
    }
}

/// Computes z = (l2 + i h2)/b of the triangle C-D-P with the base b = |CD| and the sides d = |CP|, e = |DP| (Romero,
/// equations 16 to 18): P = C + z (D - C).
pub(in crate::mechanism) fn coupler_ratio(
    b: f64,
    [d, e]: [f64; 2],
    side: CouplerSide,
) -> Result<Complex, LinkageError> {
    for (key, value) in [("d", d), ("e", e)] {
        if value < 0.0 {
            return Err(LinkageError::DistanceNegative { key, value });
        }
    }
    // 16 area^2 = (b+d+e)(b+d-e)(d+e-b)(e+b-d): factored, so that a flat triangle is recognised to the last digit.
    let perimeter = b + d + e;
    let lacks = [b + d - e, d + e - b, e + b - d];
    if lacks.iter().any(|lack| *lack < -FLAT_TOLERANCE * perimeter) {
        return Err(LinkageError::NoCouplerTriangle { b, d, e });
    }
    let along = (b + (d - e) * (d + e) / b) / 2.0;
    let area_16_sq = lacks.iter().fold(perimeter, |product, lack| product * lack.max(0.0));
    let across = side.sign() * area_16_sq.sqrt() / (2.0 * b);
    Ok(Complex::new(along / b, across / b))
}

impl From<FourBar> for NaturalCoordinates {
    fn from(linkage: FourBar) -> Self {
        linkage.parameters
    }
}

impl TryFrom<NaturalCoordinates> for FourBar {
    type Error = LinkageError;
    fn try_from(parameters: NaturalCoordinates) -> Result<Self, LinkageError> {
        FourBar::new(parameters)
    }
}

impl std::fmt::Display for FourBar {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [ax, ay, bx, by, a, b, c, d, e] = self.parameters.numbers();
        let (t1, t2) = (self.assembly().sign(), self.side().sign());
        write!(f, "A ({ax}, {ay})  B ({bx}, {by})  a {a}  b {b}  c {c}  d {d}  e {e}  t1 {t1:+}  t2 {t2:+}")
    }
}
