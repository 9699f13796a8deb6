//! Balances as they are asked for, in the linkage's unit and in degrees: a spring or counter-masses, with the text and the file of
//! the result.

use crate::files::linkage_file::AnyLinkageFile;
use crate::files::loads_file;
use crate::mechanism::Unit;
use crate::mechanism::loads::balance::{
    BalanceError, MassAim, MassBalance, MassRequest, SpringBalance, SpringEnds, SpringRequest,
    balance_by_masses, balance_by_spring,
};
use crate::mechanism::loads::figures::MARGIN;
use crate::mechanism::loads::{Drive, LoadFault, Loads, Place};
use crate::report::Colour;
use crate::report::balance::{masses_text, spring_text};
use std::f64::consts::TAU;

/// The means of a balance.
#[derive(Clone, Debug, PartialEq)]
pub enum Means {
    /// A spring between two ends: a joint's name, a fixed point `x,y`, or a place on a body `coupler:x,y`.
    Spring([String; 2]),
    /// A torsion spring on a body, against another one.
    Torsion([String; 2]),
    /// Counter-masses on bodies.
    Masses(Vec<String>),
}

/// A balance that is asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct Asked {
    /// The means.
    pub means: Means,
    /// The crank angles over which a spring is to hold, degrees; absent: all that the crank reaches, less a degree at toggles.
    pub over_deg: Option<[f64; 2]>,
    /// The rates of the springs that can be bought, N/m or N m/rad; empty: any.
    pub rates: Vec<f64>,
    /// The least free length of a spring, in the linkage's unit.
    pub least_free_length: f64,
    /// The distance of counter-masses from the fixed pivots, in the linkage's unit.
    pub radius: Option<f64>,
    /// The quantity that counter-masses make even.
    pub aim: MassAim,
    /// The speed of the crank for counter-masses, rad/s; absent: that of the loads.
    pub speed_rad_s: Option<f64>,
}

/// A balance that cannot be computed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NotBalanced {
    /// The linkage has no unit.
    #[error("{fault}: {remedy}", fault = LoadFault::NoUnit, remedy = LoadFault::NoUnit.remedy())]
    NoUnit,
    /// The linkage has no loads.
    #[error("it has no loads to balance: add a table [loads] to the linkage's file, or give loads beside it")]
    NoLoads,
    /// A fixed point that is none.
    #[error("{0}: write a fixed point as two numbers, such as 50,80")]
    NoPoint(String),
    /// A place on a body that is none.
    #[error("{0}: write a place on a body as coupler:20,5")]
    NoPlace(String),
    /// The crank reaches several ranges.
    #[error("the crank has {0} ranges: name the one that is meant by two crank angles")]
    SeveralRanges(usize),
    /// Counter-masses without a radius.
    #[error("counter-masses need a radius, their distance from the fixed pivots")]
    NoRadius,
    /// A speed of the loads that is none.
    #[error("{0}; {remedy}", remedy = .0.remedy())]
    Speed(LoadFault),
    /// The mechanics refuse it.
    #[error(transparent)]
    Mechanics(#[from] BalanceError),
}

impl NotBalanced {
    /// Returns the option that has to be given or changed, if it is a single one.
    pub fn option(&self) -> Option<&'static str> {
        match self {
            NotBalanced::NoPoint(_) | NotBalanced::NoPlace(_) => Some("spring"),
            NotBalanced::SeveralRanges(_) => Some("over"),
            NotBalanced::NoRadius => Some("radius"),
            NotBalanced::NoUnit
            | NotBalanced::NoLoads
            | NotBalanced::Speed(_)
            | NotBalanced::Mechanics(_) => None,
        }
    }
}

/// A balance with what it was computed for.
#[derive(Clone, Debug)]
pub enum Balanced {
    /// By a spring, over a range of crank angles in degrees.
    Spring([f64; 2], SpringBalance),
    /// By counter-masses, at the motion of the crank.
    Masses(Drive, MassBalance),
}

/// A linkage under loads that are to be balanced.
#[derive(Clone, Debug)]
pub struct Subject {
    file: AnyLinkageFile,
    unit: Unit,
    loads: Loads,
}

impl Subject {
    /// Takes a linkage with its loads.
    ///
    /// # Errors
    /// [`NotBalanced::NoUnit`], [`NotBalanced::NoLoads`].
    pub fn new(file: AnyLinkageFile, loads: Option<Loads>) -> Result<Self, NotBalanced> {
        let unit = file.unit.ok_or(NotBalanced::NoUnit)?;
        let loads = loads.ok_or(NotBalanced::NoLoads)?;
        Ok(Subject { file, unit, loads })
    }

    /// Computes the balance that is asked for.
    ///
    /// # Errors
    /// [`NotBalanced`].
    pub fn balance(&self, asked: &Asked) -> Result<Balanced, NotBalanced> {
        let ends = match &asked.means {
            Means::Masses(bodies) => return self.by_masses(bodies, asked),
            Means::Spring([from, to]) => SpringEnds::Places([self.place(from)?, self.place(to)?]),
            Means::Torsion(bodies) => SpringEnds::Bodies(bodies.clone()),
        };
        let range = match asked.over_deg {
            Some(over) => over.map(f64::to_radians),
            None => self.whole_range()?,
        };
        let least_free_length = asked.least_free_length * self.metres();
        let request = SpringRequest { ends, range, rates: asked.rates.clone(), least_free_length };
        let found = balance_by_spring(&self.file.linkage, self.unit, &self.loads, &request)?;
        Ok(Balanced::Spring(range.map(f64::to_degrees), found))
    }

    fn by_masses(&self, bodies: &[String], asked: &Asked) -> Result<Balanced, NotBalanced> {
        let radius = asked.radius.ok_or(NotBalanced::NoRadius)? * self.metres();
        let drive = Drive::chosen(asked.speed_rad_s, 0.0, Some(&self.loads)).map_err(NotBalanced::Speed)?;
        let request = MassRequest { bodies: bodies.to_vec(), radius, aim: asked.aim, drive };
        let found = balance_by_masses(&self.file.linkage, self.unit, &self.loads, &request)?;
        Ok(Balanced::Masses(request.drive, found))
    }

    /// Returns the page of a balance.
    pub fn text(&self, balanced: &Balanced, colour: Colour) -> String {
        match balanced {
            Balanced::Spring(range, found) => spring_text(&self.file.name, self.unit, *range, found, colour),
            Balanced::Masses(drive, found) => masses_text(&self.file.name, self.unit, drive, found, colour),
        }
    }

    /// Returns the loads with the balance as a file of loads.
    pub fn loads_file(&self, balanced: &Balanced) -> String {
        let loads = match balanced {
            Balanced::Spring(_, found) => &found.loads,
            Balanced::Masses(_, found) => &found.loads,
        };
        loads_file::to_toml(&self.file.name, self.unit, loads)
    }

    fn metres(&self) -> f64 {
        self.unit.factor_to(Unit::M)
    }

    /// Returns the whole range of the crank less a degree at toggles, radians.
    fn whole_range(&self) -> Result<[f64; 2], NotBalanced> {
        let range = self.file.linkage.mechanism().crank_range();
        if range.turns_fully {
            return Ok([0.0, TAU]);
        }
        match range.arcs.as_slice() {
            [[from, to]] => Ok([from + MARGIN, to - MARGIN]),
            arcs => Err(NotBalanced::SeveralRanges(arcs.len())),
        }
    }

    /// Reads an end of a spring.
    fn place(&self, text: &str) -> Result<Place, NotBalanced> {
        let point = |text: &str| -> Option<[f64; 2]> {
            let (x, y) = text.split_once(',')?;
            let number = |text: &str| text.trim().parse::<f64>().ok().filter(|x| x.is_finite());
            Some([number(x)? * self.metres(), number(y)? * self.metres()])
        };
        if let Some((body, at)) = text.split_once(':') {
            let at = point(at).ok_or_else(|| NotBalanced::NoPlace(text.to_owned()))?;
            return Ok(Place::OnBody(body.to_owned(), at));
        }
        match point(text) {
            Some(at) => Ok(Place::Fixed(at)),
            None if text.contains(',') => Err(NotBalanced::NoPoint(text.to_owned())),
            None => Ok(Place::Joint(text.to_owned())),
        }
    }
}

impl Balanced {
    /// Returns the result as JSON.
    ///
    /// # Errors
    /// A number that JSON does not have.
    pub fn json(&self) -> Result<String, serde_json::Error> {
        match self {
            Balanced::Spring(_, found) => serde_json::to_string_pretty(found),
            Balanced::Masses(_, found) => serde_json::to_string_pretty(found),
        }
    }
}
