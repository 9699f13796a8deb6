//! Coupler points at many crank angles, eight at a time: the kernels in lanes as a search uses them.

use linkwright::internals::mechanism::four_bar::positions::LaneKernel;
use linkwright::internals::numbers::arithmetic::dispatch::vectorised;
use linkwright::internals::numbers::arithmetic::lane::{F64x8, LANES};

/// Coupler points and closure at many crank angles, as columns.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CouplerPoints {
    /// The x coordinates of P.
    pub x: Vec<f64>,
    /// The y coordinates of P.
    pub y: Vec<f64>,
    /// At least zero if the loop closes; if negative or NaN, x and y are meaningless.
    pub gap: Vec<f64>,
}

impl CouplerPoints {
    /// Allocates room for `n` positions, rounded up to a multiple of eight.
    pub fn with_room(n: usize) -> Self {
        let padded = n.next_multiple_of(LANES);
        CouplerPoints { x: vec![0.0; padded], y: vec![0.0; padded], gap: vec![0.0; padded] }
    }

    /// Computes the coupler point for each (cos, sin) pair, eight at a time. No allocation.
    ///
    /// # Panics
    /// When `cos` and `sin` differ in length, are no multiple of eight, or exceed the room.
    pub fn fill(&mut self, kernel: &(impl LaneKernel + Copy), cos: &[f64], sin: &[f64]) {
        assert_eq!(cos.len(), sin.len(), "as many cosines as sines");
        assert_eq!(cos.len() % LANES, 0, "pad the angles to a multiple of eight");
        let n = cos.len();
        let (x, y, gap) = (&mut self.x[..n], &mut self.y[..n], &mut self.gap[..n]);
        vectorised(
            #[inline(always)]
            || {
                // A copy that nothing else refers to stays in registers.
                let kernel = *kernel;
                for at in (0..n).step_by(LANES) {
                    let position = kernel.at(F64x8::load(cos, at), F64x8::load(sin, at));
                    position.coupler_point[0].store(x, at);
                    position.coupler_point[1].store(y, at);
                    position.gap.store(gap, at);
                }
            },
        );
    }
}
