//! The judge: every figure and verdict of a candidate, computed without a search; searches rank by them.
//!
//! | module | holds |
//! |---|---|
//! | [`assess`] | assessment of a candidate: every figure and verdict, from nothing but the problem, the linkage and its positions |
//! | [`certificate`] | certificates of a record: a certified lower bound of the sum of squares for prescribed timing, searched by `bound` and checked by `checker`, which shares with it the file format of the proofs alone |
//! | [`certified`] | certificates of single exact linkages through nine points, and the tolerances by which a linkage passes for one |
//! | [`cognates`] | Roberts cognates of the candidates: the other linkages of the same curve, judged under the problem |
//! | [`costs`] | costs of the active requirements: Lagrange multipliers at a candidate, as rates of the error per unit of a limit |
//! | [`error`] | structural errors: at the positions of the points, and to the whole coupler curve |
//! | [`exact_linkages`] | real solutions of the continuation as candidates: of each class the best of its mechanisms, judged as every candidate is |
//! | [`family`] | local dimension of the set of exact answers: detects whether an exact answer belongs to a family |
//! | [`figures`] | figures by which linkages are compared in a front, computed from a judged candidate alone |
//! | [`look`] | difference of two candidates, to tell distinct answers apart: by their joints at the first point, cognates included, and by their coupler curves |
//! | [`loosen`] | relaxation of a problem: each requirement as limits with an outward side |
//! | [`mechanisms`] | the mechanisms of a real solution: the six ways to build one class, each with its motion through the points |
//! | [`practicality`] | practicality of building a linkage: layers of its plates, clearances between its parts, and sensitivity of the path to errors of its dimensions |
//! | [`rank`] | ranking of candidates and choice of the distinct ones |
//! | [`referee`] | the referee: judges order, circuit and branch of a motion through target points |
//! | [`requirement`] | the judge's own arithmetic for each requirement: value, limit and whether it is met |
//! | [`symmetry`] | symmetries of a target, and the images of a linkage under them |
//! | `torque` | the peak torque of a candidate under the loads of its problem |
//! | [`trade_off`] | trade-offs between figures: dominance, the choice of the members of a front by hypervolume, and its knees |
//! | [`two_sided`] | two-sided distance of a path and a coupler curve: of each from the other, whatever the timing |
//! | [`unwrapped`] | crank angles unwrapped along the motion through the points |
//! | [`verify`] | verification of a record: every figure and verdict is recomputed from its problem and its linkages |
//! | [`warm`] | warm starts: a candidate as the start of another fit, of the same problem or of one whose limits have moved |
//! | [`warnings`] | warnings: reasons against building a linkage although it meets every requirement |

pub mod assess;
pub mod certificate;
pub mod certified;
pub mod cognates;
pub mod costs;
pub mod error;
pub mod exact_linkages;
pub mod family;
pub mod figures;
mod look;
pub mod loosen;
pub mod mechanisms;
pub mod practicality;
pub mod rank;
pub mod referee;
mod requirement;
pub mod symmetry;
mod torque;
pub mod trade_off;
pub mod two_sided;
pub mod unwrapped;
pub mod verify;
pub mod warm;
pub mod warnings;
