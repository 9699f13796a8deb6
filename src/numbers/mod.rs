//! Numerical mathematics that knows nothing of linkages: a package of its own for each subject.

pub use linkwright_arithmetic as arithmetic;
pub use linkwright_bound as bound;
pub use linkwright_checker as checker;
pub use linkwright_leaves as leaves;
pub use linkwright_nine_point as nine_point;
pub use linkwright_optimise as optimise;
