//! Exact problems: paths of nine precision points, motions of as many poses and points as a four-bar can meet, and paths of the
//! eight points that a linkage with a slider can meet, with free timing.
//!
//! Nine is the largest number of points that a four-bar's coupler curve can be made to pass through: a linkage has nine
//! parameters, and each point with a crank angle of its own takes one of them. A body on the coupler adds its angle there,
//! and a pose takes two: M poses and N points have finitely many answers if 2 M + N = 10 (the Alt-Burmester problems).
//! A fixed pivot that the problem gives takes two more. A linkage with a slider has eight parameters, and its coupler curve
//! passes eight points. Fewer leave a family, more have no exact answer in general, and with
//! prescribed timing only five points can be met.

use crate::mechanism::{Complex, LinkageKind};
use crate::numbers::nine_point::target::{Closure, Kind};
use crate::numbers::nine_point::{Target, TargetError};
use crate::task::pivot_on::PivotOn;
use crate::task::{Problem, Timing};
use std::f64::consts::{PI, TAU};

/// The largest number of points that a four-bar's coupler curve can be made to pass through; a fixed pivot that is given takes
/// two.
pub const PRECISION_POINTS: usize = 9;

/// The largest number of points that the coupler curve of a linkage with a slider can be made to pass through.
pub const SLIDER_POINTS: usize = 8;

/// Twice the number of poses and the number of points that a body on the coupler can be made to pass through.
pub const PRECISION_ROWS: usize = 10;

/// Distance, in parts of the target's size, and angle, radians, below which points and poses are one.
const COINCIDENT: f64 = 1e-9;

/// An exact problem as its solver takes it.
#[derive(Clone, Debug, PartialEq)]
pub struct Precise {
    /// The points and poses, the first pose before all others.
    pub target: Target,
    /// For each target of the task, in its order, its place among the target's points.
    pub places: Vec<usize>,
}

impl From<Target> for Precise {
    /// Takes nine points, or a target whose task has its points and poses in the same order.
    fn from(target: Target) -> Precise {
        Precise { places: (0..=target.displacements.kind.places()).collect(), target }
    }
}

/// The reason why a problem has no exact answers to list.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Refusal {
    /// The path does not have as many points as have finitely many answers.
    #[error(
        "method = \"continuation\" finds {} through exactly {wanted} points{}, this path has {points}",
        plural(*kind),
        given(*pivots)
    )]
    Points {
        /// The kind of linkages that are asked for.
        kind: LinkageKind,
        /// Number of points.
        points: usize,
        /// Number of points that would have finitely many answers.
        wanted: usize,
        /// Number of fixed pivots that the problem gives.
        pivots: usize,
    },
    /// The targets have not as many poses and points as have finitely many answers.
    #[error(
        "method = \"continuation\" finds linkages where twice the poses and the points make {wanted}{}; this task has {poses} \
         with an angle and {points} without",
        given(*pivots)
    )]
    Motion {
        /// Number of targets with an angle.
        poses: usize,
        /// Number of targets without one.
        points: usize,
        /// Twice the poses, and the points, that would have finitely many answers.
        wanted: usize,
        /// Number of fixed pivots that the problem gives.
        pivots: usize,
    },
    /// So many poses leave one link undetermined and determine the other more than once.
    #[error(
        "method = \"continuation\" does not take {poses} poses with one fixed pivot given: one link would have too much to \
         meet and the other too little"
    )]
    Lopsided {
        /// Number of poses.
        poses: usize,
    },
    /// The targets are pairs of angles.
    #[error("method = \"continuation\" finds linkages through points and poses, and this task is a function")]
    Function,
    /// The crank angles are given.
    #[error(
        "crank angles cannot be prescribed with method = \"continuation\": {} points take all the freedom",
        if kind.has_slider() { "eight" } else { "nine" }
    )]
    Timed {
        /// The kind of linkages that are asked for.
        kind: LinkageKind,
    },
    /// Several kinds of linkages are asked for.
    #[error("method = \"continuation\" finds every linkage of one kind, and several kinds are asked for")]
    Kinds,
    /// The kind of linkages is one whose equations are not solved.
    #[error("method = \"continuation\" does not find {}", plural(*kind))]
    Unsolved {
        /// The kind of linkages that are asked for.
        kind: LinkageKind,
    },
    /// The task has poses, and linkages with a slider are solved for through points alone.
    #[error("method = \"continuation\" finds {} through points alone, and this task has poses", plural(*kind))]
    SliderPoses {
        /// The kind of linkages that are asked for.
        kind: LinkageKind,
    },
    /// A fixed pivot is given, and the linkages asked for have a slider.
    #[error("method = \"continuation\" finds {} whose pivots are free, and here {} given", plural(*kind), match pivots {
        1 => "one is",
        _ => "both are",
    })]
    SliderPivots {
        /// The kind of linkages that are asked for.
        kind: LinkageKind,
        /// Number of fixed pivots that the problem gives.
        pivots: usize,
    },
    /// Two points coincide, two poses, or a point and a pose.
    #[error("targets {first} and {second} are one, and method = \"continuation\" needs different ones")]
    Coincident {
        /// Index of the one, counted from 0.
        first: usize,
        /// Index of the other, counted from 0.
        second: usize,
    },
    /// The coordinates are out of the range of the computation.
    #[error(transparent)]
    Numbers(#[from] TargetError),
}

impl Refusal {
    /// Returns the remedy to suggest.
    pub fn remedy(&self) -> &'static str {
        match self {
            Refusal::Points { points, wanted, .. } if points < wanted => {
                "give more points, or write method = \"auto\": so few leave a whole family of exact linkages"
            }
            Refusal::Points { .. } => {
                "give fewer points, or write method = \"auto\": so many can only be approached"
            }
            Refusal::Lopsided { .. } => "write method = \"auto\"",
            Refusal::Motion { poses, points, wanted, .. } if 2 * poses + points < *wanted => {
                "add targets, or write method = \"auto\": fewer leave a whole family of exact linkages"
            }
            Refusal::Motion { .. } => "write method = \"auto\": more targets can only be approached",
            Refusal::Function => "write method = \"auto\": up to five pairs are met exactly by it",
            Refusal::Numbers(_) => "choose another unit, or write method = \"auto\"",
            Refusal::Kinds => "name one of them in mechanism, or write method = \"auto\" to search for all",
            Refusal::Unsolved { .. } => "write mechanism = \"four-bar\", or method = \"auto\"",
            Refusal::SliderPoses { .. } => "write method = \"auto\", which fits them to poses too",
            Refusal::SliderPivots { .. } => "give the pivots room, or write method = \"auto\"",
            Refusal::Timed { .. } => "remove the crank angles, or write method = \"auto\" and keep them",
            Refusal::Coincident { .. } => "move one of the two, or write method = \"auto\"",
        }
    }
}

/// Returns the words for so many fixed pivots given.
fn given(pivots: usize) -> &'static str {
    match pivots {
        0 => "",
        1 => " where one fixed pivot is given",
        _ => " where both fixed pivots are given",
    }
}

/// Returns the fixed pivots A and B that the problem gives: by bounds without width, or by a point to be on.
fn pivots(problem: &Problem) -> [Option<Complex>; 2] {
    let spec = problem.spec();
    let on = spec.require.pivot_on.as_ref().map_or([None, None], PivotOn::both);
    let bounds = [&spec.design.crank_pivot, &spec.design.follower_pivot];
    std::array::from_fn(|i| {
        let by_bounds = bounds[i].filter(|[x, y]| x.is_fixed() && y.is_fixed());
        let by_bounds = by_bounds.map(|[x, y]| Complex::new(x.0, y.0));
        by_bounds.or_else(|| match on[i]?.fixed() {
            [Some(x), Some(y)] => Some(Complex::new(x, y)),
            _ => None,
        })
    })
}

/// Returns the name of a kind of linkages with finitely many answers, of more than one.
fn plural(kind: LinkageKind) -> &'static str {
    match kind {
        LinkageKind::FourBar => "linkages",
        LinkageKind::SliderCrank => "slider-cranks",
        LinkageKind::InvertedSliderCrank => "inverted slider-cranks",
        LinkageKind::SixBar => "six-bars",
        LinkageKind::EightBar => "eight-bars",
    }
}

/// Returns the closure by which the linkages of a kind are solved for; `None` for linkages of several loops.
pub fn closure_of(kind: LinkageKind) -> Option<Closure> {
    match kind {
        LinkageKind::FourBar => Some(Closure::FourBar),
        LinkageKind::SliderCrank => Some(Closure::SliderCrank),
        LinkageKind::InvertedSliderCrank => Some(Closure::InvertedSliderCrank),
        LinkageKind::SixBar | LinkageKind::EightBar => None,
    }
}

/// The kind of a problem's linkages, and the numbers of its poses and given pivots: they determine how many exact answers it has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Counted {
    /// The kind of linkages that are asked for; of several the first.
    pub kind: LinkageKind,
    /// The number of poses.
    pub poses: usize,
    /// The number of fixed pivots that the problem gives.
    pub pivots: usize,
}

/// Counts the poses of a problem and the fixed pivots that it gives.
pub fn counted(problem: &Problem) -> Counted {
    let poses = problem.task().body().map_or(0, |body| body.angles.iter().flatten().count());
    let kind = problem.spec().design.mechanism.first().copied().unwrap_or(LinkageKind::FourBar);
    Counted { kind, poses, pivots: pivots(problem).iter().flatten().count() }
}

/// Returns the points and poses of a problem that has exact answers.
///
/// # Errors
/// [`Refusal`]: the reason why it has none.
pub fn precise(problem: &Problem) -> Result<Precise, Refusal> {
    let task = problem.task();
    if problem.is_function() {
        return Err(Refusal::Function);
    }
    let Counted { kind, .. } = counted(problem);
    if problem.spec().design.mechanism.iter().any(|other| *other != kind) {
        return Err(Refusal::Kinds);
    }
    if !matches!(task.timing(), Timing::Free) {
        return Err(Refusal::Timed { kind });
    }
    match closure_of(kind) {
        None => Err(Refusal::Unsolved { kind }),
        Some(Closure::FourBar) => of_four_bars(problem),
        Some(closure) => of_sliders(problem, kind, closure),
    }
}

/// Returns the points of a problem of linkages with a slider.
fn of_sliders(problem: &Problem, kind: LinkageKind, closure: Closure) -> Result<Precise, Refusal> {
    let points = problem.task().points();
    let Counted { poses, pivots, .. } = counted(problem);
    if poses > 0 {
        return Err(Refusal::SliderPoses { kind });
    }
    if pivots > 0 {
        return Err(Refusal::SliderPivots { kind, pivots });
    }
    let own: [Complex; SLIDER_POINTS] = points.try_into().map_err(|_| Refusal::Points {
        kind,
        points: points.len(),
        wanted: SLIDER_POINTS,
        pivots,
    })?;
    all_differ(problem, &[None; SLIDER_POINTS])?;
    Ok(Target::with_slider(own, closure)?.into())
}

/// Checks that no two targets are one: points, poses with their angles, or a point and a pose.
fn all_differ(problem: &Problem, angles: &[Option<f64>]) -> Result<(), Refusal> {
    let (points, size) = (problem.task().points(), problem.task().size());
    for second in 1..points.len() {
        for first in 0..second {
            let turned = angles[first].zip(angles[second]).is_some_and(|(one, other)| {
                let apart = (other - one).rem_euclid(TAU);
                PI - (apart - PI).abs() > COINCIDENT
            });
            if !turned && (points[second] - points[first]).norm() <= COINCIDENT * size {
                return Err(Refusal::Coincident { first, second });
            }
        }
    }
    Ok(())
}

/// Returns the points and poses of a problem of four-bars.
fn of_four_bars(problem: &Problem) -> Result<Precise, Refusal> {
    let task = problem.task();
    let points = task.points();
    let angles: Vec<Option<f64>> =
        task.body().map_or_else(|| vec![None; points.len()], |body| body.angles.clone());
    let poses: Vec<usize> = (0..points.len()).filter(|j| angles[*j].is_some()).collect();
    let free: Vec<usize> = (0..points.len()).filter(|j| angles[*j].is_none()).collect();
    let given: Vec<Complex> = pivots(problem).into_iter().flatten().collect();
    let wanted = PRECISION_POINTS - 2 * given.len();
    if poses.is_empty() && points.len() != wanted {
        let kind = LinkageKind::FourBar;
        return Err(Refusal::Points { kind, points: points.len(), wanted, pivots: given.len() });
    }
    let wanted = PRECISION_ROWS - 2 * given.len();
    if !poses.is_empty() && 2 * poses.len() + free.len() != wanted {
        return Err(Refusal::Motion { poses: poses.len(), points: free.len(), wanted, pivots: given.len() });
    }
    let kind = Kind::new(poses.len().saturating_sub(1), given.len());
    if kind.classes() == 0 {
        return Err(Refusal::Lopsided { poses: poses.len() });
    }
    all_differ(problem, &angles)?;
    // The first pose, or the first point where there is none, then the points, then the other poses.
    let first = poses.first().copied().unwrap_or(0);
    let order: Vec<usize> = std::iter::once(first)
        .chain(free)
        .chain(poses)
        .enumerate()
        .filter_map(|(at, j)| (at == 0 || j != first).then_some(j))
        .collect();
    let mut places = vec![0; points.len()];
    for (place, j) in order.iter().enumerate() {
        places[*j] = place;
    }
    let others = || order[1..].iter().map(|j| (points[*j], angles[*j].zip(angles[first])));
    let of_points: Vec<Complex> = others().filter(|o| o.1.is_none()).map(|o| o.0).collect();
    let of_poses: Vec<(Complex, f64)> =
        others().filter_map(|(point, angles)| angles.map(|(own, first)| (point, own - first))).collect();
    let target = Target::mixed(points[first], &of_points, &of_poses, &given)?;
    Ok(Precise { target, places })
}
