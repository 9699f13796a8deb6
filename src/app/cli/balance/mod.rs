//! `balance`: a spring that lets a linkage stay where it is put, or counter-masses for an even torque and a quiet frame.

pub mod arguments;

use super::output::Output;
use super::{Ended, refuse, refuse_at, refuse_path, result, terminal};
use crate::files::generator::FileKind;
use crate::files::linkage_file::AnyLinkageFile;
use crate::files::loads_file;
use crate::mechanism::Unit;
use crate::mechanism::four_bar::motion::CrankMotion;
use crate::mechanism::loads::balance::{
    MassAim, MassRequest, SpringEnds, SpringRequest, balance_by_masses, balance_by_spring,
};
use crate::mechanism::loads::figures::MARGIN;
use crate::mechanism::loads::{LoadFault, Loads, Place};
use crate::report::balance::{masses_text, spring_text};
use arguments::{Balance, Even};
use serde::Serialize;
use std::f64::consts::TAU;

/// Runs the command.
pub fn run(options: &Balance) -> Result<Ended, Ended> {
    let (file, own) = result::read_loaded_linkage(&options.linkage)?;
    let loads = match &options.loads {
        Some(path) => Some(loads_file::load(path, &file).map_err(refuse_at)?),
        None => own,
    };
    let Some(unit) = file.unit else {
        let fault = LoadFault::NoUnit;
        return Err(refuse_path(&options.linkage, format!("{fault}: {}", fault.remedy())));
    };
    let Some(loads) = loads else {
        let why =
            "it has no loads to balance: add a table [loads], or give a file of loads with --loads FILE";
        return Err(refuse_path(&options.linkage, why));
    };
    let given = Given { options, file: &file, unit, loads: &loads };
    if options.masses.is_some() { given.by_masses() } else { given.by_spring() }
}

/// A linkage with its loads and what is asked for.
struct Given<'a> {
    options: &'a Balance,
    file: &'a AnyLinkageFile,
    unit: Unit,
    loads: &'a Loads,
}

impl Given<'_> {
    fn metres(&self) -> f64 {
        self.unit.factor_to(Unit::M)
    }

    fn by_spring(&self) -> Result<Ended, Ended> {
        let ends = match (&self.options.spring, &self.options.torsion) {
            (Some(ends), _) => {
                let [from, to] = ends.as_slice() else { return Err(refuse("--spring FROM TO has two ends")) };
                SpringEnds::Places([self.place(from)?, self.place(to)?])
            }
            (None, Some(bodies)) => {
                let against = bodies.get(1).cloned().unwrap_or_else(|| "ground".to_owned());
                SpringEnds::Bodies([bodies[0].clone(), against])
            }
            (None, None) => return Err(refuse("give --spring FROM TO, --torsion BODY or --masses BODY,..")),
        };
        let range = self.range()?;
        let request = SpringRequest {
            ends,
            range,
            rates: self.options.rates.clone(),
            least_free_length: self.options.least_free_length * self.metres(),
        };
        let found = balance_by_spring(&self.file.linkage, self.unit, self.loads, &request).map_err(refuse)?;
        let degrees = range.map(f64::to_degrees);
        let text = || spring_text(&self.file.name, self.unit, degrees, &found, terminal::colour());
        self.deliver(&found, &found.loads, &text)
    }

    fn by_masses(&self) -> Result<Ended, Ended> {
        let options = self.options;
        let Some(radius) = options.radius else {
            return Err(refuse("--masses needs --radius R, the distance of the masses from their pivots"));
        };
        let speed = options.omega.or(options.rpm.map(|rpm| CrankMotion::steady_rpm(rpm).speed_rad_s));
        let speed = speed.or(self.loads.speed_rad_s).unwrap_or(0.0);
        let request = MassRequest {
            bodies: options.masses.clone().unwrap_or_default(),
            radius: radius * self.metres(),
            aim: match options.even {
                Even::Torque => MassAim::Torque,
                Even::ShakingForce => MassAim::ShakingForce,
                Even::Both => MassAim::Both,
            },
            speed,
        };
        let found = balance_by_masses(&self.file.linkage, self.unit, self.loads, &request).map_err(refuse)?;
        let rpm = speed * 60.0 / TAU;
        let text = || masses_text(&self.file.name, self.unit, rpm, &found, terminal::colour());
        self.deliver(&found, &found.loads, &text)
    }

    /// Returns the range of crank angles, radians: the one that is asked for, else the whole range of the crank less a degree at
    /// toggles.
    fn range(&self) -> Result<[f64; 2], Ended> {
        if let Some(over) = &self.options.over {
            let [from, to] = over.as_slice() else {
                return Err(refuse("--over FROM,TO has two crank angles, degrees"));
            };
            return Ok([from.to_radians(), to.to_radians()]);
        }
        let range = self.file.linkage.mechanism().crank_range();
        if range.turns_fully {
            return Ok([0.0, TAU]);
        }
        match range.arcs.as_slice() {
            [[from, to]] => Ok([from + MARGIN, to - MARGIN]),
            arcs => Err(refuse(format!(
                "the crank has {} ranges: name the one that is meant, --over FROM,TO",
                arcs.len()
            ))),
        }
    }

    /// Reads an end of a spring: a joint's name, a fixed point `x,y`, or a place on a body `coupler:x,y`.
    fn place(&self, text: &str) -> Result<Place, Ended> {
        let point = |text: &str| -> Option<[f64; 2]> {
            let (x, y) = text.split_once(',')?;
            let number = |text: &str| text.trim().parse::<f64>().ok().filter(|x| x.is_finite());
            Some([number(x)? * self.metres(), number(y)? * self.metres()])
        };
        if let Some((body, at)) = text.split_once(':') {
            let help = "write a place on a body as coupler:20,5";
            let at = point(at).ok_or_else(|| refuse(format!("--spring {text}: {help}")))?;
            return Ok(Place::OnBody(body.to_owned(), at));
        }
        match point(text) {
            Some(at) => Ok(Place::Fixed(at)),
            None if text.contains(',') => {
                Err(refuse(format!("--spring {text}: write a fixed point as two numbers, such as 50,80")))
            }
            None => Ok(Place::Joint(text.to_owned())),
        }
    }

    /// Writes the balanced loads where that is asked for, and prints the result.
    fn deliver(
        &self,
        found: &impl Serialize,
        loads: &Loads,
        text: &dyn Fn() -> String,
    ) -> Result<Ended, Ended> {
        let file = || loads_file::to_toml(&self.file.name, self.unit, loads);
        let inputs = [&self.options.linkage].into_iter().chain(&self.options.loads);
        let output = Output::new(inputs, self.options.force);
        let written = output.write_asked(&[(&self.options.out, FileKind::Loads, &file)])?;
        if self.options.json {
            let text = serde_json::to_string_pretty(found)
                .map_err(|e| refuse(format!("the balance cannot be written as JSON: {e}")))?;
            terminal::answer(&(text + "\n"));
            return Ok(Ended::Good);
        }
        terminal::answer(&text());
        if let Some(path) = written.first() {
            terminal::answer(&format!("\n  Written to {path}: the loads with the balance.\n"));
        }
        Ok(Ended::Good)
    }
}
