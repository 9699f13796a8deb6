//! Layers of the plates: a stacking in which no parts cross while the linkage moves.
//!
//! Plates joined by a pin overlap at that pin, so each of the pairs ground-crank, crank-coupler, coupler-follower and
//! follower-ground needs two layers. The pairs crank-follower and coupler-ground may share a plane if they stay apart over
//! the whole motion. A block of a slider takes the place of the follower; its guide pins join it to the plate with the
//! slot. A plate with a slot counts as if it were filled, except for the pins that always lie in the slot. A pin passes
//! through all layers from one of its plates to the other; in those between, it must stay clear of every plate there and of
//! every other pin that passes through them. Pins end flush with their plates, and every plate is one piece in one layer.
//! All stackings are tried: there are at most 4^4.
//!
//! Two parts are clear if the proved bound of [`super::closest`] is above zero. Parts that touch within its margin
//! count as crossing.

use super::clearance::{Build, Joint, Workpieces};
use super::closest::Closest;
use super::sweep::Sweep;
use crate::mechanism::plates::{Link, Pin};

/// The pairs of plates of a four-bar that no pin joins.
pub const FREE_PAIRS: [[Link; 2]; 2] = [[Link::Crank, Link::Follower], [Link::Coupler, Link::Ground]];

/// Returns the pairs of links around a loop that no pin joins.
fn free_pairs([ground, crank, coupler, last]: [Link; 4]) -> [[Link; 2]; 2] {
    [[crank, last], [coupler, ground]]
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
    /// The links around the loop.
    pub links: [Link; 4],
    /// The pins that join them.
    pub all_pins: Vec<Pin>,
    /// The two pairs of plates that could share a plane.
    pub free_pairs: Vec<PlatePair>,
    /// Pins and the plates that they do not join.
    pub pins_plates: Vec<PinPlate>,
    /// Pairs of pins.
    pub pins: Vec<([Joint; 2], Closest)>,
    /// The stacking of the fewest layers; of several the one whose pins pass through the fewest layers, then with the
    /// coupler outermost (so that P can be reached), then with the ground lowest. `None` if there is none.
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
pub fn layering(sweep: &Sweep, build: Build) -> Option<Layering> {
    let pieces = Workpieces::new(sweep, build)?;
    let parts = pieces.parts();
    let links = parts.links();
    let mut free_pairs = Vec::new();
    for plates in self::free_pairs(links) {
        free_pairs.push(PlatePair { plates, closest: pieces.between_plates(plates[0], plates[1])? });
    }
    let mut pins_plates = Vec::new();
    let mut pins = Vec::new();
    for (i, Pin { joint: pin, joins }) in parts.pins().iter().copied().enumerate() {
        let strangers =
            links.into_iter().filter(|link| !joins.contains(link) && !parts.stands_in_slot(pin, *link));
        for plate in strangers {
            pins_plates.push(PinPlate { pin, plate, closest: pieces.pin_to_plate(pin, plate)? });
        }
        for other in parts.pins().iter().skip(i + 1) {
            pins.push(([pin, other.joint], pieces.between_pins(pin, other.joint)?));
        }
    }
    let all_pins = parts.pins().to_vec();
    let mut layering = Layering { links, all_pins, free_pairs, pins_plates, pins, stack: None };
    layering.stack = layering.best();
    Some(layering)
}

/// The layer of each plate, in the order around the loop.
type Places = [usize; 4];

fn layer(places: &Places, link: Link) -> usize {
    places[link.place()]
}

/// Returns the layers strictly between the two plates of a pin.
fn between(places: &Places, pin: &Pin) -> std::ops::Range<usize> {
    let [one, other] = pin.joins.map(|link| layer(places, link));
    one.min(other) + 1..one.max(other).max(one.min(other) + 1)
}

impl Layering {
    fn best(&self) -> Option<Stack> {
        (2..=self.links.len()).find_map(|count| {
            let all = (0..count.pow(4)).map(|code| {
                let digit = |i: u32| (code / count.pow(i)) % count;
                [digit(0), digit(1), digit(2), digit(3)]
            });
            let fits = all.filter(|places| (0..count).all(|l| places.contains(&l)) && self.works(places));
            let through =
                |places: &Places| self.all_pins.iter().map(|pin| between(places, pin).len()).sum::<usize>();
            let merit = |places: &Places| {
                let coupler = layer(places, Link::Coupler);
                let inside = coupler != 0 && coupler + 1 != count;
                (through(places), inside, layer(places, Link::Ground), *places)
            };
            fits.min_by_key(merit).map(|places| Stack {
                layers: (0..count)
                    .map(|l| self.links.into_iter().filter(|link| layer(&places, *link) == l).collect())
                    .collect(),
                through: self
                    .all_pins
                    .iter()
                    .flat_map(|pin| between(&places, pin).map(|l| (pin.joint, l)))
                    .collect(),
            })
        })
    }

    /// Returns whether no parts cross in a stacking.
    fn works(&self, places: &Places) -> bool {
        let together = |[one, other]: [Link; 2]| layer(places, one) == layer(places, other);
        let apart = !self.all_pins.iter().any(|pin| together(pin.joins));
        let planes = self.free_pairs.iter().all(|pair| !together(pair.plates) || clear(&pair.closest));
        let range = |joint: Joint| {
            self.all_pins.iter().find(|pin| pin.joint == joint).map_or(0..0, |pin| between(places, pin))
        };
        let crossed = |pin: Joint, plate: Link| range(pin).contains(&layer(places, plate));
        let plates = self.pins_plates.iter().all(|p| !crossed(p.pin, p.plate) || clear(&p.closest));
        let side_by_side = |pins: [Joint; 2]| {
            let [one, other] = pins.map(range);
            one.start.max(other.start) < one.end.min(other.end)
        };
        let pins = self.pins.iter().all(|(pair, closest)| !side_by_side(*pair) || clear(closest));
        apart && planes && plates && pins
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
