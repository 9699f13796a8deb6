//! `front`: the trade-off between error, transmission angle, size and other figures.

use super::arguments::{Front, Synth};
use super::{Ended, refuse, synth};
use crate::synthesis::front::FrontRequest;

/// Runs the command.
pub fn run(options: Front) -> Result<Ended, Ended> {
    let Front { axes, points, .. } = options;
    let front = FrontRequest { axes, points: usize::from(points) };
    front.check().map_err(refuse)?;
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
        front: Some(front),
    })
}
