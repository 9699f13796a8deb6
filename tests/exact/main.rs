//! Exact synthesis: every linkage through nine points.

mod equations;
mod solutions;
mod start_set;
