//! Kinds of dyad chains: which bodies carry the two ends of each dyad, and which link carries the traced point.
//!
//! Body 0 is the ground, 1 the crank; dyad j (counted from 0) adds body 2 + 2j, its link X-F, and body 3 + 2j, its link
//! Y-F. The first dyad goes from the crank to the ground: its links are the coupler and the follower of a four-bar.
//!
//! | X on, Y on | chain | P on |
//! |---|---|---|
//! | coupler, ground | Stephenson III | X-F |
//! | crank, coupler | Watt I with a ternary crank | X-F or Y-F |
//! | crank, follower | Stephenson I | X-F or Y-F |
//! | coupler, follower | Watt I with a ternary follower | X-F or Y-F |
//!
//! Watt's second chain draws nothing new: its point P is on a four-bar of its own, or runs on a four-bar's coupler curve.
//! Stephenson's second chain, and chains that are driven elsewhere, have no closed form (derived here).

/// Greatest number of dyads of a chain.
pub const MAX_DYADS: usize = 3;
/// Greatest number of bodies of a chain, the ground and the crank included.
pub const MAX_BODIES: usize = 2 + 2 * MAX_DYADS;

/// The ground as a body of a chain.
pub const GROUND: usize = 0;
/// The crank as a body of a chain.
pub const CRANK: usize = 1;
/// The link C-D of the first dyad.
pub const COUPLER: usize = 2;
/// The link B-D of the first dyad.
pub const FOLLOWER: usize = 3;

/// A kind of dyad chain: the bodies that carry the ends of each dyad, and the body that carries P.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct DyadChainKind {
    dyads: u8,
    anchors: [[u8; 2]; MAX_DYADS],
    traced: u8,
}

/// The pairs of bodies that carry the second dyad of a six-bar.
const SECOND: [[usize; 2]; 4] = [[COUPLER, GROUND], [CRANK, COUPLER], [CRANK, FOLLOWER], [COUPLER, FOLLOWER]];

impl DyadChainKind {
    /// The four-bar, with P on its coupler.
    pub const FOUR_BAR: DyadChainKind = DyadChainKind::of(&[[CRANK, GROUND]], COUPLER);

    /// The seven six-bars.
    pub const SIX_BARS: [DyadChainKind; 7] = [
        DyadChainKind::of(&[[CRANK, GROUND], SECOND[0]], 4),
        DyadChainKind::of(&[[CRANK, GROUND], SECOND[1]], 4),
        DyadChainKind::of(&[[CRANK, GROUND], SECOND[1]], 5),
        DyadChainKind::of(&[[CRANK, GROUND], SECOND[2]], 4),
        DyadChainKind::of(&[[CRANK, GROUND], SECOND[2]], 5),
        DyadChainKind::of(&[[CRANK, GROUND], SECOND[3]], 4),
        DyadChainKind::of(&[[CRANK, GROUND], SECOND[3]], 5),
    ];

    /// Creates a kind from at most [`MAX_DYADS`] pairs of anchors.
    pub(crate) const fn of(anchors: &[[usize; 2]], traced: usize) -> Self {
        let mut all = [[0; 2]; MAX_DYADS];
        let mut dyad = 0;
        while dyad < anchors.len() {
            all[dyad] = [anchors[dyad][0] as u8, anchors[dyad][1] as u8];
            dyad += 1;
        }
        DyadChainKind { dyads: anchors.len() as u8, anchors: all, traced: traced as u8 }
    }

    /// Returns the eight-bars whose third dyad hangs on the second one, with P on a link that is not pivoted on the ground.
    pub fn eight_bars() -> Vec<DyadChainKind> {
        let mut kinds = Vec::new();
        for second in SECOND {
            for link in [4, 5] {
                for other in 0..link {
                    // A link of the second dyad that turns about a fixed pivot is a follower like the first one.
                    for traced in [6, 7] {
                        if traced == 7 && other == GROUND {
                            continue;
                        }
                        kinds.push(DyadChainKind::of(&[[CRANK, GROUND], second, [link, other]], traced));
                    }
                }
            }
        }
        kinds
    }

    /// Returns the kinds with a number of dyads; none if there is no chain of as many.
    pub fn all(dyads: usize) -> Vec<DyadChainKind> {
        match dyads {
            1 => vec![DyadChainKind::FOUR_BAR],
            2 => DyadChainKind::SIX_BARS.to_vec(),
            3 => DyadChainKind::eight_bars(),
            _ => Vec::new(),
        }
    }

    /// Returns the chain of the first dyads, with P on the last X-F.
    #[must_use]
    pub fn first(self, dyads: usize) -> Self {
        let dyads = dyads.min(self.dyads());
        DyadChainKind { dyads: dyads as u8, traced: 2 * dyads as u8, ..self }
    }

    /// Returns the number of dyads: 1 of a four-bar, 2 of a six-bar, 3 of an eight-bar.
    #[inline(always)]
    pub fn dyads(self) -> usize {
        usize::from(self.dyads)
    }

    /// Returns the bodies that carry X and Y of a dyad.
    #[inline(always)]
    pub fn anchors(self, dyad: usize) -> [usize; 2] {
        let [x, y] = self.anchors[dyad];
        [usize::from(x), usize::from(y)]
    }

    /// Returns the body that carries P.
    #[inline(always)]
    pub fn traced(self) -> usize {
        usize::from(self.traced)
    }

    /// Returns the name of the chain, with the link that carries P where there are two.
    pub fn name(self) -> &'static str {
        const NAMES: [&str; 7] = [
            "Stephenson III",
            "Watt I, ternary crank, P on the crank's dyad link",
            "Watt I, ternary crank, P on the coupler's dyad link",
            "Stephenson I, P on the crank's dyad link",
            "Stephenson I, P on the follower's dyad link",
            "Watt I, ternary follower, P on the coupler's dyad link",
            "Watt I, ternary follower, P on the follower's dyad link",
        ];
        match self.dyads {
            1 => "four-bar",
            2 => {
                DyadChainKind::SIX_BARS.iter().position(|kind| *kind == self).map_or("six-bar", |i| NAMES[i])
            }
            _ => "eight-bar",
        }
    }
}
