//! Layers of the plates: a stacking in which no parts cross while the linkage moves.
//!
//! Plates joined by a pin overlap at that pin, so each of the pairs ground-crank, crank-coupler, coupler-follower and
//! follower-ground needs two layers. The pairs crank-follower and coupler-ground may share a plane if they stay apart over
//! the whole motion. Six-bars and eight-bars have more of both. A block of a slider takes the place of the follower; its
//! guide pins join it to the plate with the slot. A plate with a slot counts as if it were filled, except for the pins that
//! always lie in the slot. A pin passes through all layers from one of its plates to the other; in those between, it must
//! stay clear of every plate there and of every other pin that passes through them. Pins end flush with their plates, and
//! every plate is one piece in one layer.
//! All stackings are tried, a plate at a time: at most n^n of n plates, less those that begin with a crossing.
//!
//! Two parts are clear if the proved bound of [`super::closest`] is above zero. Parts that touch within its margin
//! count as crossing.

use super::clearance::{Build, Joint, Workpieces};
use super::closest::Closest;
use super::sweep::Sweep;
use crate::mechanism::plates::{Link, Pin};
use std::ops::ControlFlow;

/// The pairs of plates of a four-bar that no pin joins.
pub const FREE_PAIRS: [[Link; 2]; 2] = [[Link::Crank, Link::Follower], [Link::Coupler, Link::Ground]];

/// Returns the pairs of links that no pin joins, those with the ground last.
fn free_pairs(links: &[Link], pins: &[Pin]) -> Vec<[Link; 2]> {
    let from_crank: Vec<Link> = links.iter().copied().cycle().skip(1).take(links.len()).collect();
    let pairs = from_crank
        .iter()
        .enumerate()
        .flat_map(|(i, one)| from_crank[i + 1..].iter().map(|other| [*one, *other]));
    pairs.filter(|pair| !pins.iter().any(|pin| pair.iter().all(|link| pin.joins.contains(link)))).collect()
}

/// Two plates that no pin joins, with the least distance between them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlatePair {
    /// The two plates.
    pub plates: [Link; 2],
    /// The least distance between them over the motion; below zero if they overlap.
    pub closest: Closest,
}

/// A pin and a plate that it does not join, with the least distance between them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PinPlate {
    /// The pin.
    pub pin: Joint,
    /// The plate.
    pub plate: Link,
    /// The least distance between them over the motion.
    pub closest: Closest,
}

/// A stacking without crossings.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Stack {
    /// The plates of each layer, the lowest first.
    pub layers: Vec<Vec<Link>>,
    /// The pins that pass through a layer between their plates, with the index of that layer, counted from 0.
    pub through: Vec<(Joint, usize)>,
}

/// The distances that decide the layers, and the resulting stacking.
#[derive(Clone, Debug, PartialEq)]
pub struct Layering {
    /// The links.
    pub links: Vec<Link>,
    /// The link that carries P.
    pub traced: Link,
    /// The pins that join them.
    pub all_pins: Vec<Pin>,
    /// The pairs of plates that could share a plane.
    pub free_pairs: Vec<PlatePair>,
    /// Pins and the plates that they do not join.
    pub pins_plates: Vec<PinPlate>,
    /// Pairs of pins.
    pub pins: Vec<([Joint; 2], Closest)>,
    /// The stacking of the fewest layers; of several the one whose pins pass through the fewest layers, then with the
    /// plate of P outermost (so that P can be reached), then with the ground lowest. `None` if there is none.
    pub stack: Option<Stack>,
}

/// A plate that passes over the upper end of a pin that it does not join, or under the lower one.
#[derive(Clone, Debug)]
pub struct Passing<'a> {
    /// The pin and the plate, with their least distance.
    pub pair: &'a PinPlate,
    /// The layer of the plate, counted from 0.
    pub plate: usize,
    /// The layer in which the pin ends.
    pub end: usize,
}

/// Returns whether it is proved that two parts stay apart.
pub fn clear(closest: &Closest) -> bool {
    closest.bound > 0.0
}

/// Computes the stacking of the fewest layers without crossings over the whole motion; `None` if the loop is open in
/// the motion.
pub fn layering(sweep: &Sweep, build: &Build) -> Option<Layering> {
    let mut layering = Layering::of(&Workpieces::new(sweep, build)?)?;
    layering.stack = layering.best();
    Some(layering)
}

/// Returns whether there is a stacking without crossings over the whole motion, in a fraction of the time of [`layering`]: of the
/// distances it is only decided whether parts are clear, and parts nearer than [`MARGIN`](super::closest::MARGIN) of the longest
/// link count as crossing. `None` if the loop is open in the motion.
pub fn can_be_stacked(sweep: &Sweep, build: &Build) -> Option<bool> {
    let layering = Layering::of(&Workpieces::new(sweep, build)?.decided())?;
    // A layer without a plate is left out.
    let count = layering.links.len();
    let visited = Crossings::of(&layering).each_of(count, &mut Vec::new(), &mut |_| ControlFlow::Break(()));
    Some(visited.is_break())
}

impl Layering {
    /// Computes the distances that decide the layers, without a stacking.
    fn of(pieces: &Workpieces<'_>) -> Option<Self> {
        let parts = pieces.parts();
        let links = parts.links();
        let all_pins = parts.pins();
        let mut free_pairs = Vec::new();
        for plates in self::free_pairs(&links, &all_pins) {
            free_pairs.push(PlatePair { plates, closest: pieces.between_plates(plates[0], plates[1])? });
        }
        let mut pins_plates = Vec::new();
        let mut pins = Vec::new();
        for (i, Pin { joint: pin, joins }) in all_pins.iter().copied().enumerate() {
            let strangers =
                links.iter().filter(|link| !joins.contains(link) && !pieces.stands_in_slot(pin, **link));
            for plate in strangers.copied() {
                pins_plates.push(PinPlate { pin, plate, closest: pieces.pin_to_plate(pin, plate)? });
            }
            for other in &all_pins[i + 1..] {
                pins.push(([pin, other.joint], pieces.between_pins(pin, other.joint)?));
            }
        }
        Some(Layering { links, traced: parts.traced(), all_pins, free_pairs, pins_plates, pins, stack: None })
    }
}

/// The layer of each plate, in the order of the links.
type Places = Vec<usize>;

fn layer(places: &[usize], link: Link) -> usize {
    places[link.place()]
}

/// Returns the layers strictly between the two plates of a pin.
fn between(places: &[usize], pin: &Pin) -> std::ops::Range<usize> {
    let [one, other] = pin.joins.map(|link| layer(places, link));
    one.min(other) + 1..one.max(other).max(one.min(other) + 1)
}

/// The pairs of parts that cross if a stacking brings them together, for each plate in the order of the links: those of which it is
/// the last plate that is placed.
struct Crossings {
    /// Plates that may not share its layer.
    apart: Vec<Vec<usize>>,
    /// Pins and plates that may not be in a layer between the pin's two.
    pins_plates: Vec<Vec<(Pin, Link)>>,
    /// Pairs of pins that may not pass through one layer.
    pins: Vec<Vec<[Pin; 2]>>,
}

impl Crossings {
    fn of(layering: &Layering) -> Self {
        let n = layering.links.len();
        let mut all = Crossings {
            apart: vec![Vec::new(); n],
            pins_plates: vec![Vec::new(); n],
            pins: vec![Vec::new(); n],
        };
        let joined = layering.all_pins.iter().map(|pin| pin.joins);
        let crossing =
            layering.free_pairs.iter().filter(|pair| !clear(&pair.closest)).map(|pair| pair.plates);
        for pair in joined.chain(crossing) {
            let [one, other] = pair.map(Link::place);
            all.apart[one.max(other)].push(one.min(other));
        }
        let pin = |joint: Joint| layering.all_pins.iter().find(|pin| pin.joint == joint).copied();
        let last = |pin: &Pin| pin.joins.map(Link::place).into_iter().fold(0, usize::max);
        for pair in layering.pins_plates.iter().filter(|pair| !clear(&pair.closest)) {
            if let Some(pin) = pin(pair.pin) {
                all.pins_plates[last(&pin).max(pair.plate.place())].push((pin, pair.plate));
            }
        }
        for (pair, _) in layering.pins.iter().filter(|(_, closest)| !clear(closest)) {
            if let [Some(one), Some(other)] = pair.map(pin) {
                all.pins[last(&one).max(last(&other))].push([one, other]);
            }
        }
        all
    }

    /// Calls a function with every stacking of `count` layers in which nothing crosses, until it breaks.
    fn each_of(
        &self,
        count: usize,
        places: &mut Places,
        visit: &mut impl FnMut(&Places) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        if places.len() == self.apart.len() {
            return visit(places);
        }
        for layer in 0..count {
            places.push(layer);
            if self.allow_last(places) {
                self.each_of(count, places, visit)?;
            }
            places.pop();
        }
        ControlFlow::Continue(())
    }

    /// Returns whether the plate that was placed last, and the pins whose last plate it is, cross nothing.
    fn allow_last(&self, places: &Places) -> bool {
        let plate = places.len() - 1;
        let side_by_side = |[one, other]: &[Pin; 2]| {
            let [one, other] = [one, other].map(|pin| between(places, pin));
            one.start.max(other.start) < one.end.min(other.end)
        };
        let passes = |(pin, other): &(Pin, Link)| between(places, pin).contains(&layer(places, *other));
        !self.apart[plate].iter().any(|other| places[*other] == places[plate])
            && !self.pins_plates[plate].iter().any(passes)
            && !self.pins[plate].iter().any(side_by_side)
    }
}

impl Layering {
    fn best(&self) -> Option<Stack> {
        let crossings = Crossings::of(self);
        let through =
            |places: &Places| self.all_pins.iter().map(|pin| between(places, pin).len()).sum::<usize>();
        (2..=self.links.len()).find_map(|count| {
            let mut best = None;
            let _ = crossings.each_of(count, &mut Vec::new(), &mut |places| {
                if !(0..count).all(|layer| places.contains(&layer)) {
                    return ControlFlow::Continue(());
                }
                let traced = layer(places, self.traced);
                let inside = traced != 0 && traced + 1 != count;
                let merit = (through(places), inside, layer(places, Link::Ground), places.clone());
                if best.as_ref().is_none_or(|best| merit < *best) {
                    best = Some(merit);
                }
                ControlFlow::Continue(())
            });
            best.map(|(.., places)| Stack {
                layers: (0..count)
                    .map(|l| self.links.iter().copied().filter(|link| layer(&places, *link) == l).collect())
                    .collect(),
                through: self
                    .all_pins
                    .iter()
                    .flat_map(|pin| between(&places, pin).map(|l| (pin.joint, l)))
                    .collect(),
            })
        })
    }

    /// Returns the pairs of links that pins join, in the order of the links.
    pub fn joined(&self) -> Vec<[Link; 2]> {
        let mut pairs: Vec<[Link; 2]> = self.all_pins.iter().map(|pin| pin.joins).collect();
        pairs.sort_by_key(|pair| pair.map(Link::place));
        pairs.dedup();
        pairs
    }

    /// Returns the plates of a stacking that pass over or under an end of a pin, nearer to it than `head`: a head that
    /// reaches so far beyond the pin would be hit there.
    pub fn passings<'a>(&'a self, stack: &'a Stack, head: f64) -> impl Iterator<Item = Passing<'a>> {
        let layer_of = |link: Link| stack.layers.iter().position(|layer| layer.contains(&link));
        self.pins_plates.iter().filter(move |pair| pair.closest.value < head).filter_map(move |pair| {
            let plate = layer_of(pair.plate)?;
            let joins = self.all_pins.iter().find(|pin| pin.joint == pair.pin)?.joins;
            let [one, other] = joins.map(layer_of);
            let (low, high) = (one?.min(other?), one?.max(other?));
            // A plate between the two ends is in the way of the pin itself.
            let end = if plate > high { high } else { low };
            (plate < low || plate > high).then_some(Passing { pair, plate, end })
        })
    }

    /// Returns the plates that pins cross if they pass through their layer.
    pub fn crossings(&self) -> impl Iterator<Item = &PinPlate> {
        self.pins_plates.iter().filter(|p| !clear(&p.closest))
    }
}
