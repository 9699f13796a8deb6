//! Verification of a front: every figure of its members, that none dominates another, and its knees.
//!
//! Whether a search could have found better members is not seen; each of the recorded ones is judged anew, and compared
//! with the others.

use super::Comparison;
use crate::judge::figures::figures;
use crate::judge::trade_off::{Wishes, are_equal, dominates, knees};
use crate::record::{
    Axis, Candidate, EQUAL_FIGURES, Figures, Front, LEAST_AXES, MOST_AXES, MOST_MEMBERS, Member, Record,
};

impl Comparison<'_> {
    /// Checks the front of a record, if there is one.
    pub(super) fn front(&mut self, record: &Record) {
        let Some(front) = &record.front else { return };
        let mut own = self.under("front.");
        own.request(front);
        if front.evaluations > record.evaluations.objective {
            let most = format!("at most {}, all evaluations", record.evaluations.objective);
            own.differ("evaluations", front.evaluations, most);
        }
        for (i, member) in front.members.iter().enumerate() {
            own.under(&format!("members {}: ", i + 1)).member(member);
        }
        own.trade_off(front);
        own.holds_the_closest(front, record);
    }

    /// Checks that no candidate has a smaller error than every member: the best on each axis are members.
    fn holds_the_closest(&mut self, front: &Front, record: &Record) {
        if front.members.is_empty() || front.points < front.axes.len() {
            return;
        }
        let n = self.problem.task().len();
        let wishes = Wishes::of(self.problem, &front.axes);
        for axis in front.axes.iter().filter(|axis| matches!(axis, Axis::Rms | Axis::Max)) {
            let least = front
                .members
                .iter()
                .map(|member| wishes.loss(&member.figures, *axis))
                .fold(f64::INFINITY, f64::min);
            let is_closer = |candidate: &&Candidate| {
                let whole = candidate.crank_deg.len() == n && candidate.t1_at.len() == n;
                let found = if whole && candidate.accepted { figures(self.problem, candidate) } else { None };
                found.is_some_and(|found| wishes.loss(&found, *axis) < least * (1.0 - EQUAL_FIGURES))
            };
            if let Some(closer) = record.candidates.iter().find(is_closer) {
                let found = format!("without candidate {}, whose {} is smaller", closer.rank, axis.name());
                self.differ("members", "the front", found);
            }
        }
    }

    /// Checks that the axes and the number of members can have been asked for.
    fn request(&mut self, front: &Front) {
        let axes = &front.axes;
        let names = || axes.iter().map(|axis| axis.name()).collect::<Vec<_>>().join(", ");
        if !(LEAST_AXES..=MOST_AXES).contains(&axes.len()) {
            self.differ("axes", names(), format!("{LEAST_AXES} to {MOST_AXES} axes"));
        }
        if (1..axes.len()).any(|i| axes[..i].contains(&axes[i])) {
            self.differ("axes", names(), "each axis once");
        }
        if !axes.contains(&Axis::Rms) && !axes.contains(&Axis::Max) {
            self.differ("axes", names(), "rms or max among them");
        }
        if !(1..=MOST_MEMBERS).contains(&front.points) {
            self.differ("points", front.points, format!("1 to {MOST_MEMBERS}"));
        }
        if front.members.len() > front.points {
            let found = format!("at most the {} that were asked for", front.points);
            self.differ("members", format!("{} of them", front.members.len()), found);
        }
    }

    /// Checks every figure and verdict of a member.
    fn member(&mut self, member: &Member) {
        let candidate = &member.candidate;
        self.same("rank", candidate.rank, 0);
        self.same("accepted", candidate.accepted, true);
        if !self.candidate(candidate) {
            return;
        }
        self.annotations(candidate);
        let Some(found) = figures(self.problem, candidate) else {
            return self.differ("figures", "there", "not there: every point is at a toggle");
        };
        self.figures_of(&member.figures, &found);
    }

    fn figures_of(&mut self, recorded: &Figures, found: &Figures) {
        let size = self.problem.task().size();
        let mut own = self.under("figures.");
        for axis in Axis::ALL {
            let (r, f) = (recorded.of(axis), found.of(axis));
            match axis {
                Axis::PeakTorque => own.peak_torque(recorded.peak_torque, found.peak_torque),
                Axis::Transmission => own.transmission("transmission_deg", r, f),
                Axis::LinkRatio | Axis::Sensitivity => own.number(axis.name(), r, f, 1.0),
                Axis::Rms | Axis::Max | Axis::Extent | Axis::Longest => own.number(axis.name(), r, f, size),
            }
        }
    }

    /// Checks that no member dominates or equals another, that they are in their order, and the knees.
    fn trade_off(&mut self, front: &Front) {
        let all: Vec<Figures> = front.members.iter().map(|member| member.figures).collect();
        let wishes = Wishes::of(self.problem, &front.axes);
        for (i, one) in all.iter().enumerate() {
            for (j, other) in all.iter().enumerate().filter(|(j, _)| i != *j) {
                if dominates(&wishes, one, other) {
                    self.differ(&format!("members {}", j + 1), "a member", format!("dominated by {}", i + 1));
                }
                if i < j && are_equal(&wishes, one, other) {
                    self.differ(&format!("members {}", j + 1), "a member", format!("equal to {}", i + 1));
                }
            }
        }
        if let Some(at) = all.windows(2).position(|pair| pair[0].rms > pair[1].rms) {
            let names = |a: usize, b: usize| format!("{a} before {b}");
            self.differ("the order of the members", names(at + 1, at + 2), names(at + 2, at + 1));
        }
        for (i, (member, knee)) in front.members.iter().zip(knees(&front.axes, &all)).enumerate() {
            self.same(&format!("members {}: knee", i + 1), member.knee, knee);
        }
    }
}
