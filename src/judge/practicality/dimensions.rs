//! The dimensions of each kind of linkage, whose errors shift the path, with the derivatives of P by them.
//!
//! | kind | dimensions |
//! |---|---|
//! | four-bar | Ax, Ay, Bx, By, a, b, c, d, e; coupler_x and coupler_y in place of d and e where P lies nearly on the line C-D |
//! | slider-crank | Ax, Ay, a, b, rail_from, rail_to, coupler_x, coupler_y |
//! | inverted slider-crank | Ax, Ay, Bx, By, a, offset, coupler_x, coupler_y |
//! | six-bar, eight-bar | Ax, Ay, a, Bx, By, b, c; of each further dyad X2x, X2y, Y2x, Y2y, X2F2, Y2F2; Px, Py, each on its own link |
//!
//! rail_from and rail_to move the line at the least and at the greatest place of D that is looked at to its left, the other
//! end held: with L between these places y_1 and y_2, a point at y moves by (y_2 - y)/L and by (y - y_1)/L. Errors of the
//! line are in this way lengths, as all others, and do not depend on the point by which a file gives it.

use super::sensitivity::At;
use crate::mechanism::four_bar::gradient::{follower_gradient, ground_gradient, shape_gradient};
use crate::mechanism::slider::SliderColumn;
use crate::mechanism::{
    Complex, CrankLinkage, FourBar, InvertedSliderCrank, MultiLoop, SliderCrank, SliderLinkage, cross, dot,
    turned,
};
use crate::task::Output;

/// The largest number of dimensions: those of an eight-bar.
pub(super) const MOST: usize = 21;

/// The derivatives by the dimensions, zero beyond their number, and by the crank angle.
pub(super) type Columns = ([Complex; MOST], Complex);

/// Distance of P from the line C-D, as a part of the larger of d and e, below which P counts as on that line.
pub const FLAT: f64 = 0.1;

const ZERO: Complex = Complex::new(0.0, 0.0);

/// The dimensions of a kind of linkage.
pub(super) trait Dimensions: Sync {
    /// Returns their names.
    fn names(&self) -> Vec<&'static str>;

    /// Computes dP by them and by the crank angle at a position; `None` at a toggle or if the loop is open.
    fn columns(&self, at: &At) -> Option<Columns>;

    /// Computes the turn of the direction from which crank angles of `offset = "ground"` count, by each dimension.
    fn of_ground(&self) -> [f64; MOST];

    /// Computes the shift by |AB| from those by the dimensions, B moved along A -> B; `None` without a ground link.
    fn by_ground(&self, shifts: &[Complex]) -> Option<Complex>;
}

/// Returns the dimensions of a linkage for its path at some positions.
pub(super) fn of_path(linkage: &CrankLinkage, positions: &[At]) -> Box<dyn Dimensions> {
    match *linkage {
        CrankLinkage::FourBar(linkage) => Box::new(OfFourBar { linkage, flat: is_flat(&linkage) }),
        CrankLinkage::SliderCrank(linkage) => Box::new(OfSliderCrank::new(linkage, positions)),
        CrankLinkage::InvertedSliderCrank(linkage) => Box::new(linkage),
        CrankLinkage::MultiLoop(linkage) => Box::new(linkage),
    }
}

/// Returns columns with zeros beyond them.
fn padded<const N: usize>(columns: [Complex; N]) -> [Complex; MOST] {
    let mut all = [ZERO; MOST];
    all[..N].copy_from_slice(&columns);
    all
}

/// Part of the longest link by which a dimension is moved either way for its derivative.
const STEP: f64 = 1e-6;

/// The derivatives are central differences.
impl Dimensions for MultiLoop {
    fn names(&self) -> Vec<&'static str> {
        const FURTHER: [[&str; 6]; 2] =
            [["X2x", "X2y", "Y2x", "Y2y", "X2F2", "Y2F2"], ["X3x", "X3y", "Y3x", "Y3y", "X3F3", "Y3F3"]];
        let further = FURTHER.iter().take(self.dyad_count() - 1).flatten().copied();
        let first = ["Ax", "Ay", "a", "Bx", "By", "b", "c"].into_iter();
        first.chain(further).chain(["Px", "Py"]).collect()
    }

    fn columns(&self, at: &At) -> Option<Columns> {
        let linkage = self.with_assembly(at.assembly);
        let (numbers, step) = (linkage.numbers(), STEP * linkage.longest());
        let mut columns = [ZERO; MOST];
        for (k, column) in columns.iter_mut().enumerate().take(numbers.len()) {
            let moved = |by: f64| {
                let mut numbers = numbers.clone();
                numbers[k] += by;
                linkage.with_numbers(&numbers)?.point_at(at.crank_angle)
            };
            *column = (moved(step)? - moved(-step)?) / (2.0 * step);
        }
        let turned = |by: f64| linkage.point_at(at.crank_angle + by);
        Some((columns, (turned(STEP)? - turned(-STEP)?) / (2.0 * STEP)))
    }

    fn of_ground(&self) -> [f64; MOST] {
        let [ax, ay, bx, by] = ground_gradient(self.crank_pivot(), self.follower_pivot());
        let mut all = [0.0; MOST];
        (all[0], all[1], all[3], all[4]) = (ax, ay, bx, by);
        all
    }

    fn by_ground(&self, shifts: &[Complex]) -> Option<Complex> {
        let ground = self.follower_pivot() - self.crank_pivot();
        Some((shifts[3] * ground.re + shifts[4] * ground.im) / ground.norm())
    }
}

/// Returns whether the coupler of a four-bar is measured by coupler_x and coupler_y.
pub fn is_flat(linkage: &FourBar) -> bool {
    linkage.coupler_offset().im.abs() < FLAT * linkage.crank_side().max(linkage.follower_side())
}

/// The turn of the line A -> B by Ax, Ay, Bx and By, the first four dimensions.
fn of_pivots(a: Complex, b: Complex) -> [f64; MOST] {
    let mut by = [0.0; MOST];
    by[..4].copy_from_slice(&ground_gradient(a, b));
    by
}

/// The shift by |AB| from those by Bx and By, the third and the fourth dimension.
fn along_ground(shifts: &[Complex], ground_angle: f64) -> Complex {
    let ground = Complex::from_polar(1.0, ground_angle);
    shifts[2] * ground.re + shifts[3] * ground.im
}

/// The dimensions of a four-bar.
struct OfFourBar {
    linkage: FourBar,
    flat: bool,
}

impl Dimensions for OfFourBar {
    fn names(&self) -> Vec<&'static str> {
        let [d, e] = if self.flat { ["coupler_x", "coupler_y"] } else { ["d", "e"] };
        vec!["Ax", "Ay", "Bx", "By", "a", "b", "c", d, e]
    }

    fn columns(&self, at: &At) -> Option<Columns> {
        let linkage = &self.linkage;
        if !self.flat {
            let (columns, by_crank) = linkage.with_assembly(at.assembly).gradient(at.crank_angle)?;
            return Some((padded(columns), by_crank));
        }
        let frame = linkage.frame(at.crank_angle, at.assembly)?;
        let gradient = shape_gradient(&frame, linkage.crank(), linkage.coupler(), linkage.coupler_offset())?;
        Some((padded(gradient.shape), gradient.crank_angle))
    }

    fn of_ground(&self) -> [f64; MOST] {
        of_pivots(self.linkage.crank_pivot(), self.linkage.follower_pivot())
    }

    fn by_ground(&self, shifts: &[Complex]) -> Option<Complex> {
        Some(along_ground(shifts, self.linkage.ground_angle()))
    }
}

/// The dimensions of a four-bar whose output counts: the derivatives are those of the follower's angle from the ground
/// line, degrees, as real parts.
struct OfOutput(FourBar);

impl Dimensions for OfOutput {
    fn names(&self) -> Vec<&'static str> {
        vec!["Ax", "Ay", "Bx", "By", "a", "b", "c", "d", "e"]
    }

    fn columns(&self, at: &At) -> Option<Columns> {
        let linkage = &self.0;
        let frame = linkage.frame(at.crank_angle, at.assembly)?;
        let (mut by_shape, by_crank) = follower_gradient(&frame, linkage.crank(), linkage.follower())?;
        let by_ground = ground_gradient(linkage.crank_pivot(), linkage.follower_pivot());
        by_shape.iter_mut().zip(by_ground).for_each(|(by, ground)| *by -= ground);
        let degrees = |radians: f64| Complex::new(radians.to_degrees(), 0.0);
        Some((padded(by_shape.map(degrees)), degrees(by_crank)))
    }

    fn of_ground(&self) -> [f64; MOST] {
        of_pivots(self.0.crank_pivot(), self.0.follower_pivot())
    }

    fn by_ground(&self, shifts: &[Complex]) -> Option<Complex> {
        Some(along_ground(shifts, self.0.ground_angle()))
    }
}

/// Returns the dimensions of a linkage whose output counts; `None` if it has no such output.
pub(super) fn of_output(
    linkage: &CrankLinkage,
    output: Output,
    positions: &[At],
) -> Option<Box<dyn Dimensions>> {
    match (*linkage, output) {
        (CrankLinkage::FourBar(linkage), Output::Angle) => Some(Box::new(OfOutput(linkage))),
        (CrankLinkage::FourBar(_), Output::Place) | (CrankLinkage::SliderCrank(_), Output::Angle) => None,
        (CrankLinkage::SliderCrank(linkage), Output::Place) => {
            Some(Box::new(OfSliderPlace(OfSliderCrank::new(linkage, positions))))
        }
        (CrankLinkage::MultiLoop(_), _) => None,
        (CrankLinkage::InvertedSliderCrank(linkage), output) => Some(Box::new(OfBlock { linkage, output })),
    }
}

/// Returns a derivative of an output as the real part of a column.
fn real(value: f64) -> Complex {
    Complex::new(value, 0.0)
}

/// The dimensions of a slider-crank whose output counts: the derivatives are those of the slider's place, as real parts.
struct OfSliderPlace(OfSliderCrank);

impl Dimensions for OfSliderPlace {
    fn names(&self) -> Vec<&'static str> {
        vec!["Ax", "Ay", "a", "b", "rail_from", "rail_to"]
    }

    fn columns(&self, at: &At) -> Option<Columns> {
        let linkage = SliderLinkage::with_assembly(self.0.linkage, at.assembly);
        let (mut shape, by_crank) = linkage.gradient(at.crank_angle)?;
        // The place counts from A's foot on the line: y - <A - Q, s>.
        let s = linkage.line_direction();
        let lag = SliderLinkage::crank_pivot(&linkage) - linkage.line_point();
        for (k, moved) in [(0, -s.re), (1, -s.im), (4, s.re), (5, s.im), (6, -dot(lag, turned(s)))] {
            shape[k].place += moved;
        }
        let [ax, ay, a, b, qx, qy, turn, ..] = shape.map(|column| real(column.place));
        let [from, to] = self.0.by_ends([qx, qy], turn);
        Some((padded([ax, ay, a, b, from, to]), real(by_crank.place)))
    }

    fn of_ground(&self) -> [f64; MOST] {
        self.0.of_ground()
    }

    fn by_ground(&self, _: &[Complex]) -> Option<Complex> {
        None
    }
}

/// The dimensions of an inverted slider-crank whose output counts: the derivatives are those of the block's place along the
/// coupler, or of its angle from the ground line, degrees, as real parts.
struct OfBlock {
    linkage: InvertedSliderCrank,
    output: Output,
}

impl Dimensions for OfBlock {
    fn names(&self) -> Vec<&'static str> {
        vec!["Ax", "Ay", "Bx", "By", "a", "offset"]
    }

    fn columns(&self, at: &At) -> Option<Columns> {
        let linkage = SliderLinkage::with_assembly(self.linkage, at.assembly);
        let (shape, by_crank) = linkage.gradient(at.crank_angle)?;
        let coupler = linkage.position(at.crank_angle).joints()?.coupler;
        let of = |column: &SliderColumn| match self.output {
            Output::Place => column.place,
            Output::Angle => (cross(coupler, column.coupler) / coupler.norm_sqr()).to_degrees(),
        };
        let mut columns = [ZERO; MOST];
        columns.iter_mut().zip(&shape[..6]).for_each(|(by, column)| *by = real(of(column)));
        if self.output == Output::Angle {
            // It counts from the ground line.
            let turned = self.of_ground();
            columns.iter_mut().zip(turned).for_each(|(by, turn)| *by -= real(turn.to_degrees()));
        }
        Some((columns, real(of(&by_crank))))
    }

    fn of_ground(&self) -> [f64; MOST] {
        Dimensions::of_ground(&self.linkage)
    }

    fn by_ground(&self, shifts: &[Complex]) -> Option<Complex> {
        Dimensions::by_ground(&self.linkage, shifts)
    }
}

/// The dimensions of a slider-crank.
struct OfSliderCrank {
    linkage: SliderCrank,
    /// The least and the greatest place of D, some length apart.
    ends: [f64; 2],
}

impl OfSliderCrank {
    fn new(linkage: SliderCrank, positions: &[At]) -> Self {
        let place = |at: &At| Some(linkage.position_with(at.crank_angle, at.assembly).joints()?.place);
        let [low, high] = crate::mechanism::least_and_greatest(positions.iter().filter_map(place));
        // Of one position: a rail as long as the links, which is tilted about nothing in particular.
        let short = linkage.longest();
        let ends = match high - low > 1e-9 * short {
            true => [low, high],
            false if low.is_finite() => [low - 0.5 * short, low + 0.5 * short],
            false => [0.0, short],
        };
        OfSliderCrank { linkage, ends }
    }

    /// Returns the derivatives by a shift of either end of the rail across it, from those by Q and by the line's angle.
    fn by_ends(&self, [qx, qy]: [Complex; 2], turn: Complex) -> [Complex; 2] {
        let across = turned(self.linkage.line_direction());
        let aside = qx * across.re + qy * across.im;
        let [from, to] = self.ends;
        let per = 1.0 / (to - from);
        [(aside * to - turn) * per, (turn - aside * from) * per]
    }
}

impl Dimensions for OfSliderCrank {
    fn names(&self) -> Vec<&'static str> {
        vec!["Ax", "Ay", "a", "b", "rail_from", "rail_to", "coupler_x", "coupler_y"]
    }

    fn columns(&self, at: &At) -> Option<Columns> {
        let linkage = SliderLinkage::with_assembly(self.linkage, at.assembly);
        let (shape, by_crank) = linkage.gradient(at.crank_angle)?;
        let [ax, ay, a, b, qx, qy, turn, x, y] = shape.map(|column| column.coupler_point);
        let [rail_from, rail_to] = self.by_ends([qx, qy], turn);
        Some((padded([ax, ay, a, b, rail_from, rail_to, x, y]), by_crank.coupler_point))
    }

    fn of_ground(&self) -> [f64; MOST] {
        let per = 1.0 / (self.ends[1] - self.ends[0]);
        let mut turns = [0.0; MOST];
        (turns[4], turns[5]) = (-per, per);
        turns
    }

    fn by_ground(&self, _: &[Complex]) -> Option<Complex> {
        None
    }
}

impl Dimensions for InvertedSliderCrank {
    fn names(&self) -> Vec<&'static str> {
        vec!["Ax", "Ay", "Bx", "By", "a", "offset", "coupler_x", "coupler_y"]
    }

    fn columns(&self, at: &At) -> Option<Columns> {
        let (shape, by_crank) = SliderLinkage::with_assembly(*self, at.assembly).gradient(at.crank_angle)?;
        let mut columns = [ZERO; MOST];
        columns.iter_mut().zip(shape).for_each(|(by, column)| *by = column.coupler_point);
        Some((columns, by_crank.coupler_point))
    }

    fn of_ground(&self) -> [f64; MOST] {
        of_pivots(SliderLinkage::crank_pivot(self), self.block_pivot())
    }

    fn by_ground(&self, shifts: &[Complex]) -> Option<Complex> {
        Some(along_ground(shifts, self.ground_angle()))
    }
}
