//! Sizes for building a linkage: shop data of its file or beside it, sizes that go before them, and the usual ones for the rest.

use crate::judge::practicality::{Build, Sweep};
use crate::mechanism::plates::Shop;
use crate::mechanism::plates::shop::{Key, Names, ShopFault};
use crate::mechanism::{CrankLinkage, Unit};

/// Sizes that go before those of shop data, in the linkage's unit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sizes {
    /// The diameter of the holes.
    pub hole: Option<f64>,
    /// The material around a hole.
    pub margin: Option<f64>,
    /// The diameter of the motor's shaft at A, in the crank.
    pub motor_hole: Option<f64>,
    /// The diameter of the motor's boss at A, in the ground.
    pub boss_hole: Option<f64>,
}

/// A linkage that cannot be built with these sizes.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NotBuilt {
    /// The slot of its block leaves no room for a hole.
    #[error("the slot of its block leaves no room for a hole, so there are no plates")]
    NoRoom,
    /// Shop data in a unit, and a linkage without one.
    #[error(
        "the shop data are in {unit}, and the linkage has no unit: write unit = \"{unit}\" into its file, or remove it from the shop \
         file", unit = .0.label()
    )]
    NoUnit(Unit),
    /// A size of the shop data that does not fit the others.
    #[error("[shop] {}: {fault}: {}", .key.join("."), .fault.remedy())]
    Shop {
        /// The key.
        key: Key,
        /// The fault.
        fault: ShopFault,
    },
}

/// Returns how a linkage is built over a motion.
///
/// # Errors
/// [`NotBuilt`].
pub fn build(
    (linkage, unit): (&CrankLinkage, Option<Unit>),
    sweep: &Sweep,
    shop: Option<Shop>,
    sizes: &Sizes,
) -> Result<Build, NotBuilt> {
    let shop = shop.map(|shop| in_unit(unit, &shop)).transpose()?;
    let set = |own: Option<f64>, of: fn(&Shop) -> Option<f64>| own.or(shop.as_ref().and_then(of));
    let hole = set(sizes.hole, |shop| shop.hole).or_else(|| Build::usual_hole_of(sweep, unit));
    let hole = hole.ok_or(NotBuilt::NoRoom)?;
    let mut build = Build::new(hole, set(sizes.margin, |shop| shop.margin).unwrap_or(hole));
    if let Some(shop) = shop {
        build = build.with_shop(linkage, shop);
    }
    let build = build.with_motor(sizes.motor_hole, sizes.boss_hole);
    if let Some(shop) = &build.shop {
        let fits = shop.check(&Names::of(linkage), &build.bores);
        fits.map_err(|(key, fault)| NotBuilt::Shop { key, fault })?;
    }
    Ok(build)
}

/// Returns shop data in the unit of a linkage.
fn in_unit(unit: Option<Unit>, shop: &Shop) -> Result<Shop, NotBuilt> {
    let factor = match (shop.unit, unit) {
        (None, _) => 1.0,
        (Some(own), Some(unit)) => own.factor_to(unit),
        (Some(own), None) => return Err(NotBuilt::NoUnit(own)),
    };
    Ok(shop.scaled(factor, unit))
}
