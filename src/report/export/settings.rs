//! Settings of exports: `--set KEY=VALUE`.

use super::Format;
use crate::files::toml_text::nearest;
use crate::mechanism::Unit;

/// The reason why an export is refused.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct Refusal {
    /// The setting at fault, as it was typed.
    pub setting: Option<(String, String)>,
    /// The fault.
    pub message: String,
    /// The remedy.
    pub help: String,
}

impl Refusal {
    /// Returns a refusal that is not about a single setting.
    pub(super) fn new(message: impl Into<String>, help: impl Into<String>) -> Self {
        Refusal { setting: None, message: message.into(), help: help.into() }
    }

    /// Returns a refusal about a setting, which is shown as it was typed, if it was.
    pub(super) fn about(
        settings: &Settings,
        key: &str,
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> Self {
        let typed = settings.typed.iter().rev().find(|(typed, _)| typed == key).cloned();
        Refusal { setting: typed, ..Refusal::new(message, help) }
    }
}

/// The settings of an export. The default of an absent setting follows from the linkage; lengths are in millimetres of
/// the finished file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Settings {
    /// The factor by which the linkage is scaled; 1 by default.
    pub scale: Option<f64>,
    /// The unit of the lengths, if the file has none.
    pub unit: Option<Unit>,
    /// The diameter of every hole that has no size of its own, in mm.
    pub hole_mm: Option<f64>,
    /// The diameter of the crank's hole at A, for the shaft of a motor, in mm; as the others by default.
    pub motor_hole_mm: Option<f64>,
    /// The diameter of the ground's hole at A, for the boss of a motor, in mm; by default as that of the crank.
    pub boss_hole_mm: Option<f64>,
    /// The distance from a hole's edge to the edge of the plate, in mm.
    pub margin_mm: Option<f64>,
    /// The width of the cut that the tool takes away, in mm: outlines grow by half of it, holes shrink.
    pub kerf_mm: Option<f64>,
    /// The thickness of the material, in mm.
    pub thickness_mm: Option<f64>,
    /// The least distance between plates that are laid out, in mm.
    pub gap_mm: Option<f64>,
    /// The width and height of the sheet that the plates are laid out on, in mm; none: one below another.
    pub sheet_mm: Option<[f64; 2]>,
    /// The largest distance between a round edge and the polygon that replaces it, in mm.
    pub chord_mm: Option<f64>,
    /// The crank angle of drawings, in degrees from the x axis.
    pub crank_deg: Option<f64>,
    /// The number of points of the coupler curve.
    pub samples: Option<usize>,
    /// The number of crank angles of a cycle.
    pub positions: Option<usize>,
    /// The angular velocity of the crank, in rad/s.
    pub omega_rad_s: Option<f64>,
    /// The longer side of a picture, in pixels.
    pub size_px: Option<usize>,
    /// The number of frames of a turn.
    pub frames: Option<usize>,
    /// Whether names are drawn on plates, to be engraved; they are by default.
    pub marks: Option<bool>,
    /// The settings as they were typed.
    pub typed: Vec<(String, String)>,
}

impl Settings {
    /// Returns the settings of pairs of key and value; the last of equal keys counts.
    ///
    /// # Errors
    /// [`Refusal`] for a key that the format does not accept and for an invalid value.
    pub fn parse(format: Format, pairs: &[(String, String)]) -> Result<Self, Refusal> {
        let mut settings = Settings { typed: pairs.to_vec(), ..Settings::default() };
        for (key, value) in pairs {
            let about = |refusal| Refusal { setting: Some((key.clone(), value.clone())), ..refusal };
            settings.set(format, key, value).map_err(about)?;
        }
        Ok(settings)
    }

    fn set(&mut self, format: Format, key: &str, value: &str) -> Result<(), Refusal> {
        let takes = format.settings();
        if !takes.contains(&key) {
            let list = format!("{} takes {}", format.name(), takes.join(", "));
            let hint = nearest(key, takes).map_or(String::new(), |n| format!("did you mean `{n}`? "));
            let message = if Format::ALL.iter().any(|other| other.settings().contains(&key)) {
                format!("`{key}` means nothing for {}", format.name())
            } else {
                format!("there is no setting `{key}`")
            };
            return Err(Refusal::new(message, format!("{hint}{list}")));
        }
        match key {
            "scale" => self.scale = Some(number(key, value, POSITIVE)?),
            "hole_mm" => self.hole_mm = Some(number(key, value, POSITIVE)?),
            "motor_hole_mm" => self.motor_hole_mm = Some(number(key, value, POSITIVE)?),
            "boss_hole_mm" => self.boss_hole_mm = Some(number(key, value, POSITIVE)?),
            "thickness_mm" => self.thickness_mm = Some(number(key, value, POSITIVE)?),
            "chord_mm" => self.chord_mm = Some(number(key, value, POSITIVE)?),
            "margin_mm" => self.margin_mm = Some(number(key, value, POSITIVE)?),
            "kerf_mm" => self.kerf_mm = Some(number(key, value, NOT_NEGATIVE)?),
            "gap_mm" => self.gap_mm = Some(number(key, value, NOT_NEGATIVE)?),
            "sheet_mm" => self.sheet_mm = Some(sheet(value)?),
            "crank_deg" => self.crank_deg = Some(number(key, value, ANY)?),
            "omega_rad_s" => self.omega_rad_s = Some(number(key, value, ANY)?),
            "samples" => self.samples = Some(count(key, value, 8..=100_000)?),
            "positions" => self.positions = Some(count(key, value, 1..=100_000)?),
            "size_px" => self.size_px = Some(count(key, value, 100..=4000)?),
            "frames" => self.frames = Some(count(key, value, 2..=360)?),
            "marks" => self.marks = Some(yes_or_no(key, value)?),
            "unit" => {
                let found = Unit::ALL.into_iter().find(|unit| unit.label() == value);
                self.unit = Some(found.ok_or_else(|| {
                    Refusal::new(format!("`unit` is no unit of length: {value}"), "choose mm, cm, m or in")
                })?);
            }
            _ => {}
        }
        Ok(())
    }

    /// Returns the scale, 1 if none is set.
    pub fn scale(&self) -> f64 {
        self.scale.unwrap_or(1.0)
    }

    /// Returns whether names are drawn on plates.
    pub fn marks(&self) -> bool {
        self.marks.unwrap_or(true)
    }

    /// Returns the number of points of the coupler curve: half a degree of the crank apart by default.
    pub fn samples(&self) -> usize {
        self.samples.unwrap_or(crate::mechanism::four_bar::coupler_curve::DEFAULT_SAMPLES)
    }

    /// Returns the number of crank angles of a cycle: one degree apart by default.
    pub fn positions(&self) -> usize {
        self.positions.unwrap_or(360)
    }
}

/// The largest number that a setting accepts.
const LARGEST: f64 = 1e9;

/// A range of numbers up to [`LARGEST`]: the least of them, and the remedy for others.
type Range = (f64, &'static str);
const POSITIVE: Range = (1.0 / LARGEST, "write a number above 0, such as 4 or 2.5");
const NOT_NEGATIVE: Range = (0.0, "write a number of 0 or more, such as 0.2");
const ANY: Range = (-LARGEST, "write a number, such as 30");

fn number(key: &str, value: &str, (least, help): Range) -> Result<f64, Refusal> {
    let wrong = |message: String| Err(Refusal::new(message, help));
    match value.parse::<f64>() {
        Ok(number) if (least..=LARGEST).contains(&number) => Ok(number),
        Ok(_) => wrong(format!("`{key}` is out of range: {value}")),
        Err(_) => {
            let comma = if value.contains(',') { ", with a decimal point instead of the comma" } else { "" };
            wrong(format!("`{key}` is not a number: {value}{comma}"))
        }
    }
}

/// Reads the width and the height of a sheet, such as `600x300`.
fn sheet(value: &str) -> Result<[f64; 2], Refusal> {
    let help = "write its width and its height, such as 600x300";
    let Some((width, height)) = value.split_once(['x', 'X', '×']) else {
        return Err(Refusal::new(format!("`sheet_mm` is no size of a sheet: {value}"), help));
    };
    let side = |text: &str| number("sheet_mm", text.trim(), (POSITIVE.0, help));
    Ok([side(width)?, side(height)?])
}

fn yes_or_no(key: &str, value: &str) -> Result<bool, Refusal> {
    match value {
        "yes" | "true" => Ok(true),
        "no" | "false" => Ok(false),
        _ => Err(Refusal::new(format!("`{key}` is neither yes nor no: {value}"), "write yes or no")),
    }
}

fn count(key: &str, value: &str, range: std::ops::RangeInclusive<usize>) -> Result<usize, Refusal> {
    let found = value.parse::<usize>().ok().filter(|n| range.contains(n));
    found.ok_or_else(|| {
        let help = format!("write a whole number from {} to {}", range.start(), range.end());
        Refusal::new(format!("`{key}` is no such number: {value}"), help)
    })
}
