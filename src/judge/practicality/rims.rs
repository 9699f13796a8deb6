//! Rims that are thinner than their holes need.
//!
//! A rim of width w around a hole of diameter d needs w >= 0.7 d ([`RIM_SHARE`](crate::mechanism::plates::shop::RIM_SHARE)), or the width that
//! shop data give. Material between two holes needs what the one that needs more does.

use crate::mechanism::plates::{Beside, Bores, Link, Plate, Rim, Shop};

/// The relative amount by which a rim may be too thin: what rounding adds.
const ROUNDING: f64 = 1e-9;

/// A rim with the width that it needs.
#[derive(Clone, Debug, PartialEq)]
pub struct NeededRim {
    /// The link in whose plate it is.
    pub link: Link,
    /// The rim.
    pub rim: Rim,
    /// The joints of the hole that needs it, and its diameter: of two holes the one that needs more.
    pub hole: (String, f64),
    /// The least width.
    pub needed: f64,
}

impl NeededRim {
    /// Returns whether the rim is thinner than it needs to be.
    pub fn is_thin(&self) -> bool {
        self.rim.width < self.needed * (1.0 - ROUNDING)
    }
}

/// Returns the rims of plates with the widths that they need, in the order of the plates and their holes.
pub fn needed_rims(plates: &[Plate], bores: &Bores, shop: &Shop) -> Vec<NeededRim> {
    let of_plate = |plate: &Plate| {
        let link = plate.link;
        let need = |joints: &str| {
            let hole = bores.of(link, joints);
            (shop.rim_of(joints, hole), (joints.to_owned(), hole))
        };
        let rims = plate.rims(bores).into_iter();
        rims.map(|rim| {
            let mut worst = need(&rim.joints);
            if let Beside::Hole(other) = &rim.beside {
                let beside = need(other);
                worst = if beside.0 > worst.0 { beside } else { worst };
            }
            NeededRim { link, rim, hole: worst.1, needed: worst.0 }
        })
        .collect::<Vec<_>>()
    };
    plates.iter().flat_map(of_plate).collect()
}
