//! Pages: what they have in common.

pub(super) mod page;
