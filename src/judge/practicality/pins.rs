//! The lengths of pins and spacers in a stacking of plates.
//!
//! Layer k lies at the height z_k = h_0 + .. + h_(k-1), h the thickness of the thickest plate of a layer, and each plate lies on
//! the bottom of its layer. A pin that joins the plates in layers i < k, of thicknesses t_i and t_k, ends flush with both:
//!
//! ```text
//! length = z_k + t_k - z_i,    spacer = z_k - (z_i + t_i)
//! ```
//!
//! The spacer fills the room between the two plates, where a layer between them has no plate at the joint, or where the lower
//! plate is thinner than its layer. A slot in which the pin always lies counts as a plate that it passes through. Joints in one place (A and B of coincident fixed pivots) share one pin through all of their plates.

use super::layers::{Layering, Stack};
use crate::mechanism::plates::{Bores, Joint, Link, Parts, Pin};

/// A spacer between two plates on a pin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spacer {
    /// The plate below it and the plate above it.
    pub between: [Link; 2],
    /// Its length.
    pub length: f64,
}

/// A pin with its length.
#[derive(Clone, Debug, PartialEq)]
pub struct PinLength {
    /// The joints at its place.
    pub joints: Vec<Joint>,
    /// Its diameter.
    pub diameter: f64,
    /// The plates that it passes through, the lowest first.
    pub plates: Vec<Link>,
    /// Its length, from the lower side of the lowest plate to the upper side of the highest.
    pub length: f64,
    /// The spacers on it, the lowest first.
    pub spacers: Vec<Spacer>,
}

impl PinLength {
    /// Returns the names of its joints, one after the other.
    pub fn name(&self) -> String {
        self.joints.iter().map(|joint| joint.name()).collect()
    }
}

/// Returns the pins of a linkage with their lengths in its stacking, in the order of the joints; `thickness` gives that of a plate.
/// `None` without a stacking.
pub fn pin_lengths(
    layering: &Layering,
    parts: &Parts,
    bores: &Bores,
    thickness: impl Fn(Link) -> f64,
) -> Option<Vec<PinLength>> {
    let stack = layering.stack.as_ref()?;
    let mut pins = grouped(parts);
    pins.iter_mut().for_each(|group| group.sort_by_key(|pin| pin.joint));
    pins.sort_by_key(|group| group.first().map(|pin| pin.joint));
    let of = |group: &Vec<Pin>| in_stack(group, stack, (parts, bores), &thickness);
    Some(pins.iter().filter_map(of).collect())
}

/// Returns the pins, those whose holes coincide in a plate together.
fn grouped(parts: &Parts) -> Vec<Vec<Pin>> {
    let mut groups: Vec<Vec<Pin>> = parts.pins().into_iter().map(|pin| vec![pin]).collect();
    for plate in parts.plates(|_| 0.0) {
        for (letters, _) in plate.distinct_holes() {
            let here = Joint::all_named(&letters);
            let is_here = |group: &Vec<Pin>| group.iter().any(|pin| here.contains(&pin.joint));
            let (together, others): (Vec<_>, Vec<_>) = groups.into_iter().partition(is_here);
            groups = others;
            if !together.is_empty() {
                groups.push(together.into_iter().flatten().collect());
            }
        }
    }
    groups
}

/// Returns a pin through the plates of a group of joints at one place.
fn in_stack(
    group: &[Pin],
    stack: &Stack,
    (parts, bores): (&Parts, &Bores),
    thickness: &impl Fn(Link) -> f64,
) -> Option<PinLength> {
    let height = |layer: &Vec<Link>| layer.iter().map(|link| thickness(*link)).fold(0.0, f64::max);
    let joined = |link: Link| group.iter().any(|pin| pin.joins.contains(&link));
    let slotted = |link: Link| group.iter().any(|pin| parts.stands_in_slot(pin.joint, link));
    let mut plates: Vec<(f64, Link)> = Vec::new();
    let mut bottom = 0.0;
    for layer in &stack.layers {
        let passed = layer.iter().filter(|link| joined(**link) || slotted(**link));
        plates.extend(passed.map(|link| (bottom, *link)));
        bottom += height(layer);
    }
    // A slot above or below both plates is not reached.
    let first = plates.iter().position(|(_, link)| joined(*link))?;
    let last = plates.iter().rposition(|(_, link)| joined(*link))?;
    let plates = plates.get(first..=last)?;
    let (lowest, highest) = (plates.first()?, plates.last()?);
    let spacer = |pair: &[(f64, Link)]| {
        let length = pair[1].0 - pair[0].0 - thickness(pair[0].1);
        let between = [pair[0].1, pair[1].1];
        // Heights are sums in another order: what rounding leaves is no spacer.
        (length > 1e-9 * bottom).then_some(Spacer { between, length })
    };
    Some(PinLength {
        joints: group.iter().map(|pin| pin.joint).collect(),
        diameter: group.iter().map(|pin| bores.pin(pin)).fold(f64::INFINITY, f64::min),
        length: highest.0 + thickness(highest.1) - lowest.0,
        spacers: plates.windows(2).filter_map(spacer).collect(),
        plates: plates.iter().map(|(_, link)| *link).collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::judge::practicality::layers::Layering;
    use crate::mechanism::plates::{Sizes, Stretch};
    use crate::mechanism::{AssemblyMode, SliderCrank, SliderCrankParameters};
    use crate::synthesis::fixture::linkage;

    /// Returns the layering of a four-bar with layers that are given.
    fn layering(layers: Vec<Vec<Link>>) -> (Parts, Layering) {
        let sizes = Sizes { hole: 4.0, margin: 4.0 };
        let parts = Parts::new(linkage([40.0, 20.0, 50.0, 50.0]), sizes, &[]).expect("a four-bar");
        let layering = Layering {
            links: parts.links(),
            traced: Link::Coupler,
            all_pins: parts.pins(),
            free_pairs: Vec::new(),
            pins_plates: Vec::new(),
            pins: Vec::new(),
            stack: Some(Stack { layers, through: Vec::new() }),
        };
        (parts, layering)
    }

    #[test]
    fn pins_are_as_long_as_their_stack_and_spacers_fill_empty_layers() {
        use Link::{Coupler, Crank, Follower, Ground};
        let (parts, found) = layering(vec![vec![Ground], vec![Crank], vec![Coupler], vec![Follower]]);
        let thickness = |link: Link| match link {
            Ground => 6.0,
            Coupler => 2.0,
            _ => 3.0,
        };
        let pins = pin_lengths(&found, &parts, &Bores::new(4.0), thickness).expect("a stack");
        let told: Vec<_> = pins.iter().map(|pin| (pin.name(), pin.length, pin.spacers.clone())).collect();
        let spacer = Spacer { between: [Ground, Follower], length: 5.0 };
        let expected = [
            ("A".to_owned(), 9.0, vec![]),
            // Over the crank of 3 and the coupler of 2: 6 + 3 + 2 + 3.
            ("B".to_owned(), 14.0, vec![spacer]),
            ("C".to_owned(), 5.0, vec![]),
            ("D".to_owned(), 5.0, vec![]),
        ];
        assert_eq!(told, expected);
    }

    #[test]
    fn a_plate_that_is_thinner_than_its_layer_has_a_spacer_above_it() {
        use Link::{Coupler, Crank, Follower, Ground};
        let (parts, found) = layering(vec![vec![Ground], vec![Crank, Follower], vec![Coupler]]);
        let thickness = |link: Link| if link == Follower { 2.0 } else { 3.0 };
        let pins = pin_lengths(&found, &parts, &Bores::new(4.0), thickness).expect("a stack");
        let of = |name: &str| pins.iter().find(|pin| pin.name() == name).expect("a pin");
        assert_eq!((of("B").length, of("B").spacers.len()), (5.0, 0));
        assert_eq!((of("D").length, of("D").plates.clone()), (6.0, vec![Follower, Coupler]));
        assert_eq!(of("D").spacers, [Spacer { between: [Follower, Coupler], length: 1.0 }]);
        // Each pin is as long as its plates and spacers together.
        for pin in &pins {
            let plates: f64 = pin.plates.iter().map(|link| thickness(*link)).sum();
            let spacers: f64 = pin.spacers.iter().map(|spacer| spacer.length).sum();
            assert!((pin.length - plates - spacers).abs() < 1e-12, "{pin:?}");
        }
    }

    #[test]
    fn a_pin_in_a_slot_passes_through_the_slotted_plate_without_a_spacer_there() {
        use Link::{Block, Coupler, Crank, Ground};
        let slider = SliderCrank::new(SliderCrankParameters {
            crank_pivot: [0.0, 0.0],
            crank: 30.0,
            coupler: 90.0,
            line_point: [0.0, 10.0],
            line_deg: 0.0,
            coupler_x: 40.0,
            coupler_y: 20.0,
            assembly: AssemblyMode::Plus,
        })
        .expect("a slider-crank");
        let turn = Stretch { from: 0.0, to: std::f64::consts::TAU, assembly: AssemblyMode::Plus };
        let parts = Parts::new(slider, Sizes { hole: 4.0, margin: 4.0 }, &[turn]).expect("it closes");
        let stack =
            Stack { layers: vec![vec![Block], vec![Ground], vec![Crank], vec![Coupler]], through: vec![] };
        let (_, four_bar) = layering(Vec::new());
        let found = Layering { links: parts.links(), all_pins: parts.pins(), stack: Some(stack), ..four_bar };
        let pins = pin_lengths(&found, &parts, &Bores::new(4.0), |_| 3.0).expect("a stack");
        let of = |name: &str| pins.iter().find(|pin| pin.name() == name).expect("a pin");
        assert_eq!(of("D").plates, [Block, Ground, Coupler]);
        assert_eq!(of("D").spacers, [Spacer { between: [Ground, Coupler], length: 3.0 }]);
        assert_eq!(
            (of("D").length, of("E").length, of("F").plates.clone()),
            (12.0, 6.0, vec![Block, Ground])
        );
    }
}
