//! Numerical mathematics: packages of their own, each a folder beside this file, that use nothing of this package.
//!
//! | package | folder | holds |
//! |---|---|---|
//! | [`arithmetic`] | `arithmetic/lib.rs` | points of the plane, eight numbers side by side, double-double numbers, random streams |
//! | [`optimise`] | `optimise/lib.rs` | least squares (Levenberg-Marquardt), population searches, convex programs |
//! | [`nine_point`] | `nine_point/lib.rs` | all four-bars through nine points, or through poses, points and given pivots, by homotopy continuation |
//! | [`bound`] | `bound/lib.rs` | lower bounds of the sum of squares, by branch and bound |
//! | [`checker`] | `checker/lib.rs` | the independent check of the proofs of `bound` |
//! | [`leaves`] | `leaves/lib.rs` | the file format of those proofs |

pub use linkwright_arithmetic as arithmetic;
pub use linkwright_bound as bound;
pub use linkwright_checker as checker;
pub use linkwright_leaves as leaves;
pub use linkwright_nine_point as nine_point;
pub use linkwright_optimise as optimise;
