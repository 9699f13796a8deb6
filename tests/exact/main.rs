//! Exact synthesis: every linkage through nine points.

mod known;
mod listing;
mod mechanisms;
