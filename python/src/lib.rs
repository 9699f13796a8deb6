//! The extension module of the Python package `linkwright`: the library behind Python's types, and no mathematics of its
//! own.
//!
//! | module | holds |
//! |---|---|
//! | [`arrays`] | arrays of numpy in and out, with the rule of conversion |
//! | [`building`] | what it takes to build a linkage, as data |
//! | [`chain`] | the class of chains |
//! | [`doors`] | everything that the command line does beside synth, front and proofs |
//! | [`errors`] | exceptions, and the border that no panic crosses |
//! | [`linkage`] | the class of four-bars |
//! | [`memory`] | memory of large arrays, kept for the next ones |
//! | [`moving`] | figures of a moving linkage as arrays, for every kind of linkage |
//! | [`pools`] | thread pools that are kept between calls, fork-safe |
//! | [`problem`] | the class of problems |
//! | [`proving`] | proofs: verify and certify |
//! | [`run`] | the class of runs; synth, front and opening |
//! | [`slider`] | slider-cranks and inverted slider-cranks at many crank angles |
//! | [`sweeping`] | sweeps: plan, run, merge |
//! | [`timing`] | the library's own times, for the benchmark |
//! | [`values`] | values of Python as those of a problem file, and JSON as values of Python |
//! | [`waiting`] | work on a pool while the calling thread looks for signals |

mod arrays;
mod building;
mod chain;
mod doors;
mod errors;
mod linkage;
mod memory;
mod moving;
mod pools;
mod problem;
mod proving;
mod run;
mod slider;
mod sweeping;
mod timing;
mod values;
mod waiting;

use pyo3::prelude::*;

/// The extension module.
#[pymodule]
fn _linkwright(module: &Bound<'_, PyModule>) -> PyResult<()> {
    let py = module.py();
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add("ProblemError", py.get_type::<errors::ProblemError>())?;
    module.add("InternalError", py.get_type::<errors::InternalError>())?;
    module.add_class::<problem::Problem>()?;
    module.add_class::<run::Run>()?;
    module.add_class::<linkage::FourBar>()?;
    module.add_class::<linkage::Positions>()?;
    module.add_class::<linkage::Rates>()?;
    module.add_class::<chain::Chain>()?;
    module.add_class::<slider::SliderLinkage>()?;
    module.add_class::<slider::SliderRates>()?;
    module.add_function(wrap_pyfunction!(slider::slider_crank, module)?)?;
    module.add_function(wrap_pyfunction!(slider::inverted_slider_crank, module)?)?;
    module.add_function(wrap_pyfunction!(run::synth, module)?)?;
    module.add_function(wrap_pyfunction!(run::open, module)?)?;
    module.add_function(wrap_pyfunction!(run::parse_run, module)?)?;
    module.add_function(wrap_pyfunction!(doors::load, module)?)?;
    module.add_function(wrap_pyfunction!(doors::parse_linkage, module)?)?;
    module.add_function(wrap_pyfunction!(proving::verify, module)?)?;
    module.add_function(wrap_pyfunction!(proving::certify, module)?)?;
    module.add_function(wrap_pyfunction!(doors::compare, module)?)?;
    module.add_function(wrap_pyfunction!(doors::analyze, module)?)?;
    module.add_function(wrap_pyfunction!(doors::balance, module)?)?;
    module.add_function(wrap_pyfunction!(doors::build, module)?)?;
    module.add_function(wrap_pyfunction!(doors::snap, module)?)?;
    module.add_function(wrap_pyfunction!(doors::export, module)?)?;
    module.add_function(wrap_pyfunction!(doors::export_formats, module)?)?;
    module.add_function(wrap_pyfunction!(doors::suite, module)?)?;
    module.add_function(wrap_pyfunction!(doors::schema, module)?)?;
    module.add_function(wrap_pyfunction!(timing::_time_positions, module)?)?;
    module.add_function(wrap_pyfunction!(timing::_time_synth, module)?)?;
    module.add_function(wrap_pyfunction!(doors::_panic, module)?)?;
    module.add_function(wrap_pyfunction!(doors::_panic_here, module)?)?;
    module.add_function(wrap_pyfunction!(sweeping::sweep_plan, module)?)?;
    module.add_function(wrap_pyfunction!(sweeping::sweep_open, module)?)?;
    module.add_function(wrap_pyfunction!(sweeping::sweep_missing, module)?)?;
    module.add_function(wrap_pyfunction!(sweeping::sweep_run, module)?)?;
    module.add_function(wrap_pyfunction!(sweeping::sweep_merge, module)?)?;
    #[cfg(feature = "command")]
    module.add_function(wrap_pyfunction!(doors::main, module)?)?;
    Ok(())
}
