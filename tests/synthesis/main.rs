//! Searches: what they find, what a requirement costs, what they say about it.

mod answers;
mod body_populations;
mod certificate;
mod certificate_axis;
mod certificate_leaves;
mod certificate_resuming;
mod chart;
mod closing;
#[path = "../common/mod.rs"]
mod common;
mod conflicts;
mod costs;
mod derivatives;
mod deviation;
mod dyad_chains;
mod free_ranges;
mod functions;
mod invariance;
mod ladder;
mod load_images;
mod loads;
mod motion;
mod partly_timed;
mod pivot_lines;
#[path = "../common/poses.rs"]
mod poses;
mod projection;
mod properties;
#[path = "../common/random.rs"]
mod random;
mod reduced;
mod repeats;
mod requirements;
mod resuming;
#[path = "../common/ladder.rs"]
mod rungs;
mod search;
mod several_loops;
mod slider_functions;
mod slider_targets;
mod sliders;
mod snapping;
mod suite;
mod timed_motion;
mod timed_search;
