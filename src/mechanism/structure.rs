//! The structure of a mechanism: its bodies, the ground among them, and the pairs that connect them.
//!
//! Every mechanism here is a driven crank and groups of two bodies, each attached to bodies that come before it (Assur groups of
//! class II). A group has three pairs, and each pair hands on two numbers, so that its six equations of equilibrium have six
//! unknowns:
//!
//! | group | bodies | pairs |
//! |---|---|---|
//! | dyad | links p-N and q-N | revolute at p, at q and at N |
//! | slider | link p-N and the block on N | revolute at p and at N, prismatic on the line |
//! | guide | link p-N and the block on q | revolute at p and at q, prismatic on the link |
//!
//! A revolute pair hands on a force. A prismatic pair hands on a force across its line and a moment.

use super::Complex;

/// The ground as a body.
pub const GROUND: usize = 0;
/// The crank as a body.
pub const CRANK: usize = 1;

/// The direction in which a block slides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Line {
    /// A fixed unit direction.
    Fixed(Complex),
    /// A direction that turns with a body: `turn` (a unit number) times the body's own direction.
    OnBody {
        /// Index of the body.
        body: usize,
        /// The turn from the body's own direction.
        turn: Complex,
    },
}

/// The frame of a body: its origin, and its unit direction, along which places count.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Frame {
    /// The plane's own.
    Ground,
    /// From one joint towards another, both of which are on the body.
    Joints([usize; 2]),
    /// From a joint along the direction of the pose's coupler.
    Coupler(usize),
    /// Of a block: from a joint along the line on which it slides.
    Block {
        /// Index of the joint.
        at: usize,
        /// The line.
        line: Line,
    },
}

/// A body.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// Its name.
    pub name: String,
    /// Its frame.
    pub frame: Frame,
    /// Indices of its joints and attached points, with their places in its frame.
    pub joints: Vec<(usize, Complex)>,
    /// Whether it is a link whose outline follows from its joints: no block, and no rod that slides.
    pub is_plain: bool,
}

/// The kind of a pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PairKind {
    /// A pin.
    Revolute,
    /// A block on a line. The line has the direction of the second body, which is the block.
    Prismatic,
}

/// A pair of bodies that move on each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pair {
    /// The kind.
    pub kind: PairKind,
    /// Index of the joint at which the force acts.
    pub joint: usize,
    /// The two bodies, the earlier one first; a force of the pair is given as it acts on the first.
    pub bodies: [usize; 2],
}

/// Two bodies that hang on earlier ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Group {
    /// The bodies.
    pub bodies: [usize; 2],
    /// The pairs.
    pub pairs: [Pair; 3],
}

/// The motion that a mechanism is there for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OutputBody {
    /// A body turns.
    Turns(usize),
    /// A block slides along its line.
    Slides(usize),
}

/// The bodies and pairs of a mechanism. The bodies are the ground, the crank, then those of each group in order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Structure {
    /// The bodies; none of a linkage that is beyond the limits of a chain.
    pub bodies: Vec<Body>,
    /// Index of the joint at which the crank turns on the ground.
    pub crank_pivot: usize,
    /// The groups in the order of assembly.
    pub groups: Vec<Group>,
    /// The output; `None` for kinds without a certain one.
    pub output: Option<OutputBody>,
}

impl Body {
    /// Creates a link with its frame from its first joint to its second.
    pub(super) fn link(name: &str, joints: &[(usize, Complex)]) -> Self {
        let frame = Frame::Joints([0, 1].map(|i| joints.get(i).map_or(0, |(joint, _)| *joint)));
        Body { name: name.to_owned(), frame, joints: joints.to_vec(), is_plain: true }
    }

    /// Creates the ground with its pivots.
    pub(super) fn ground(pivots: impl IntoIterator<Item = (usize, Complex)>) -> Self {
        let joints = pivots.into_iter().collect();
        Body { name: "ground".to_owned(), frame: Frame::Ground, joints, is_plain: true }
    }

    /// Creates a block that slides along a line.
    pub(super) fn block(name: &str, line: Line, joints: &[(usize, Complex)]) -> Self {
        let at = joints.first().map_or(0, |(joint, _)| *joint);
        let frame = Frame::Block { at, line };
        Body { name: name.to_owned(), frame, joints: joints.to_vec(), is_plain: false }
    }
}

impl Pair {
    /// Creates a pair of two bodies at a joint.
    pub(super) fn new(kind: PairKind, joint: usize, bodies: [usize; 2]) -> Self {
        Pair { kind, joint, bodies }
    }

    /// Creates a revolute pair.
    pub(super) fn pin(joint: usize, bodies: [usize; 2]) -> Self {
        Pair::new(PairKind::Revolute, joint, bodies)
    }

    /// Creates a prismatic pair.
    pub(super) fn slide(joint: usize, bodies: [usize; 2]) -> Self {
        Pair::new(PairKind::Prismatic, joint, bodies)
    }
}

impl Structure {
    /// Returns all pairs: the crank's on the ground, then those of each group in turn.
    pub fn pairs(&self) -> impl Iterator<Item = Pair> + '_ {
        let crank = Pair::pin(self.crank_pivot, [GROUND, CRANK]);
        std::iter::once(crank).chain(self.groups.iter().flat_map(|group| group.pairs))
    }

    /// Returns the bodies that carry a joint, in order.
    pub fn carriers(&self, joint: usize) -> impl Iterator<Item = usize> + '_ {
        let carries = move |body: &Body| body.joints.iter().any(|(on, _)| *on == joint);
        self.bodies.iter().enumerate().filter(move |(_, body)| carries(body)).map(|(i, _)| i)
    }
}
