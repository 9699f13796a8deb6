//! The linkage in millimetres, with all sizes of its plates.

use super::holes::Holes;
use super::settings::{Refusal, Settings};
use super::{Format, Subject};
use crate::judge::practicality::layers::{Stack, layering};
use crate::judge::practicality::pins::{PinLength, pin_lengths};
use crate::judge::practicality::rims::{NeededRim, needed_rims};
use crate::judge::practicality::{Build, Sweep};
use crate::mechanism::plates::shop::THICKNESS_SHARE;
use crate::mechanism::plates::{Joint, Link, Parts, Placement, Plate, Shop, Sizes, parts};
use crate::mechanism::{AssemblyMode, Complex, CrankLinkage, FourBar, LinkageError, LoopJoints, Unit, point};
use crate::report::body;
use crate::report::scene::{Bounds, circuits_through, middle_position};
use crate::report::shop::thin_rim;
use crate::report::text::{brief, exact};

/// The allowed longest link in millimetres: from a hundredth of a millimetre to ten kilometres.
const LONGEST_MM: std::ops::RangeInclusive<f64> = 1e-2..=1e7;
/// The largest allowed coordinate: here, a millionth of a millimetre is still above the rounding.
const FARTHEST_MM: f64 = 1e9;
/// The default diameter of a hole, if a unit is given and the linkage has room for it.
const HOLE_MM: f64 = 4.0;
/// The default diameter of a hole if no unit is given, as a fraction of the longest link.
const HOLE_SHARE: f64 = 1.0 / 40.0;
/// The largest default diameter of a hole, as a fraction of the distance of the nearest two.
const HOLE_BESIDE: f64 = 1.0 / 3.0;
/// The chord error as a fraction of a hole's diameter: 0.01 mm at 4 mm.
const CHORD_SHARE: f64 = 1.0 / 400.0;

/// A subject in millimetres.
pub(super) struct Model<'a> {
    pub(super) subject: &'a Subject,
    pub(super) settings: &'a Settings,
    /// The linkage in millimetres.
    pub(super) linkage: CrankLinkage,
    /// Its parts; `None` if the loop of a slider is open in the motion, so that its slot has no length.
    pub(super) parts: Option<Parts>,
    /// The length of one unit of the file in millimetres, at this scale.
    pub(super) mm_per_unit: f64,
    pub(super) target: Vec<Complex>,
    /// The wanted frames of a motion's body.
    pub(super) wanted: Vec<Arms>,
    /// The closed paths of P along every circuit that is used.
    pub(super) curves: Vec<Vec<Complex>>,
    pub(super) holes: Holes,
    pub(super) margin: f64,
    pub(super) kerf: f64,
    pub(super) thickness: f64,
    pub(super) gap: f64,
    pub(super) chord: f64,
    assumed: Vec<(&'static str, String)>,
}

/// A frame of a body as a line: the end of its x axis, its origin, the end of its shorter y axis.
pub(super) type Arms = [Complex; 3];

/// The length of a frame's x axis in parts of the diagonal of the target's box, and of its y axis in parts of that.
const ARM: f64 = 0.08;
const SHORT_ARM: f64 = 0.6;

fn arms(at: Complex, angle: f64, length: f64) -> Arms {
    let along = Complex::from_polar(length, angle);
    [at + along, at, at + SHORT_ARM * Complex::i() * along]
}

impl<'a> Model<'a> {
    pub(super) fn new(subject: &'a Subject, settings: &'a Settings) -> Result<Self, Refusal> {
        let mut assumed = Vec::new();
        let unit = unit_of(subject, settings)?;
        if unit.is_none() {
            assumed.push(("unit", "no unit is given: 1 in the file is 1 mm".to_owned()));
        }
        let mm_per_unit = settings.scale() * unit.map_or(1.0, |unit| unit.factor_to(Unit::Mm));
        let linkage = scaled_loop(&subject.linkage, mm_per_unit)?;
        let longest = linkage.longest();
        if !LONGEST_MM.contains(&longest) {
            return Err(Refusal::about(
                settings,
                "scale",
                format!("the longest link would be {} mm long", brief(longest, 3)),
                "set scale=.. so that it is between 0.01 and 10000000 mm",
            ));
        }
        let target: Vec<Complex> = subject.target.iter().map(|p| point(*p) * mm_per_unit).collect();
        // Written so that NaN is too far.
        let too_far = |p: &Complex| !(p.re.abs() <= FARTHEST_MM && p.im.abs() <= FARTHEST_MM);
        let pivots: Vec<Complex> = linkage.pivots().collect();
        if target.iter().chain(&pivots).any(too_far) {
            return Err(Refusal::about(
                settings,
                "scale",
                "the drawing lies more than 1000 km from the origin",
                "set a smaller scale, or move the problem to the origin",
            ));
        }

        let shop = subject.shop.as_ref().map(|shop| {
            let factor = shop.unit.or(unit).map_or(1.0, |unit| unit.factor_to(Unit::Mm));
            shop.scaled(factor, Some(Unit::Mm))
        });
        let largest = if unit.is_some() { HOLE_MM } else { HOLE_SHARE * longest };
        let usual_hole = usual_hole(&linkage, subject, largest);
        let mut default = |key: &'static str, set: Option<f64>, value: f64| {
            set.unwrap_or_else(|| {
                let value = rounded_down(value);
                assumed.push((key, format!("{key} = {}", exact(value))));
                value
            })
        };
        let given = |of: fn(&Shop) -> Option<f64>| shop.as_ref().and_then(of);
        let hole = default("hole_mm", settings.hole_mm.or(given(|shop| shop.hole)), usual_hole);
        let margin = default("margin_mm", settings.margin_mm.or(given(|shop| shop.margin)), hole);
        let kerf = settings.kerf_mm.unwrap_or(0.0);
        let thickness = settings.thickness_mm.or(given(|shop| shop.thickness));
        let thickness = default("thickness_mm", thickness, THICKNESS_SHARE * hole);
        let gap = default("gap_mm", settings.gap_mm, margin) + kerf;
        let chord = default("chord_mm", settings.chord_mm, CHORD_SHARE * hole);
        let holes = Holes::new(hole, &linkage, (settings, shop));
        let (smallest, least) = holes.smallest(settings);
        if kerf >= least {
            return Err(Refusal::about(
                settings,
                "kerf_mm",
                format!("a kerf of {} mm leaves nothing to cut of holes of {} mm", exact(kerf), exact(least)),
                format!("choose kerf_mm below {smallest}"),
            ));
        }
        // A body that only turns has no size of its own.
        let size = Bounds::of(target.iter().copied()).diagonal();
        let arm = ARM * if size > 0.0 { size } else { longest };
        let angles = target.iter().zip(&subject.body_deg);
        let wanted = angles.filter_map(|(at, deg)| Some(arms(*at, (*deg)?.to_radians(), arm))).collect();
        let first = subject.positions.first().copied().unwrap_or_else(|| middle_position(linkage));
        let all = std::iter::once(first).chain(subject.positions.iter().copied());
        let circuits = circuits_through(linkage, all, settings.samples());
        let parts = Parts::new(linkage, Sizes { hole, margin }, &subject.motion);
        let curves = circuits.iter().map(|c| c.iter().map(|j| j.coupler_point).collect()).collect();
        Ok(Model {
            subject,
            settings,
            linkage,
            parts,
            mm_per_unit,
            target,
            wanted,
            curves,
            holes,
            margin,
            kerf,
            thickness,
            gap,
            chord,
            assumed,
        })
    }

    /// Returns the frame of the body at a position; `None` without a body.
    pub(super) fn body(&self, at: &LoopJoints) -> Option<Arms> {
        let [tip, corner, _] = *self.wanted.first()?;
        let angle = body::generated(at.coupler, self.subject.frame_deg?);
        Some(arms(at.joints.coupler_point, angle, (tip - corner).norm()))
    }

    /// Returns the assumptions that matter for a format, one sentence each.
    pub(super) fn notes(&self, format: Format) -> Vec<String> {
        let matters = |key: &&'static str| format.settings().contains(key);
        let (unit, sizes): (Vec<_>, Vec<_>) =
            self.assumed.iter().filter(|(key, _)| matters(key)).partition(|(key, _)| *key == "unit");
        let mut notes: Vec<String> = unit.into_iter().map(|(_, note)| note.clone()).collect();
        if !sizes.is_empty() {
            let sizes: Vec<&str> = sizes.into_iter().map(|(_, note)| note.as_str()).collect();
            notes.push(format!("by default {}", sizes.join(", ")));
        }
        if format.has_plates() {
            notes.extend(self.slot_note());
            notes.extend(self.thin_rims());
        }
        if format == Format::DxfPlates && self.settings.marks.is_none() {
            notes.push("the layer MARK holds names to engrave; marks=no leaves it out".to_owned());
        }
        notes
    }

    /// Returns the description of the slot of a slider; `None` of a four-bar.
    fn slot_note(&self) -> Option<String> {
        let parts = self.parts.as_ref()?;
        let (guide, slot) = (parts.guide()?, parts.slot()?);
        let mut note = format!(
            "the block runs on guide pins E and F, {} mm apart, in a slot of the {}, {} mm wide and {} mm long between the \
             centres of its ends S and T",
            brief(2.0 * guide.half, 4),
            slot.link.name(),
            brief(self.holes.pins, 4),
            brief(slot.length(), 6)
        );
        if parts.undrilled() == Some(Joint::P) {
            note.push_str("; P lies in the slot and has no hole");
        }
        Some(note)
    }

    /// Returns the warnings of thin rims, with shop data alone.
    fn thin_rims(&self) -> Vec<String> {
        let (Some(shop), Some(parts)) = (&self.holes.shop, &self.parts) else { return Vec::new() };
        let plates = parts.plates(|link| self.holes.radius(link, self.margin));
        let rims = needed_rims(&plates, &self.holes.bores, shop).into_iter();
        rims.filter(NeededRim::is_thin)
            .map(|rim| thin_rim(&rim, |mm| format!("{} mm", brief(mm, 4))))
            .collect()
    }

    /// Returns a heading such as `my-path, candidate 1 of 5, lengths in mm, 1 in the file is 25.4 mm`; foreign text in
    /// it is cleaned.
    pub(super) fn heading(&self) -> String {
        format!(
            "{}, {}, lengths in mm, 1 in the file is {} mm",
            self.subject.title(),
            self.subject.standing,
            exact(self.mm_per_unit)
        )
    }

    /// Returns the position that is drawn: at the crank angle of the settings, otherwise at the first target point that
    /// is reached, otherwise in the middle of the motion.
    pub(super) fn pose(&self) -> Result<LoopJoints, Refusal> {
        let Some(angle) = self.settings.crank_deg else { return self.start().map(|(_, at)| at) };
        self.linkage.joints_with(angle.to_radians(), self.linkage.assembly()).ok_or_else(|| {
            let help = match self.start() {
                Ok(((other, _), _)) => {
                    let other = brief(other.to_degrees(), 4);
                    format!("choose another crank_deg, such as {other}, or leave it out")
                }
                Err(refusal) => refusal.help,
            };
            let angle = exact(angle);
            let message = format!("the links cannot be joined at a crank angle of {angle} degrees");
            Refusal::about(self.settings, "crank_deg", message, help)
        })
    }

    /// Returns the crank angle (radians), the assembly and the joints at which drawings start.
    pub(super) fn start(&self) -> Result<((f64, AssemblyMode), LoopJoints), Refusal> {
        let middle = middle_position(self.linkage);
        let mut tried = self.subject.positions.iter().copied().chain([middle]);
        let found = tried.find_map(|(angle, assembly)| {
            Some(((angle, assembly), self.linkage.joints_with(angle, assembly)?))
        });
        found.ok_or_else(|| {
            let help = match self.parts {
                Some(_) => "its plates can be exported: svg-plates, dxf-plates, stl, cut-list",
                None => "choose lengths with which its loop closes; toml and json can be exported",
            };
            Refusal::new("the links of this linkage cannot be joined: there is no position to draw", help)
        })
    }

    /// Returns the parts.
    pub(super) fn parts(&self) -> Result<&Parts, Refusal> {
        self.parts.as_ref().ok_or_else(|| {
            Refusal::new(
                "the loop of this linkage is open in its motion, so the slot of its slider has no length",
                "choose lengths with which its loop closes; toml and json can be exported",
            )
        })
    }

    /// Returns the plates in their final sizes, each with its place in the layout (with room for the kerf): one
    /// below another, on a sheet in as many columns as that takes. The tool's paths begin at the sheet's corner.
    pub(super) fn plates(&self) -> Result<Vec<(Plate, Placement)>, Refusal> {
        let parts = self.parts()?;
        let plates = parts.plates(|link| self.holes.radius(link, self.margin));
        self.holes.check_shop(&self.linkage)?;
        self.holes.check(parts, self.settings)?;
        let sizes: Vec<Complex> = plates.iter().map(|plate| plate.bounds()[1] - plate.bounds()[0]).collect();
        let corners = match self.settings.sheet_mm {
            None => in_columns(&sizes, self.gap, f64::INFINITY),
            Some([width, height]) => self.on_sheet(&sizes, Complex::new(width, height))?,
        };
        let rim = 0.5 * Complex::new(self.kerf, self.kerf);
        let placed = plates.into_iter().zip(corners).map(|(plate, corner)| {
            let origin = corner + rim - plate.bounds()[0];
            (plate, Placement { origin, ..Placement::HOME })
        });
        Ok(placed.collect())
    }

    /// Returns the lower left corners of plates of these sizes on a sheet whose rim the tool may cut, from the corner of
    /// the room that the kerf leaves.
    fn on_sheet(&self, sizes: &[Complex], sheet: Complex) -> Result<Vec<Complex>, Refusal> {
        let room = sheet - Complex::new(self.kerf, self.kerf);
        // Columns as high as one plate, two plates, ..
        let heights = (0..sizes.len()).flat_map(|from| {
            let sum =
                |to: usize| sizes[from..=to].iter().map(|size| size.im + self.gap).sum::<f64>() - self.gap;
            (from..sizes.len()).map(sum).collect::<Vec<f64>>()
        });
        // How much of the sheet a layout needs: more than 1 is too much.
        let laid_out = heights.map(|height| {
            let corners = in_columns(sizes, self.gap, height * (1.0 + f64::EPSILON));
            let farthest = |of: fn(&Complex) -> f64| {
                corners.iter().zip(sizes).map(|(corner, size)| of(&(corner + size))).fold(0.0, f64::max)
            };
            let needed = Complex::new(farthest(|at| at.re), farthest(|at| at.im));
            ((needed.re / room.re).max(needed.im / room.im), needed, corners)
        });
        let best = laid_out.min_by(|one, other| one.0.total_cmp(&other.0));
        let Some((part, needed, corners)) = best else { return Ok(Vec::new()) };
        if part <= 1.0 && room.re > 0.0 && room.im > 0.0 {
            return Ok(corners);
        }
        let [wide, high] = [needed.re, needed.im].map(|side| exact((side + self.kerf).ceil()));
        Err(Refusal::about(
            self.settings,
            "sheet_mm",
            format!("the plates do not fit on a sheet of {} x {} mm", exact(sheet.re), exact(sheet.im)),
            format!("{wide} x {high} mm would do, and a smaller scale, margin_mm or gap_mm needs less"),
        ))
    }

    /// Returns the outline of a plate along which the tool's centre moves: grown by half the kerf.
    pub(super) fn cut(&self, plate: &Plate) -> Plate {
        plate.with_radius(plate.radius + 0.5 * self.kerf)
    }

    /// Returns the radius of a hole of a plate along which the tool's centre moves; `joints` are the hole's letters.
    pub(super) fn cut_hole(&self, link: Link, joints: &str) -> f64 {
        0.5 * (self.holes.of(link, joints) - self.kerf)
    }

    /// Returns the width of a slot along which the tool's centre moves: half the kerf nearer on each side.
    pub(super) fn cut_slot(&self) -> f64 {
        self.holes.pins - self.kerf
    }

    /// Returns the thickness of a plate.
    pub(super) fn thickness_of(&self, link: Link) -> f64 {
        self.holes.shop.as_ref().map_or(self.thickness, |shop| shop.thickness_of(link, self.thickness))
    }

    /// Returns the layers of the plates with the lengths of the pins in them; `None` without a stacking in which nothing crosses.
    pub(super) fn stacked(&self) -> Option<(Stack, Vec<PinLength>)> {
        let parts = self.parts.as_ref()?;
        let build = Build::new(self.holes.pins, self.margin);
        let build = Build { bores: self.holes.bores.clone(), shop: self.holes.shop.clone(), ..build };
        let stretches = self.subject.motion.clone();
        // A motion without stretches has no positions to look at.
        let sweep = Sweep { linkage: self.linkage, full_turn: false, stretches };
        let layering = (!sweep.stretches.is_empty()).then(|| layering(&sweep, &build)).flatten()?;
        let pins = pin_lengths(&layering, parts, &self.holes.bores, |link| self.thickness_of(link))?;
        Some((layering.stack?, pins))
    }
}

/// Returns the lower left corners of boxes that stand one above another, in as many columns as it takes to stay below a
/// height; a box that is higher has a column of its own.
fn in_columns(sizes: &[Complex], gap: f64, height: f64) -> Vec<Complex> {
    let (mut corner, mut next_column) = (Complex::new(0.0, 0.0), 0.0_f64);
    let place = |size: &Complex| {
        if corner.im > 0.0 && corner.im + size.im > height {
            corner = Complex::new(next_column, 0.0);
        }
        let at = corner;
        next_column = next_column.max(at.re + size.re + gap);
        corner.im += size.im + gap;
        at
    };
    sizes.iter().map(place).collect()
}

/// Returns the unit of the file, or that of the settings if the file has none.
pub(super) fn unit_of(subject: &Subject, settings: &Settings) -> Result<Option<Unit>, Refusal> {
    match (subject.unit, settings.unit) {
        (Some(own), Some(set)) if own != set => Err(Refusal::about(
            settings,
            "unit",
            format!("the lengths are in {} already", own.label()),
            "`unit` says what lengths without a unit are in; use `scale` to enlarge",
        )),
        (own, set) => Ok(own.or(set)),
    }
}

/// Returns a linkage with all lengths multiplied by a factor.
pub(super) fn scaled_loop(linkage: &CrankLinkage, factor: f64) -> Result<CrankLinkage, Refusal> {
    linkage.scaled(factor).map_err(|e| too_large(&e, factor))
}

fn too_large(error: &LinkageError, factor: f64) -> Refusal {
    Refusal::new(
        format!("scaled {} times, this is no linkage: {error}", exact(factor)),
        "choose another scale",
    )
}

/// Returns the default diameter of holes, at most `largest`: less where holes are near each other or near a slot.
fn usual_hole(linkage: &CrankLinkage, subject: &Subject, largest: f64) -> f64 {
    match linkage {
        CrankLinkage::FourBar(linkage) => largest.min(HOLE_BESIDE * nearest_holes(linkage)),
        _ => {
            let found = parts::largest_hole(linkage, &subject.motion, (largest, 1.0 / HOLE_BESIDE));
            // Without room for any hole, drawings have one all the same, and plates are refused.
            found.filter(|hole| *hole > 0.0).unwrap_or(largest)
        }
    }
}

/// Returns the names of each pair of distinct holes of a plate with their distance.
pub(super) fn hole_distances(plate: &Plate) -> Vec<(String, String, f64)> {
    distances(&plate.distinct_holes())
}

/// Returns the names of each pair of places with their distance.
pub(super) fn distances(holes: &[(String, Complex)]) -> Vec<(String, String, f64)> {
    let mut pairs = Vec::new();
    for (i, (from, at)) in holes.iter().enumerate() {
        for (to, there) in &holes[i + 1..] {
            pairs.push((from.clone(), to.clone(), (there - at).norm()));
        }
    }
    pairs
}

/// Returns the distance of the nearest two distinct holes of one plate.
fn nearest_holes(linkage: &FourBar) -> f64 {
    let all = Plate::all(linkage, 0.0).into_iter().flat_map(|plate| hole_distances(&plate));
    all.map(|(_, _, apart)| apart).fold(f64::INFINITY, f64::min)
}

/// Returns the largest number of two significant digits that is not larger than a value.
fn rounded_down(value: f64) -> f64 {
    let exponent = value.log10().floor() as i32 - 1;
    // Slightly increased, so that 0.3 is not taken for 0.29999.
    let digits = (value / 10f64.powi(exponent) * (1.0 + 1e-12)).floor();
    format!("{digits}e{exponent}").parse().unwrap_or(value)
}
