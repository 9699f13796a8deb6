//! `balance`: a spring that lets a linkage stay where it is put, or counter-masses for an even torque and a quiet frame.

pub mod arguments;

use super::output::Output;
use super::{Ended, refuse, refuse_at, refuse_path, result, terminal};
use crate::app::balancing::{Asked, Means, NotBalanced, Subject};
use crate::files::generator::FileKind;
use crate::files::loads_file;
use crate::mechanism::four_bar::motion::CrankMotion;
use crate::mechanism::loads::balance::MassAim;
use arguments::{Balance, Even};

/// Runs the command.
pub fn run(options: &Balance) -> Result<Ended, Ended> {
    let (file, own) = result::read_loaded_linkage(&options.linkage)?;
    let loads = match &options.loads {
        Some(path) => Some(loads_file::load(path, &file).map_err(refuse_at)?),
        None => own,
    };
    let told = |why: NotBalanced| match (&why, why.option()) {
        (NotBalanced::NoUnit | NotBalanced::NoLoads, _) => refuse_path(&options.linkage, &why),
        (_, Some(option)) => refuse(format!("--{option}: {why}")),
        (_, None) => refuse(why),
    };
    let subject = Subject::new(file, loads).map_err(told)?;
    let found = subject.balance(&asked(options)?).map_err(told)?;
    let file = || subject.loads_file(&found);
    let inputs = [&options.linkage].into_iter().chain(&options.loads);
    let written =
        Output::new(inputs, options.force).write_asked(&[(&options.out, FileKind::Loads, &file)])?;
    if options.json {
        let text = found.json().map_err(|e| refuse(format!("the balance cannot be written as JSON: {e}")))?;
        terminal::answer(&(text + "\n"));
        return Ok(Ended::Good);
    }
    terminal::answer(&subject.text(&found, terminal::colour()));
    if let Some(path) = written.first() {
        terminal::answer(&format!("\n  Written to {path}: the loads with the balance.\n"));
    }
    Ok(Ended::Good)
}

/// Returns what is asked for.
fn asked(options: &Balance) -> Result<Asked, Ended> {
    let means = match (&options.spring, &options.torsion, &options.masses) {
        (Some(ends), _, _) => match ends.as_slice() {
            [from, to] => Means::Spring([from.clone(), to.clone()]),
            _ => return Err(refuse("--spring FROM TO has two ends")),
        },
        (None, Some(bodies), _) => {
            let against = bodies.get(1).cloned().unwrap_or_else(|| "ground".to_owned());
            Means::Torsion([bodies[0].clone(), against])
        }
        (None, None, Some(bodies)) => Means::Masses(bodies.clone()),
        (None, None, None) => {
            return Err(refuse("give --spring FROM TO, --torsion BODY or --masses BODY,.."));
        }
    };
    let over_deg = match options.over.as_deref() {
        None => None,
        Some([from, to]) => Some([*from, *to]),
        Some(_) => return Err(refuse("--over FROM,TO has two crank angles, degrees")),
    };
    Ok(Asked {
        means,
        over_deg,
        rates: options.rates.clone(),
        least_free_length: options.least_free_length,
        radius: options.radius,
        aim: match options.even {
            Even::Torque => MassAim::Torque,
            Even::ShakingForce => MassAim::ShakingForce,
            Even::Both => MassAim::Both,
        },
        speed_rad_s: options.omega.or(options.rpm.map(|rpm| CrankMotion::steady_rpm(rpm).speed_rad_s)),
    })
}
