//! The outcome of a sweep: its table, and its plot over the varied keys.
//!
//! | module | holds |
//! |---|---|
//! | [`page`] | the page of a sweep: the plot, the best jobs, the reasons of refusals |
//! | [`plot`] | the plot of a sweep: the least rms error over one varied key as a line, or over two as a map of colours |
//! | [`summary`] | the summary of a sweep, gathered row by row in bounded memory |
//! | [`table`] | the rows of a sweep as a table for spreadsheets and scripts, line by line |

pub mod page;
pub mod plot;
pub mod summary;
pub mod table;
