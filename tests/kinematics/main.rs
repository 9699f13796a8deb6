//! Positions, motion, mobility, curves, chains and the referee, against reference implementations.

mod chain;
mod cognates;
#[path = "../common/coupler_points.rs"]
mod coupler_points;
mod dyad_chain_duals;
mod dyad_chains;
mod gradients;
mod literature;
mod loads;
mod loop_closure;
mod mobility;
mod motion;
mod multi_loop_plates;
mod multi_loops;
mod position;
mod practicality;
#[path = "../common/random.rs"]
mod random;
mod referee;
#[path = "../reference/mod.rs"]
mod reference;
mod slider_plates;
mod sliders;
#[path = "../common/thorough.rs"]
mod thorough;
