//! Lengths with units, and the placement of a viewBox: SVG 1.1, sections 7.7, 7.8 and 7.10.

use kurbo::{Affine, Vec2};
use svgtypes::{Align, AspectRatio, Length, LengthUnit, ViewBox};

/// The number of millimetres in an inch.
pub(super) const MM_PER_INCH: f64 = 25.4;
/// The number of px in an inch (CSS 2.1, 4.3.2).
pub(super) const PX_PER_INCH: f64 = 96.0;

/// Returns the length in px of an absolute unit, `None` for other units.
pub(super) fn px_of(unit: LengthUnit) -> Option<f64> {
    match unit {
        LengthUnit::None | LengthUnit::Px => Some(1.0),
        LengthUnit::In => Some(PX_PER_INCH),
        LengthUnit::Mm => Some(PX_PER_INCH / MM_PER_INCH),
        LengthUnit::Cm => Some(PX_PER_INCH / MM_PER_INCH * 10.0),
        LengthUnit::Pt => Some(PX_PER_INCH / 72.0),
        LengthUnit::Pc => Some(PX_PER_INCH / 6.0),
        LengthUnit::Em | LengthUnit::Ex | LengthUnit::Percent => None,
    }
}

/// Returns whether a length is physical, such as 20mm.
pub(super) fn is_physical(length: Length) -> bool {
    use LengthUnit::{Cm, In, Mm, Pc, Pt};
    matches!(length.unit, Mm | Cm | In | Pt | Pc)
}

/// Returns the map from a viewBox onto a viewport of width x height at the origin.
pub(super) fn placed(view: ViewBox, width: f64, height: f64, aspect: AspectRatio) -> Affine {
    let (sx, sy) = (width / view.w, height / view.h);
    let (sx, sy) = match (aspect.align, aspect.slice) {
        (Align::None, _) => (sx, sy),
        (_, true) => (sx.max(sy), sx.max(sy)),
        (_, false) => (sx.min(sy), sx.min(sy)),
    };
    let left = Vec2::new(width - sx * view.w, height - sy * view.h);
    let (fx, fy) = match aspect.align {
        Align::None | Align::XMinYMin => (0.0, 0.0),
        Align::XMidYMin => (0.5, 0.0),
        Align::XMaxYMin => (1.0, 0.0),
        Align::XMinYMid => (0.0, 0.5),
        Align::XMidYMid => (0.5, 0.5),
        Align::XMaxYMid => (1.0, 0.5),
        Align::XMinYMax => (0.0, 1.0),
        Align::XMidYMax => (0.5, 1.0),
        Align::XMaxYMax => (1.0, 1.0),
    };
    let shift = Vec2::new(fx * left.x, fy * left.y);
    Affine::translate(shift)
        * Affine::scale_non_uniform(sx, sy)
        * Affine::translate(Vec2::new(-view.x, -view.y))
}

/// The placement of the drawing as a whole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Page {
    /// The map from user units to millimetres if lengths are physical, otherwise to user units.
    pub affine: Affine,
    /// Whether lengths are physical.
    pub physical: bool,
    /// Width and height in user units, for percentages.
    pub extent: Option<Vec2>,
}

/// Returns the page of a root element with these attributes.
pub(super) fn page(
    width: Option<Length>,
    height: Option<Length>,
    view: Option<ViewBox>,
    aspect: AspectRatio,
) -> Page {
    let px = |length: Option<Length>| length.and_then(|l| Some(l.number * px_of(l.unit)?));
    let (w, h) = (px(width), px(height));
    let physical = [width, height].into_iter().flatten().any(is_physical);
    let to_mm = MM_PER_INCH / PX_PER_INCH;
    let extent = match view {
        Some(view) => Some(Vec2::new(view.w, view.h)),
        None => w.zip(h).map(|(w, h)| Vec2::new(w, h)),
    };
    let affine = match (view, w, h) {
        (Some(view), Some(w), Some(h)) if physical => Affine::scale(to_mm) * placed(view, w, h, aspect),
        (Some(view), Some(one), None) if physical => {
            Affine::scale(to_mm) * placed(view, one, one * view.h / view.w, aspect)
        }
        (Some(view), None, Some(one)) if physical => {
            Affine::scale(to_mm) * placed(view, one * view.w / view.h, one, aspect)
        }
        // The drawing is distorted on purpose: user units alone would not show that.
        (Some(view), Some(w), Some(h)) if aspect.align == Align::None => placed(view, w, h, aspect),
        (None, ..) if physical => Affine::scale(to_mm),
        _ => Affine::IDENTITY,
    };
    Page { affine, physical, extent }
}
