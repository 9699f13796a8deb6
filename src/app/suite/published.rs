//! Evaluation of published answers: the vectors of the literature, judged by our own referee.
//!
//! A vector is [r1 ground, r2 crank, r3 coupler, r4 follower, rcx, rcy, x0, y0, theta0] with
//! P = (x0, y0) + e^{i theta0} (r2 e^{i theta2} + (rcx + i rcy) e^{i theta3}), both angles measured from the
//! ground line (Cabrera, Simon and Prado 2002, section 2). So A = (x0, y0), B = A + r1 e^{i theta0}, a = r2,
//! b = r3, c = r4, and P lies (rcx, rcy) along and across C -> D.

use crate::files::problem_file::Published;
use crate::judge::assess::assess;
use crate::judge::rank::compare;
use crate::mechanism::{AssemblyMode, Complex, FourBar};
use crate::record::Candidate;
use crate::synthesis::nearest::nearest_positions;
use crate::task::Problem;

/// Returns the linkage of a vector [ground, crank, coupler, follower, rcx, rcy, x0, y0, theta0], theta0 in radians.
///
/// `None` if the nine numbers do not form a linkage: a negative or zero link, a number that is not finite.
///
/// ```
/// use linkwright::AssemblyMode;
/// use linkwright::internals::app::suite::published::linkage_of;
/// let vector = [4.0, 1.0, 3.0, 3.0, 1.5, 2.0, 5.0, 6.0, 0.0];
/// let l = linkage_of(&vector, AssemblyMode::Plus).expect("four links and a point");
/// assert_eq!((l.follower_pivot().re, l.crank(), l.crank_side()), (9.0, 1.0, 2.5));
/// ```
pub fn linkage_of(vector: &[f64; 9], assembly: AssemblyMode) -> Option<FourBar> {
    let [ground, crank, coupler, follower, along, across, x, y, turned] = *vector;
    let a = Complex::new(x, y);
    let b = a + Complex::from_polar(ground, turned);
    let links = [crank, coupler, follower];
    FourBar::with_coupler_offset([a, b], links, Complex::new(along, across), assembly).ok()
}

/// Returns a published answer as a candidate of the problem, every figure and verdict by our referee.
///
/// Its points are met by the problem's timing ([`nearest_positions`]): with prescribed timing at the prescribed crank
/// angles, with the offset that suits the vector best if it is free; with free timing each at its nearest crank angle.
/// The crank angles that were published are not used. If the source does not give the assembly, the better one counts.
/// `None` without a vector, for numbers that do not form a linkage, and if the loop is open at a point.
pub fn evaluate(problem: &Problem, published: &Published) -> Option<Candidate> {
    let vector: &[f64; 9] = published.vector.as_slice().try_into().ok()?;
    let judged = |assembly: AssemblyMode| {
        let linkage = linkage_of(vector, assembly)?;
        let (crank_deg, assemblies) = nearest_positions(problem, linkage)?;
        assess(problem, linkage, &crank_deg, &assemblies)
    };
    match published.t1 {
        Some(assembly) => judged(assembly),
        None => [AssemblyMode::Plus, AssemblyMode::Minus]
            .into_iter()
            .filter_map(judged)
            .min_by(|one, other| compare(problem, one, other)),
    }
}
