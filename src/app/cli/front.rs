//! `front`: the trade-off between error, transmission angle, size and other figures.

use super::arguments::{Front, Synth};
use super::{Ended, refuse, synth};
use crate::record::{Axis, LEAST_AXES, MOST_AXES};
use crate::synthesis::front::FrontRequest;

/// Runs the command.
pub fn run(options: Front) -> Result<Ended, Ended> {
    let Front { axes, points, .. } = options;
    check(&axes).map_err(refuse)?;
    synth::run(&Synth {
        files: vec![options.problem],
        out: options.out,
        method: None,
        search: options.search,
        set: options.set,
        no_advice: false,
        resume: options.resume,
        all: false,
        json: options.json,
        quiet: options.quiet,
        front: Some(FrontRequest { axes, points: usize::from(points) }),
    })
}

/// Checks the number of axes, that none is named twice, and that an error is among them.
fn check(axes: &[Axis]) -> Result<(), String> {
    let names: Vec<&str> = axes.iter().map(|axis| axis.name()).collect();
    let names = names.join(",");
    if !(LEAST_AXES..=MOST_AXES).contains(&axes.len()) {
        return Err(format!(
            "--axes {names}: name {LEAST_AXES} to {MOST_AXES} axes, such as rms,transmission,extent"
        ));
    }
    if let Some(twice) = (1..axes.len()).find(|&i| axes[..i].contains(&axes[i])) {
        return Err(format!("--axes {names}: {} is named twice; name each axis once", axes[twice].name()));
    }
    if !axes.contains(&Axis::Rms) && !axes.contains(&Axis::Max) {
        return Err(format!(
            "--axes {names}: add rms or max; without an error any small linkage is the best"
        ));
    }
    Ok(())
}
