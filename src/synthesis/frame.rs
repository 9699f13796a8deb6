//! The canonical frame in which problems of free timing are searched: equal problems in other places, sizes, quarter
//! turns, mirror images, orders of the points and starts of a closed path have one frame, and so one list of answers.
//!
//! The target's box has its centre at the origin and the diagonal 1. Of the eight quarter turns and mirror images, the
//! two orders and (of a closed target whose last point does not repeat the first) the starts, those are taken whose
//! sequence of points, weights and tolerances comes first in the order of dictionaries; if several do, the target is
//! symmetric, and the limits decide. Coordinates are rounded to multiples of [`GRID`], so that rounding in the caller's
//! frame does not lead the search elsewhere.
//!
//! The candidates are taken back to the caller's frame and judged there. Those that reach the target so nearly that the
//! grid is noticed are fitted again first, to the target as it was given.
//!
//! A target that repeats its first point keeps its start, for that point counts twice, and so does one to whose first point
//! the motion may come back through all others: another start is another problem.

use super::constants::frame::{NOTICED, OTHERS, POLISH, SHARE};
use super::multistart::{LONG_FIT, judged, polish};
use super::{Context, Progress, SearchOutcome};
use crate::judge::assess::assess_on_curve;
use crate::judge::rank::{divided, sort};
use crate::judge::unwrapped::unwrapped;
use crate::judge::warm::start_at;
use crate::mechanism::four_bar::mobility::wrapped;
use crate::mechanism::{FourBar, LinkageType, MAX_MAGNITUDE, NaturalCoordinates};
use crate::record::{Candidate, CurveErrorRecord};
use crate::task::ranges::Reference;
use crate::task::similarity::{Numbering, Similarity};
use crate::task::spec::{Method, ProblemSpec};
use crate::task::{Problem, Return};
use rayon::prelude::*;
use std::cmp::Ordering;

/// The grid of the coordinates, in parts of the target's size. Rounding in the caller's frame, of a target ten sizes off
/// the origin, moves one of a hundred coordinates to the next multiple in one of a hundred targets.
pub(super) const GRID: f64 = 1.0 / (1_u64 << 36) as f64;

/// The canonical frame of a problem.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    similarity: Similarity,
    numbering: Numbering,
    /// The size of the target in the caller's frame.
    size: f64,
}

/// A target: the place with its weight and its tolerance, and the angle in degrees with its tolerance.
type Item = [f64; 6];

/// The angle of a target at which only the place counts: none that a body has.
const NO_ANGLE: f64 = 1e3;

/// An image of the target, and how it is made.
struct Image {
    items: Vec<Item>,
    similarity: Similarity,
    numbering: Numbering,
}

impl Frame {
    /// Returns the canonical frame of a problem.
    pub(super) fn of(problem: &Problem) -> Frame {
        let (spec, task) = (problem.spec(), problem.task());
        let (centre, size) = (task.centre(), task.size());
        let upright = Similarity { from: [centre.re, centre.im], scale: 1.0 / size, ..Similarity::IDENTITY };
        let mut bare = spec.clone();
        let path = &mut bare.task;
        (path.points, path.weight, path.tolerance, path.raw, path.body) =
            (Vec::new(), None, None, None, None);
        let items = items(&spec.placed(&upright).rounded(GRID));
        let mut least: Vec<Image> = Vec::new();
        for (mirrors, turns, reversed) in images() {
            let image =
                Image::of(&items, Similarity { mirrors, turns, ..upright }, reversed, rotates(problem));
            let order = least.first().map_or(Ordering::Less, |least| compare(&image.items, &least.items));
            if order.is_lt() {
                least.clear();
            }
            if order.is_le() {
                least.push(image);
            }
        }
        let limits = |image: &Image| {
            bare.placed(&image.similarity).renumbered(image.numbering).rounded(GRID).limits_of_place()
        };
        let first = least.into_iter().map(|image| (limits(&image), image)).min_by(|(one, _), (other, _)| {
            one.iter().zip(other).map(|(x, y)| x.total_cmp(y)).find(|o| o.is_ne()).unwrap_or(Ordering::Equal)
        });
        let (similarity, numbering) =
            first.map_or((upright, Numbering::IDENTITY), |(_, image)| (image.similarity, image.numbering));
        Frame { similarity, numbering, size }
    }

    /// Returns the image of a problem of this target in the frame; `None` if a number leaves the allowed range there.
    fn spec_of(&self, problem: &Problem) -> Option<ProblemSpec> {
        let spec = problem.spec().placed(&self.similarity).renumbered(self.numbering);
        spec.limits_of_place().iter().all(|limit| limit.abs() <= MAX_MAGNITUDE).then_some(spec)
    }

    /// Returns the image of a problem of this target in the frame, with rounded numbers and the evaluations that its search
    /// may use; `None` if it has none there
    /// because numbers leave their range or points become equal.
    pub(super) fn rounded(&self, problem: &Problem) -> Option<Problem> {
        let mut spec = self.spec_of(problem)?.rounded(GRID);
        spec.solve.evaluations -= reserve(problem);
        let image = Problem::on_grid(spec, GRID).ok()?;
        (image.task().repeats_first() == problem.task().repeats_first()).then_some(image)
    }

    /// As [`Frame::rounded`] with the numbers as they are.
    pub(super) fn exact(&self, problem: &Problem) -> Option<Problem> {
        Problem::new(self.spec_of(problem)?).ok()
    }

    /// Returns the image in the frame of a candidate, judged by `image`, the image of its problem; `None` if it does not
    /// close there.
    pub(super) fn there(&self, image: &Problem, candidate: &Candidate) -> Option<Candidate> {
        carried(image, candidate, &self.similarity, self.numbering, None)
    }

    /// Returns a candidate of the frame in the caller's frame, judged by `problem`; `None` if it does not close there.
    pub(super) fn back(&self, problem: &Problem, candidate: &Candidate) -> Option<Candidate> {
        carried(problem, candidate, &self.way_back(), self.numbering_back(candidate), None)
    }

    /// As [`Frame::back`] for a candidate that is not listed: its distances to its whole curve, which take most of the
    /// time of a verdict, are not computed again but scaled.
    fn glanced_back(&self, problem: &Problem, candidate: &Candidate) -> Option<Candidate> {
        let (size, there) = (self.size, &candidate.error.to_curve);
        let to_curve = CurveErrorRecord {
            sum_sq: there.sum_sq * size * size,
            rms: there.rms * size,
            max: there.max * size,
        };
        carried(problem, candidate, &self.way_back(), self.numbering_back(candidate), Some(to_curve))
    }

    fn way_back(&self) -> Similarity {
        Similarity { scale: self.size, ..self.similarity.inverse() }
    }

    fn numbering_back(&self, candidate: &Candidate) -> Numbering {
        self.numbering.inverse(candidate.crank_deg.len())
    }

    /// Reports the progress of a search in the frame, in the caller's units.
    pub(super) fn report(&self, context: Context<'_>, progress: &Progress) {
        let best_sum_sq = progress.best_sum_sq.map(|sum| sum * self.size * self.size);
        (context.observer)(&Progress { best_sum_sq, ..progress.clone() });
    }

    /// Returns a candidate fitted to its target as it was given, if that is accepted and no worse, and the evaluations
    /// used; `image` is the exact image of its problem.
    fn polished(
        &self,
        context: Context<'_>,
        image: &Problem,
        candidate: Candidate,
        evaluations: u64,
    ) -> (Candidate, u64) {
        let problem = context.problem;
        let noticed = candidate.accepted && candidate.error.rms <= NOTICED * self.size;
        let start = || start_at(image, &self.there(image, &candidate)?);
        let Some(start) = Some(start).filter(|_| noticed && evaluations > 0).and_then(|start| start()) else {
            return (candidate, 0);
        };
        let fit = polish(context.of(image), start, LONG_FIT, evaluations);
        let end = fit.end.and_then(|end| self.back(problem, &judged(image, &end)?));
        let better = end.filter(|c| c.accepted && c.error.objective <= candidate.error.objective);
        (better.unwrap_or(candidate), fit.evaluations)
    }

    /// Takes the candidates of a search of the image back: the distinct ones in their order there, so that ties end alike
    /// in every frame, and some of the others.
    fn take_back(&self, context: Context<'_>, outcome: &mut SearchOutcome) {
        let problem = context.problem;
        let judging = context.judging();
        outcome.others.truncate(OTHERS);
        let (listed, others) = (&outcome.candidates, &outcome.others);
        // The first one in any case: then there is an answer.
        let whole = |(i, c)| (i == 0 || judging.may_go_on()).then(|| self.back(problem, c))?;
        let glance = |c| judging.may_go_on().then(|| self.glanced_back(problem, c))?;
        let mut here: Vec<Option<Candidate>> = listed.par_iter().enumerate().map(whole).collect();
        let beside: Vec<Candidate> = others.par_iter().filter_map(glance).collect();
        let as_there = |(here, there): (&Option<Candidate>, &Candidate)| {
            here.as_ref().is_some_and(|here| here.accepted == there.accepted)
        };
        let accepts = |list: &[Candidate]| list.iter().any(|candidate| candidate.accepted);
        (outcome.candidates, outcome.others) =
            if here.iter().zip(listed).all(as_there) && (accepts(listed) || !accepts(&beside)) {
                (here.into_iter().flatten().collect(), beside)
            } else {
                // A linkage that only just met a limit there may miss it here.
                here.extend(others.par_iter().map(|c| self.back(problem, c)).collect::<Vec<_>>());
                let found = here.into_iter().flatten().collect();
                divided(problem, found, problem.spec().solve.candidates)
            };
    }

    /// Fits the candidates to the target as it was given, and ranks them.
    fn finish(&self, context: Context<'_>, outcome: &mut SearchOutcome) {
        let problem = context.problem;
        if reserve(problem) > 0
            && !context.stopped()
            && let Some(image) = self.exact(problem)
        {
            let left = problem.spec().solve.evaluations.saturating_sub(outcome.evaluations.objective);
            let each = POLISH.min(left / outcome.candidates.len().max(1) as u64);
            let candidates = std::mem::take(&mut outcome.candidates).into_par_iter();
            let done: Vec<(Candidate, u64)> =
                candidates.map(|candidate| self.polished(context, &image, candidate, each)).collect();
            for (candidate, evaluations) in done {
                outcome.evaluations += context.cost(evaluations);
                outcome.candidates.push(candidate);
            }
        }
        sort(problem, &mut outcome.candidates);
        for (rank, candidate) in (1..).zip(&mut outcome.candidates) {
            candidate.rank = rank;
        }
    }
}

/// Returns the evaluations of a budget that are kept for the fits to the target as it was given.
fn reserve(problem: &Problem) -> u64 {
    let solve = &problem.spec().solve;
    let polishes = !matches!(solve.method, Method::Genetic | Method::DifferentialEvolution);
    let most = POLISH.saturating_mul(solve.candidates as u64);
    if polishes { most.min(solve.evaluations / SHARE) } else { 0 }
}

/// Runs a search of a problem with free timing in its canonical frame, and takes the candidates back; in the caller's
/// frame if the problem has no image there.
pub(super) fn in_frame<E>(
    context: Context<'_>,
    frame: &Frame,
    search: impl Fn(Context<'_>) -> Result<SearchOutcome, E>,
) -> Result<SearchOutcome, E> {
    let Some(image) = frame.rounded(context.problem) else {
        return search(context).map(|outcome| outcome.measured(context));
    };
    let observer = |progress: &Progress| frame.report(context, progress);
    let mut outcome = search(Context { observer: &observer, ..context.of(&image) })?;
    frame.take_back(context, &mut outcome);
    frame.finish(context, &mut outcome);
    Ok(outcome)
}

/// Returns a candidate's image under a similarity and a renumbering, judged by `problem`; `None` if it does not close
/// there. Numbers that the grid moved off a limit are put back on it. `to_curve` as for [`assess_on_curve`].
fn carried(
    problem: &Problem,
    candidate: &Candidate,
    by: &Similarity,
    numbering: Numbering,
    to_curve: Option<CurveErrorRecord>,
) -> Option<Candidate> {
    let own = candidate.linkage.four_bar()?.natural_coordinates();
    let linkage = FourBar::new(NaturalCoordinates {
        crank_pivot: by.point(own.crank_pivot),
        follower_pivot: by.point(own.follower_pivot),
        crank: own.crank * by.scale,
        coupler: own.coupler * by.scale,
        follower: own.follower * by.scale,
        crank_side: own.crank_side * by.scale,
        follower_side: own.follower_side * by.scale,
        assembly: own.assembly,
        side: if by.mirrors { own.side.opposite() } else { own.side },
    })
    .ok()?;
    let angles = candidate.crank_deg.iter().map(|deg| wrapped(by.degrees(*deg).to_radians()));
    let assemblies = candidate.t1_at.iter().map(|t1| if by.mirrors { t1.opposite() } else { *t1 });
    let angles = numbering.list(&angles.collect::<Vec<_>>());
    let assemblies = numbering.list(&assemblies.collect::<Vec<_>>());
    let linkage = linkage.with_assembly(*assemblies.first()?);
    let (crank_deg, t1_at) = unwrapped(problem, linkage, angles, assemblies);
    let space = problem.space(linkage.side());
    let linkage = space.project_off_grid(&linkage, GRID, problem.task().size()).ok()?;
    let frame_deg = candidate.frame_deg.map(|frame| if by.mirrors { -frame } else { frame });
    assess_on_curve(problem, linkage, (&crank_deg, &t1_at), frame_deg.map(Reference::frame), to_curve)
}

/// Returns whether it makes no difference at which of its points the path begins: it is closed, no point counts twice,
/// and what is acceptable goes round it. A crank that rocks to and fro passes the points in order from one start alone.
fn rotates(problem: &Problem) -> bool {
    let task = problem.task();
    let turns = |kind: &LinkageType| kind.input_turns_fully() || *kind == LinkageType::ChangePoint;
    let goes_round = match task.comes_back() {
        Return::TurningOn => problem.types().iter().any(turns),
        Return::AroundTheCircuit => true,
        Return::Any => false,
    };
    task.closed() && !task.repeats_first() && (goes_round || !problem.order_required())
}

/// Returns the mirror images, quarter turns and orders of a target.
fn images() -> impl Iterator<Item = (bool, u8, bool)> {
    (0..16).map(|i| (i & 1 != 0, i / 2 % 4, i >= 8))
}

/// Returns the points of a problem with their weights and tolerances.
fn items(spec: &ProblemSpec) -> Vec<Item> {
    let path = &spec.task;
    let of = |list: &Option<Vec<f64>>, j: usize| list.as_ref().map_or(1.0, |list| list[j]);
    let body = path.body.as_ref();
    let angle = |j: usize| body.map_or(NO_ANGLE, |body| body.angle_deg[j].unwrap_or(NO_ANGLE));
    let item = |(j, &[x, y]): (usize, &[f64; 2])| {
        let tolerance_deg = body.map_or(1.0, |body| of(&body.tolerance_deg, j));
        [x, y, of(&path.weight, j), of(&path.tolerance, j), angle(j), tolerance_deg]
    };
    path.points.iter().enumerate().map(item).collect()
}

impl Image {
    /// Returns the image of a target under a similarity, in the order that is asked for; if it `rotates`, from the point
    /// at which the sequence is least.
    fn of(items: &[Item], similarity: Similarity, reversed: bool, rotates: bool) -> Image {
        let n = items.len();
        let end = Numbering { first: if reversed { n - 1 } else { 0 }, reversed };
        let mut items = end.list(items);
        for [x, y, _, _, angle, _] in &mut items {
            let turned = similarity.turned([*x, *y]);
            // Adding zero takes the sign off a zero.
            (*x, *y) = (turned[0] + 0.0, turned[1] + 0.0);
            if *angle != NO_ANGLE {
                *angle = similarity.direction(*angle) + 0.0;
            }
        }
        let first = if rotates { least_rotation(&items) } else { 0 };
        items.rotate_left(first);
        Image { items, similarity, numbering: Numbering { first: end.place(first, n), reversed } }
    }
}

fn compare_items(one: &Item, other: &Item) -> Ordering {
    let orders = one.iter().zip(other).map(|(x, y)| x.total_cmp(y));
    orders.fold(Ordering::Equal, Ordering::then)
}

fn compare(one: &[Item], other: &[Item]) -> Ordering {
    one.iter().zip(other).map(|(x, y)| compare_items(x, y)).find(|o| o.is_ne()).unwrap_or(Ordering::Equal)
}

/// Returns the start of the rotation of a sequence that comes first in the order of dictionaries, in linear time: two
/// starts are compared item by item, and where they differ none of the starts passed by the greater one can be the
/// least.
fn least_rotation(items: &[Item]) -> usize {
    let n = items.len();
    let (mut one, mut other, mut alike) = (0, 1, 0);
    while one < n && other < n && alike < n {
        match compare_items(&items[(one + alike) % n], &items[(other + alike) % n]) {
            Ordering::Equal => {
                alike += 1;
                continue;
            }
            Ordering::Greater => one += alike + 1,
            Ordering::Less => other += alike + 1,
        }
        alike = 0;
        other += usize::from(one == other);
    }
    one.min(other)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanism::{AssemblyMode, Complex};
    use crate::numbers::arithmetic::streams::{Stream, below, stream, uniform};
    use crate::synthesis::fixture;

    /// Returns a closed curve of `n` points that is not symmetric, with limits that are not symmetric either.
    fn problem(draws: &mut Stream, n: usize, require: &str) -> Problem {
        let (phase, part) = (uniform(draws, 0.0, 6.0), uniform(draws, 0.1, 0.3));
        let points: Vec<[f64; 2]> = (0..n)
            .map(|j| {
                let t = std::f64::consts::TAU * j as f64 / n as f64;
                [3.0 * t.cos() + 7.0, 2.0 * t.sin() + part * (3.0 * t + phase).cos()]
            })
            .collect();
        fixture::problem(&points, true, require)
    }

    const BOXES: &str = "pivots_in = [-5, -6, 22, 17]\nfootprint_in = [-40, -30, 50, 60]\ndirection = \"ccw\"\n\
                         extent_max = 90\n[design]\nground_angle_deg = [-20, 50]\nground = [0.5, 40]";

    /// Returns the image of a problem in its frame.
    fn framed(spec: ProblemSpec) -> ProblemSpec {
        let problem = Problem::new(spec).expect("a path");
        Frame::of(&problem).rounded(&problem).expect("an image").spec().clone()
    }

    #[test]
    fn all_images_of_a_problem_have_one_image_in_the_frame() {
        let draws = &mut stream(1, 0);
        for (n, require) in [(20, ""), (33, BOXES), (60, BOXES)] {
            let spec = problem(draws, n, require).spec().clone();
            let one = framed(spec.clone());
            for (mirrors, turns, reversed) in images() {
                let to = [uniform(draws, -9.0, 9.0), uniform(draws, -9.0, 9.0)];
                let scale = uniform(draws, 0.1, 10.0);
                let by = Similarity { mirrors, turns, scale, to, ..Similarity::IDENTITY };
                let numbering = Numbering { first: below(draws, n), reversed };
                assert_eq!(framed(spec.placed(&by).renumbered(numbering)), one, "{by:?} {numbering:?}");
            }
        }
    }

    #[test]
    fn the_limits_decide_between_the_images_of_a_symmetric_target() {
        // A rectangle, and a box that has none of its symmetries.
        let corners = [[0.0, 0.0], [2.0, 0.0], [4.0, 0.0], [4.0, 1.0], [2.0, 1.0], [0.0, 1.0]];
        let spec = fixture::problem(&corners, true, "pivots_in = [-3, -2, 5, 6]").spec().clone();
        let one = framed(spec.clone());
        for (mirrors, turns, reversed) in images() {
            let by = Similarity { mirrors, turns, ..Similarity::IDENTITY };
            let image = spec.placed(&by).renumbered(Numbering { first: 2, reversed });
            assert_eq!(framed(image), one, "{mirrors} {turns} {reversed}");
        }
    }

    #[test]
    fn a_path_keeps_its_start_where_that_counts() {
        let draws = &mut stream(4, 0);
        let any_start = |require: &str| rotates(&problem(&mut draws.clone(), 12, require));
        assert!(any_start("") && any_start("branch = \"any\"\ntype = [\"triple-rocker\"]"));
        assert!(!any_start("closing = \"any\"") && any_start("closing = \"any\"\norder = \"any\""));
        assert!(!any_start("type = [\"triple-rocker\"]"));
        let mut spec = problem(draws, 12, "").spec().clone();
        let first = spec.task.points[0];
        spec.task.points.push(first);
        assert!(!rotates(&Problem::new(spec).expect("a path")));
    }

    #[test]
    fn candidates_keep_their_verdicts_there_and_come_back() {
        let draws = &mut stream(2, 0);
        let linkage = fixture::linkage([4.0, 1.5, 3.5, 3.2]);
        for case in 0..24 {
            let problem = problem(draws, 12, BOXES);
            let linkage = linkage.shifted(Complex::new(3.0, -2.0)).expect("a linkage");
            let way = if case % 2 == 0 { 1.0 } else { -1.0 };
            let from = uniform(draws, -180.0, 180.0);
            let assembly = if case % 3 == 0 { AssemblyMode::Minus } else { AssemblyMode::Plus };
            let (deg, t1): (Vec<f64>, Vec<AssemblyMode>) =
                (0..12).map(|j| (from + way * 29.0 * f64::from(j), assembly)).unzip();
            let own = assess_on_curve(&problem, linkage.with_assembly(assembly), (&deg, &t1), None, None)
                .expect("it closes");
            let frame = Frame::of(&problem);
            let image = frame.exact(&problem).expect("an image");
            let there = frame.there(&image, &own).expect("it closes there");
            let size = problem.task().size();
            let near = |one: f64, other: f64| (one - other).abs() <= 1e-11 * (1.0 + one.abs());
            assert!(near(there.error.rms * size, own.error.rms), "{case}");
            assert!(near(there.transmission_deg.worst, own.transmission_deg.worst));
            let met = |c: &Candidate| -> Vec<(String, bool)> {
                c.requirements.iter().map(|r| (r.name.clone(), r.met)).collect()
            };
            // A quarter turn takes the rows of x and y to each other.
            let sorted = |c: &Candidate| {
                let mut rows = met(c);
                rows.sort();
                rows.iter().map(|(name, met)| (name.replace(['x', 'y'], ""), *met)).collect::<Vec<_>>()
            };
            assert_eq!(sorted(&there).len(), sorted(&own).len());
            assert!(
                met(&own)
                    .iter()
                    .all(|(name, is)| name.contains("design.") || met(&there).contains(&(name.clone(), *is)))
            );
            assert_eq!((there.accepted, there.defects.len()), (own.accepted, own.defects.len()));
            let back = frame.back(&problem, &there).expect("it closes");
            let numbers = |c: &Candidate| c.linkage.numbers();
            assert!(numbers(&own).iter().zip(numbers(&back)).all(|(x, y)| near(*x, y)));
            let turns = (own.crank_deg[0] - back.crank_deg[0]) / 360.0;
            let whole = 360.0 * turns.round();
            assert!(
                own.crank_deg.iter().zip(&back.crank_deg).all(|(x, y)| (x - y - whole).abs() < 1e-9),
                "{case}"
            );
            assert_eq!((back.t1_at, back.accepted), (own.t1_at.clone(), own.accepted));
            let glanced = frame.glanced_back(&problem, &there).expect("it closes");
            assert!(near(glanced.error.to_curve.rms, own.error.to_curve.rms));
        }
    }

    #[test]
    fn the_least_rotation_is_that_of_a_comparison_of_all() {
        let draws = &mut stream(3, 0);
        for n in 1..40 {
            let items: Vec<Item> =
                (0..n).map(|_| [below(draws, 2) as f64, 0.0, 1.0, 1.0, NO_ANGLE, 1.0]).collect();
            let rotated = |first: usize| {
                let mut items = items.clone();
                items.rotate_left(first);
                items
            };
            let least = (0..n).map(rotated).min_by(|one, other| compare(one, other)).expect("items");
            assert_eq!(rotated(least_rotation(&items)), least);
        }
    }
}
