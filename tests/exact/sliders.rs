//! Every slider-crank and inverted slider-crank through eight points, beside a computation of their positions from their lengths.

use crate::common::thorough::cases;
use linkwright::internals::mechanism::{AssemblyMode, CrankLinkage, InvertedSliderCrank, SliderCrank};
use linkwright::internals::numbers::arithmetic::Complex;
use linkwright::internals::numbers::arithmetic::streams::{Stream, stream, uniform};
use linkwright::internals::numbers::nine_point::target::{Closure, Kind, STEPS};
use linkwright::internals::numbers::nine_point::{
    Class, Completeness, Options, Reality, Solution, Solved, Target, certify_all, not_proved_distinct,
    refine, solve,
};
use std::f64::consts::TAU;
use std::sync::atomic::AtomicBool;

/// Lengths of a linkage with a slider.
#[derive(Clone, Copy, Debug)]
pub struct Linkage {
    pub closure: Closure,
    /// The crank's pivot and its length.
    pub pivot: Complex,
    pub crank: f64,
    /// Of a slider-crank: the sliding pin in the frame of the coupler, whose origin is the crank's pin. Of an inverted one: a
    /// unit vector along the coupler line.
    pub slider: Complex,
    /// Of a slider-crank: the direction of the fixed line, of modulus one, and a point of it. Of an inverted one: the fixed
    /// pivot; the coupler line passes the crank's pin at the distance `offset`, to the left of `slider` if positive.
    pub line: Complex,
    pub at: Complex,
    pub offset: f64,
    /// The coupler point in the frame of the coupler.
    pub point: Complex,
}

impl Linkage {
    fn random(draws: &mut Stream, closure: Closure) -> Linkage {
        let mut next = |low: f64, high: f64| uniform(draws, low, high);
        let pivot = Complex::new(next(-1.0, 1.0), next(-1.0, 1.0));
        Linkage {
            closure,
            pivot,
            crank: next(0.4, 1.2),
            slider: match closure {
                Closure::InvertedSliderCrank => Complex::ONE,
                _ => Complex::new(next(0.6, 3.0), 0.0),
            },
            line: Complex::from_polar(1.0, next(0.0, TAU)),
            at: pivot + Complex::from_polar(next(0.2, 2.0), next(0.0, TAU)),
            offset: next(-0.6, 0.6),
            point: Complex::new(next(-2.0, 2.0), next(-2.0, 2.0)),
        }
    }

    /// Returns a random linkage with eight angles of its crank at which it closes well.
    pub fn with_eight_places(draws: &mut Stream, closure: Closure) -> (Linkage, Vec<f64>) {
        loop {
            let linkage = Linkage::random(draws, closure);
            let angles = linkage.eight_angles(draws);
            if angles.len() == STEPS {
                return (linkage, angles);
            }
        }
    }

    /// Returns up to eight angles of the crank, apart from each other, at which it closes well.
    fn eight_angles(&self, draws: &mut Stream) -> Vec<f64> {
        let mut angles: Vec<f64> = Vec::new();
        for _ in 0..200 {
            let angle = uniform(draws, 0.0, TAU);
            let clear = self.turns(angle).first().is_some_and(|(_, sine)| *sine > 0.1);
            if clear && angles.len() < STEPS && angles.iter().all(|other| (other - angle).abs() > 0.05) {
                angles.push(angle);
            }
        }
        angles
    }

    /// Returns the linkage as the program has it.
    pub fn linkage(&self) -> CrankLinkage {
        let (a, t1) = (self.pivot, AssemblyMode::Plus);
        match self.closure {
            Closure::SliderCrank => {
                let line = (self.at, self.line.arg());
                let lengths = [self.crank, self.slider.norm()];
                let frame = self.slider / self.slider.norm();
                SliderCrank::from_parts(a, lengths, line, self.point / frame, t1).map(CrankLinkage::from)
            }
            _ => {
                let point = self.point / self.slider;
                InvertedSliderCrank::from_parts([a, self.at], self.crank, self.offset, point, t1)
                    .map(CrankLinkage::from)
            }
        }
        .expect("a linkage")
    }

    /// Returns the directions of the coupler's frame at a crank angle, none or two, with the sine of the angle at which the
    /// slider's constraint is met.
    fn turns(&self, angle: f64) -> Vec<(Complex, f64)> {
        let pin = self.pivot + Complex::from_polar(self.crank, angle);
        if self.closure == Closure::SliderCrank {
            // The pin, |slider| from the crank's, at the line.
            let to_line = (self.at - pin) * self.line.conj();
            let length = self.slider.norm();
            let half = length * length - to_line.im * to_line.im;
            if half < 0.0 {
                return Vec::new();
            }
            [1.0, -1.0]
                .map(|sign| {
                    let along = Complex::new(sign * half.sqrt(), to_line.im) * self.line;
                    (along / self.slider, half.sqrt() / length)
                })
                .to_vec()
        } else {
            // The coupler line's direction w meets Im(conj(w) (at - pin)) = offset.
            let far = self.at - pin;
            let sine = self.offset / far.norm();
            if sine.abs() > 1.0 {
                return Vec::new();
            }
            let cosine = (1.0 - sine * sine).sqrt();
            [1.0, -1.0]
                .map(|sign| {
                    let w = far / far.norm() * Complex::new(sign * cosine, -sine);
                    (w / self.slider, cosine)
                })
                .to_vec()
        }
    }

    /// Returns P at a crank angle for each turn of the coupler, with the sine.
    pub fn places(&self, angle: f64) -> Vec<(Complex, f64)> {
        let pin = self.pivot + Complex::from_polar(self.crank, angle);
        self.turns(angle).into_iter().map(|(turn, sine)| (pin + turn * self.point, sine)).collect()
    }

    /// Returns the linkage of a real solution.
    fn of(target: &Target, closure: Closure, of: &Solution) -> Linkage {
        let origin = target.points[0];
        let [x, y] = of.pins.map(|z| origin + z * target.scale);
        let [a, b] = of.grounds.map(|z| origin + z * target.scale);
        let normal = (y - b) / (y - b).norm();
        let line = normal * Complex::I;
        Linkage {
            closure,
            pivot: a,
            crank: (x - a).norm(),
            slider: if closure == Closure::SliderCrank { y - x } else { line },
            line,
            at: if closure == Closure::SliderCrank { y } else { b },
            offset: (line.conj() * (b - x)).im,
            point: origin - x,
        }
    }

    pub fn extent(&self) -> f64 {
        self.crank + self.slider.norm() + self.point.norm() + (self.at - self.pivot).norm()
    }
}

/// Eight points of a random linkage with the solution that it is, in the frame of the target.
fn instance(closure: Closure, index: u64, line: Option<f64>) -> (Target, Solution) {
    let mut draws = stream(41 + closure as u64, index);
    loop {
        let mut linkage = Linkage::random(&mut draws, closure);
        if let Some(angle) = line {
            linkage.line = Complex::from_polar(1.0, angle);
        }
        let angles = linkage.eight_angles(&mut draws);
        if angles.len() < STEPS {
            continue;
        }
        let points: [Complex; STEPS] = std::array::from_fn(|j| linkage.places(angles[j])[0].0);
        let target = Target::with_slider(points, closure).expect("points that differ");
        let turns: Vec<Complex> = angles.iter().map(|angle| linkage.turns(*angle)[0].0).collect();
        let inside = |z: Complex| (z - points[0]) / target.scale;
        let x = linkage.pivot + Complex::from_polar(linkage.crank, angles[0]);
        let (n, n_s) = (target.displacements.delta[STEPS - 1], target.displacements.starred[STEPS - 1]);
        let (y, b) = if closure == Closure::SliderCrank {
            let normal = linkage.line * Complex::I;
            let y = inside(x + turns[0] * linkage.slider);
            (y, y - normal / (n_s * normal + n * normal.conj()))
        } else {
            let normal = turns[0] * linkage.slider * Complex::I;
            let b = inside(linkage.at);
            (b + normal / (n_s * normal + n * normal.conj()), b)
        };
        let pins = [inside(x), y];
        let grounds = [inside(linkage.pivot), b];
        let solution = Solution {
            pins,
            grounds,
            pins_starred: pins.map(|z| z.conj()),
            grounds_starred: grounds.map(|z| z.conj()),
            rotations: std::array::from_fn(|j| turns.get(j + 1).map_or(n / n_s, |turn| turn / turns[0])),
        };
        return (target, solution);
    }
}

fn solved(target: &Target) -> Solved {
    solve(target, &Options::default(), &|_, _| (), &AtomicBool::new(false))
}

/// Checks that a real class and its images draw through all points: the crank's angle from the solution, the coupler point from
/// the lengths.
fn passes(target: &Target, closure: Closure, class: &Class) {
    let refined = refine(&target.displacements, &class.solution).map_or(class.solution, |r| r.solution);
    for solution in refined.cognates(&target.displacements) {
        let linkage = Linkage::of(target, closure, &solution);
        for j in 0..STEPS {
            let turn = if j == 0 { Complex::ONE } else { solution.rotations[j - 1] };
            let pin = target.points[j] + solution.pins[0] * turn * target.scale;
            let angle = (pin - linkage.pivot).arg();
            let nearest = linkage
                .places(angle)
                .into_iter()
                .map(|(place, sine)| (place - target.points[j]).norm() * sine.max(1e-6))
                .fold(f64::INFINITY, f64::min);
            assert!(nearest <= 1e-10 * linkage.extent(), "{nearest:e} of {:e}", linkage.extent());
        }
    }
}

fn all_are_found(closure: Closure, count: u64) {
    let classes = Kind::of_points(closure).classes();
    let (mut real, mut proved) = (0, 0);
    for index in 0..count {
        let (target, generating) = instance(closure, index, None);
        let found = solved(&target);
        assert_eq!(found.completeness(), Completeness::Complete, "{index}: {:?}", found.census);
        assert_eq!(found.classes.len(), classes, "{index}");
        let of_it = |class: &&Class| class.solution.is_in_class_of(&generating, closure, 1e-7);
        let own: Vec<&Class> = found.classes.iter().filter(of_it).collect();
        assert_eq!(own.len(), 1, "{index}");
        assert_eq!(own[0].reality, Reality::Real, "{index}");
        for class in found.classes.iter().filter(|class| class.reality == Reality::Real) {
            passes(&target, closure, class);
            real += 1;
        }
        let solutions: Vec<Solution> = found.classes.iter().map(|class| class.solution).collect();
        let proofs = certify_all(&target, &solutions);
        let certificates: Vec<_> = proofs.iter().flatten().copied().collect();
        // Solutions that are next to multiple, or next to infinity, are too badly conditioned for a proof.
        assert!(certificates.len() + 6 >= classes, "{index}: {} proved", certificates.len());
        let apart = not_proved_distinct(&certificates);
        assert!(apart.is_empty(), "{index}: {apart:?}");
        for (proof, class) in proofs.iter().zip(&found.classes) {
            if let Ok(proof) = proof
                && proof.reality != Reality::Undecided
            {
                assert_eq!(proof.reality, class.reality, "{index}");
                proved += 1;
            }
        }
    }
    let all = count as usize * classes;
    assert!(proved * 100 >= all * 99, "{proved} of {all}");
    // A target of a linkage has itself, and as a rule dozens more.
    assert!(real >= 20 * count as usize, "{real}");
}

#[test]
fn all_slider_cranks_through_eight_points_are_found_and_the_one_that_drew_them_is_among_them() {
    all_are_found(Closure::SliderCrank, cases(8, 24));
}

#[test]
fn all_inverted_slider_cranks_through_eight_points_are_found_and_the_one_that_drew_them_is_among_them() {
    all_are_found(Closure::InvertedSliderCrank, cases(2, 20));
}

/// The direction of lines whose normal has no size: that of the n which targets have.
#[test]
fn lines_all_but_along_the_direction_that_is_left_out_are_found_too() {
    let (target, _) = instance(Closure::SliderCrank, 0, None);
    let left_out = target.displacements.delta[STEPS - 1].arg();
    for (index, off) in [1e-2, -1e-4, 1e-6].into_iter().enumerate() {
        let (target, generating) = instance(Closure::SliderCrank, index as u64, Some(left_out + off));
        let found = solved(&target);
        assert_eq!(found.completeness(), Completeness::Complete, "{off:e}: {:?}", found.census);
        let of_it = |class: &&Class| {
            class.reality == Reality::Real
                && class.solution.is_in_class_of(&generating, Closure::SliderCrank, 1e-7)
        };
        assert_eq!(found.classes.iter().filter(of_it).count(), 1, "{off:e}");
    }
}
