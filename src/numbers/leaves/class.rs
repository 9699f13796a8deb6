//! The questions that a proof answers: the class of linkages, the box of the chart, the known pivots and lengths.

/// The class of a linkage whose input turns fully, by its shortest link.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Class {
    /// The crank is the shortest link: a/g = p.
    CrankRocker,
    /// The ground is the shortest link: g/a = p.
    DoubleCrank,
}

impl Class {
    /// Both classes.
    pub const ALL: [Class; 2] = [Class::CrankRocker, Class::DoubleCrank];

    /// Returns the name in records.
    pub fn name(self) -> &'static str {
        match self {
            Class::CrankRocker => "crank-rocker",
            Class::DoubleCrank => "double-crank",
        }
    }
}

/// A box of the chart: p, phi_0, g, d.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// The lower ends of the sides.
    pub low: [f64; 4],
    /// The upper ends of the sides.
    pub high: [f64; 4],
}

/// The limits of lengths that bound kappa: [least, greatest] of the crank and of the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lengths {
    /// The limits of the crank's length, which is kappa.
    pub crank: [f64; 2],
    /// The limits of the ground's length: kappa/p (crank-rockers) or kappa p (double-cranks).
    pub ground: [f64; 2],
}

/// The known pivots, directions and limits if crank angles are from the x axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axis {
    /// The crank pivot A, if it is fixed.
    pub pivot: Option<[f64; 2]>,
    /// The direction of the ground line, if it is fixed.
    pub line: Option<Line>,
    /// The limits of crank and ground.
    pub lengths: Lengths,
    /// The limits of the ground's angle, degrees.
    pub limits_deg: Option<[f64; 2]>,
    /// A range that contains that of phi_0, which is minus the ground's angle, radians; 0 if that is fixed.
    pub phi: [f64; 2],
}

/// A fixed ground line. The problem is turned by it, so that phi_0 = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Line {
    /// The line's angle from the x axis, degrees.
    Angle(f64),
    /// The line from the fixed A to this B.
    To([f64; 2]),
}

impl Axis {
    /// Returns the ground's angle in degrees, if it is fixed.
    pub fn angle_deg(&self) -> Option<f64> {
        let [x, y] = self.pivot.unwrap_or_default();
        self.line.map(|line| match line {
            Line::Angle(angle) => angle,
            Line::To(b) => (b[1] - y).atan2(b[0] - x).to_degrees(),
        })
    }
}
