//! The library's own times, for the benchmark in `benches/python`: the same work without Python.

use crate::arrays::Input;
use crate::errors::{guarded, refused};
use crate::linkage::FourBar;
use crate::pools;
use crate::problem::Problem;
use linkwright::internals::app::job::run::{Context, run};
use pyo3::prelude::*;
use std::hint::black_box;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

/// Computes the position at each crank angle by `FourBar::position`, one at a time, into a vector of C, D and P that is
/// there; returns the seconds and the sum of the abscissas of P.
#[pyfunction]
pub fn _time_positions(py: Python<'_>, linkage: &FourBar, phi: &Bound<'_, PyAny>) -> PyResult<(f64, f64)> {
    guarded(|| {
        let angles = Input::of(phi, "phi")?;
        let numbers = angles.numbers()?;
        // Not zeros, whose memory the system would give when it is first written to.
        let mut found = vec![[[1.0; 2]; 3]; numbers.len()];
        Ok(py.detach(|| {
            let begun = Instant::now();
            for (place, angle) in found.iter_mut().zip(numbers) {
                *place = linkage
                    .file
                    .linkage
                    .position(black_box(*angle))
                    .joints()
                    .map_or([[f64::NAN; 2]; 3], |j| {
                        [j.crank_pin, j.follower_pin, j.coupler_point].map(|p| [p.re, p.im])
                    });
            }
            let seconds = begun.elapsed().as_secs_f64();
            (seconds, black_box(&found).iter().map(|[_, _, p]| p[0]).sum())
        }))
    })
}

/// Searches a problem so many times, one after the other in one thread pool; returns the seconds.
#[pyfunction]
pub fn _time_synth(
    py: Python<'_>,
    problem: &Bound<'_, Problem>,
    times: usize,
    threads: i64,
) -> PyResult<f64> {
    guarded(|| {
        let problem = problem.get();
        let pool = pools::take(pools::threads(Some(threads))?)?;
        let job = problem.job(&[])?;
        let seconds = py.detach(|| {
            pool.install(|| {
                let begun = Instant::now();
                for _ in 0..times {
                    let context = Context { cancel: &AtomicBool::new(false), observer: &|_| {} };
                    black_box(run(black_box(&job), &context)?);
                }
                Ok::<f64, linkwright::RunError>(begun.elapsed().as_secs_f64())
            })
        });
        pools::give_back(pool);
        seconds.map_err(refused)
    })
}
