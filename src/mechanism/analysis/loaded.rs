//! Loads of an analysis: torque, joint forces and energies at each crank angle asked for, and figures over the crank's range.

use super::Analysis;
use super::driven::MechanismAnalysis;
use crate::mechanism::loads::{
    Drive, Instant, LoadError, LoadFault, LoadFigures, LoadKey, LoadedLinkage, Loads, Scratch,
};
use crate::mechanism::structure::{OutputBody, PairKind};
use crate::mechanism::{Linkage, Unit};
use serde::Serialize;

/// A pair of bodies by name.
#[derive(Clone, Debug, PartialEq)]
pub struct PairName {
    /// The name of the joint.
    pub at: String,
    /// The body on which the force acts.
    pub on: String,
    /// The body that it comes from.
    pub from: String,
    /// Whether the pair is a slider.
    pub slides: bool,
}

/// Loads of an analysis over the range of the crank.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LoadRecord {
    /// The pairs of bodies, in the order of the forces.
    #[serde(skip)]
    pub pairs: Vec<PairName>,
    /// The output; `None` for kinds without a certain one.
    #[serde(skip)]
    pub output: Option<OutputBody>,
    /// "left out".
    pub friction: &'static str,
    /// Figures over the range of the crank; absent of a linkage that closes at no crank angle.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub figures: Option<LoadFigures>,
}

fn prepared(linkage: &Linkage, unit: Option<Unit>, loads: &Loads) -> Result<LoadedLinkage, LoadError> {
    let no_unit = || LoadError { key: LoadKey::Top("unit"), fault: LoadFault::NoUnit };
    LoadedLinkage::new(linkage, unit.ok_or_else(no_unit)?, loads)
}

fn record(loaded: &LoadedLinkage, drive: &Drive) -> LoadRecord {
    let names = loaded.pairs().iter().map(|pair| {
        let [at, on, from] = loaded.names(pair).map(str::to_owned);
        PairName { at, on, from, slides: pair.kind == PairKind::Prismatic }
    });
    LoadRecord {
        pairs: names.collect(),
        output: loaded.output(),
        friction: "left out",
        figures: loaded.figures(drive),
    }
}

/// Returns the loads of a linkage over the range of its crank, at the crank's motion.
///
/// # Errors
/// [`LoadError`] if the loads do not fit the linkage, or there is no unit.
pub fn load_record(
    linkage: &Linkage,
    unit: Option<Unit>,
    loads: &Loads,
    drive: &Drive,
) -> Result<LoadRecord, LoadError> {
    prepared(linkage, unit, loads).map(|loaded| record(&loaded, drive))
}

/// Returns the result at a crank angle in degrees; `None` at one that is open, undetermined or a toggle.
fn at(loaded: &LoadedLinkage, crank_deg: f64, drive: &Drive, scratch: &mut Scratch) -> Option<Box<Instant>> {
    let angle = crank_deg.to_radians();
    let mut instant = loaded.at(angle, drive.motion(angle), scratch).ok()?;
    instant.input = drive.range().map(|_| drive.motion(angle));
    Some(Box::new(instant))
}

impl Analysis {
    /// Adds loads to every row of every configuration, and their figures for the linkage's own one.
    ///
    /// # Errors
    /// [`LoadError`] if the loads do not fit the linkage, or the analysis has no unit.
    pub fn add_loads(&mut self, loads: &Loads) -> Result<(), LoadError> {
        for configuration in &mut self.configurations {
            let loaded = prepared(&Linkage::FourBar(configuration.linkage), self.unit, loads)?;
            let scratch = &mut loaded.scratch();
            for row in &mut configuration.rows {
                row.loads = at(&loaded, row.crank_deg, &self.drive, scratch);
            }
            // The linkage's own configuration comes first.
            self.loads.get_or_insert_with(|| record(&loaded, &self.drive));
        }
        Ok(())
    }
}

impl MechanismAnalysis {
    /// Adds loads to every row, and their figures, of the linkage that was analysed.
    ///
    /// # Errors
    /// [`LoadError`] if the loads do not fit the linkage, or the analysis has no unit.
    pub fn add_loads(&mut self, linkage: &Linkage, loads: &Loads) -> Result<(), LoadError> {
        let loaded = prepared(linkage, self.unit, loads)?;
        let scratch = &mut loaded.scratch();
        for row in &mut self.rows {
            row.loads = at(&loaded, row.crank_deg, &self.drive, scratch);
        }
        self.loads = Some(record(&loaded, &self.drive));
        Ok(())
    }
}
