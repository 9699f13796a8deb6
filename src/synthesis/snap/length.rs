//! The lengths of a linkage that can be at a given value.

use crate::mechanism::multi_loop::LinkLength;
use crate::mechanism::{CrankLinkage, FourBar, MultiLoop};
use crate::task::spec::{DesignSpec, Limits};

/// A length of the linkage: the distance between two holes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Length {
    /// The ground length |AB|.
    Ground,
    /// The crank length |AC|.
    A,
    /// The coupler length |CD|.
    B,
    /// The follower length |BD|.
    C,
    /// The coupler side |CP| at the crank.
    D,
    /// The coupler side |DP| at the follower.
    E,
    /// The distance of two joints of one body of a six-bar or an eight-bar.
    Of(JointName, JointName),
}

/// A joint of a linkage of several loops, or P: its place in the order in which the two of a length are named.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct JointName(usize);

impl JointName {
    const NAMES: [&'static str; 11] = ["A", "B", "C", "D", "X2", "Y2", "F2", "X3", "Y3", "F3", "P"];

    /// Returns the joint of a name.
    pub fn named(name: &str) -> Option<Self> {
        Self::NAMES.iter().position(|own| *own == name).map(JointName)
    }

    /// Returns its name in files.
    pub fn name(self) -> &'static str {
        Self::NAMES[self.0]
    }
}

impl Length {
    /// The lengths of linkages of one loop.
    pub const OF_ONE_LOOP: [Length; 6] =
        [Length::Ground, Length::A, Length::B, Length::C, Length::D, Length::E];

    /// Returns all lengths of a linkage; of a body with many joints those of [`MultiLoop::lengths`].
    pub fn all(linkage: &CrankLinkage) -> Vec<Length> {
        match linkage.multi_loop() {
            None => Self::OF_ONE_LOOP.into_iter().filter(|length| length.of(*linkage).is_some()).collect(),
            // P may lie on a joint.
            Some(linkage) => {
                let lengths = linkage.lengths().into_iter().filter(|one| one.length > 0.0);
                lengths.filter_map(|one| Length::between(one.joints)).collect()
            }
        }
    }

    /// Returns the length between two joints.
    fn between(joints: [&str; 2]) -> Option<Length> {
        let mut ends = [JointName::named(joints[0])?, JointName::named(joints[1])?];
        ends.sort_unstable();
        let of_one_loop =
            Self::OF_ONE_LOOP.into_iter().find(|length| length.joints() == ends.map(JointName::name));
        Some(of_one_loop.unwrap_or(Length::Of(ends[0], ends[1])))
    }

    /// Returns the names of the joints that it lies between.
    fn joints(self) -> [&'static str; 2] {
        match self {
            Length::Ground => ["A", "B"],
            Length::A => ["A", "C"],
            Length::B => ["C", "D"],
            Length::C => ["B", "D"],
            Length::D => ["C", "P"],
            Length::E => ["D", "P"],
            Length::Of(one, other) => [one.name(), other.name()],
        }
    }

    /// Returns whether both of its joints are among these.
    pub(super) fn lies_between(self, names: &[&str]) -> bool {
        self.joints().iter().all(|joint| names.contains(joint))
    }

    /// Returns the name of the later of its joints.
    pub(super) fn last_joint(self) -> &'static str {
        self.joints()[1]
    }

    /// Returns its key in files, its value in a linkage of one loop and its place in the design table; `None` of those that only
    /// linkages of several loops have.
    fn entry(self) -> Option<Entry> {
        Some(match self {
            Length::Ground => ("ground", CrankLinkage::ground, |design| &mut design.ground),
            Length::A => ("a", |linkage| Some(linkage.crank()), |design| &mut design.a),
            Length::B => ("b", CrankLinkage::coupler, |design| &mut design.b),
            Length::C => ("c", |linkage| linkage.four_bar().map(FourBar::follower), |design| &mut design.c),
            Length::D => ("d", |linkage| Some(linkage.crank_side()), |design| &mut design.d),
            Length::E => ("e", CrankLinkage::second_side, |design| &mut design.e),
            Length::Of(..) => return None,
        })
    }

    /// Returns its key in files: of two joints of a six-bar or an eight-bar their names, such as `X2F2`.
    pub fn key(self) -> String {
        self.entry().map_or_else(|| self.joints().concat(), |(key, ..)| key.to_owned())
    }

    /// Returns the length with a key; two joints in either order.
    pub fn named(key: &str) -> Option<Length> {
        let of_one_loop = Self::OF_ONE_LOOP.into_iter().find(|length| length.key() == key);
        of_one_loop.or_else(|| {
            let split = JointName::NAMES.into_iter().find_map(|first| {
                let second = key.strip_prefix(first)?;
                (first != second && JointName::named(second).is_some()).then_some([first, second])
            });
            Length::between(split?)
        })
    }

    /// Returns it in a linkage of several loops; `None` if its joints lie on no one body, or if it follows from other lengths.
    pub(super) fn of_several(self, linkage: &MultiLoop) -> Option<LinkLength> {
        linkage.lengths().into_iter().find(|one| Length::between(one.joints) == Some(self))
    }

    /// Returns its value in a linkage; `None` of a linkage that has no such length.
    pub fn of(self, linkage: impl Into<CrankLinkage>) -> Option<f64> {
        let linkage = linkage.into();
        match linkage.multi_loop() {
            Some(linkage) => self.of_several(linkage).map(|found| found.length),
            None => (self.entry()?.1)(&linkage),
        }
    }

    /// Returns the problem's limits for it in a linkage; from 0 to infinity if there are none. Those of a four-bar's lengths bound nothing
    /// of a linkage of several loops.
    pub fn limits(self, design: &DesignSpec, linkage: &CrankLinkage) -> Limits {
        let of_one_loop = linkage.multi_loop().is_none();
        let limits = self.place(&mut design.clone()).and_then(|limits| *limits).filter(|_| of_one_loop);
        limits.unwrap_or(Limits(0.0, f64::INFINITY))
    }

    pub(super) fn place(self, design: &mut DesignSpec) -> Option<&mut Option<Limits>> {
        Some((self.entry()?.2)(design))
    }
}

type Entry = (&'static str, fn(&CrankLinkage) -> Option<f64>, fn(&mut DesignSpec) -> &mut Option<Limits>);
