//! The export formats, and the settings that each accepts.

use crate::files::generator::FileKind;

/// A format of an exported file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Skeleton, coupler curve, joints and target as SVG in millimetres.
    Svg,
    /// The plates, laid out, as SVG in millimetres.
    SvgPlates,
    /// Skeleton, coupler curve, joints and target as DXF.
    Dxf,
    /// The plates, laid out, as DXF, ready to be cut.
    DxfPlates,
    /// The plates, laid out, as closed bodies.
    Stl,
    /// A parametric OpenSCAD script.
    Scad,
    /// The cycle: positions, velocities and accelerations.
    Csv,
    /// The linkage as a linkage file.
    Toml,
    /// The linkage as JSON.
    Json,
    /// Hole distances and sizes of each plate, as text.
    CutList,
    /// Hole distances and sizes of each plate, as CSV for a spreadsheet.
    CutListCsv,
    /// A picture (PNG).
    #[cfg(feature = "images")]
    Png,
    /// An animation of the linkage (GIF).
    #[cfg(feature = "images")]
    Gif,
}

/// The error that a word is not the name of a format of this build.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum UnknownFormat {
    /// The word names no format.
    #[error("there is no format {0:?}: choose from {list}", list = Format::list())]
    Unknown(String),
    /// The format was left out when the program was built.
    #[error("this build writes no {0} files: install linkwright with `--features images`")]
    NotBuilt(String),
}

/// The formats that only a build with the feature `images` has.
const PICTURES: [&str; 2] = ["png", "gif"];

impl Format {
    /// All formats of this build.
    pub const ALL: &'static [Format] = &[
        Format::Svg,
        Format::SvgPlates,
        Format::Dxf,
        Format::DxfPlates,
        Format::Stl,
        Format::Scad,
        Format::Csv,
        Format::Toml,
        Format::Json,
        Format::CutList,
        Format::CutListCsv,
        #[cfg(feature = "images")]
        Format::Png,
        #[cfg(feature = "images")]
        Format::Gif,
    ];

    /// Returns the name, the kind of the files and the settings that apply.
    fn about(self) -> (&'static str, FileKind, &'static [&'static str]) {
        const DRAWING: &[&str] = &["scale", "unit", "hole_mm", "crank_deg", "samples"];
        const MARKED: &[&str] = &[
            "scale",
            "unit",
            "hole_mm",
            "motor_hole_mm",
            "boss_hole_mm",
            "margin_mm",
            "kerf_mm",
            "gap_mm",
            "sheet_mm",
            "marks",
        ];
        const BODIES: &[&str] = &[
            "scale",
            "unit",
            "hole_mm",
            "motor_hole_mm",
            "boss_hole_mm",
            "margin_mm",
            "thickness_mm",
            "gap_mm",
            "chord_mm",
            "crank_deg",
        ];
        const LIST: &[&str] =
            &["scale", "unit", "hole_mm", "motor_hole_mm", "boss_hole_mm", "margin_mm", "thickness_mm"];
        match self {
            Format::Svg => ("svg", FileKind::Svg, DRAWING),
            Format::SvgPlates => ("svg-plates", FileKind::Svg, &MARKED[..MARKED.len() - 1]),
            Format::Dxf => ("dxf", FileKind::Dxf, DRAWING),
            Format::DxfPlates => ("dxf-plates", FileKind::Dxf, MARKED),
            Format::Stl => ("stl", FileKind::Stl, &BODIES[..BODIES.len() - 1]),
            Format::Scad => ("scad", FileKind::Scad, BODIES),
            Format::Csv => ("csv", FileKind::Csv, &["scale", "positions", "omega_rad_s"]),
            Format::Toml => ("toml", FileKind::Linkage, &["scale", "unit"]),
            Format::Json => ("json", FileKind::LinkageJson, &["scale", "unit"]),
            Format::CutList => ("cut-list", FileKind::CutList, LIST),
            Format::CutListCsv => ("cut-list-csv", FileKind::Csv, LIST),
            #[cfg(feature = "images")]
            Format::Png => ("png", FileKind::Png, &["size_px", "crank_deg", "samples"]),
            #[cfg(feature = "images")]
            Format::Gif => ("gif", FileKind::Gif, &["size_px", "frames", "samples"]),
        }
    }

    /// Returns the name on the command line.
    pub fn name(self) -> &'static str {
        self.about().0
    }

    /// Returns the kind of its files.
    pub fn kind(self) -> FileKind {
        self.about().1
    }

    /// Returns the names of the settings that apply to it.
    pub fn settings(self) -> &'static [&'static str] {
        self.about().2
    }

    /// Returns whether the file shows plates or lists them.
    pub(super) fn has_plates(self) -> bool {
        self.settings().contains(&"margin_mm")
    }

    /// Returns whether the file is text, which may go to standard output.
    pub fn is_text(self) -> bool {
        !PICTURES.contains(&self.name())
    }

    /// Returns the names of all formats, separated by commas.
    pub fn list() -> String {
        Format::ALL.iter().map(|format| format.name()).collect::<Vec<_>>().join(", ")
    }
}

impl std::str::FromStr for Format {
    type Err = UnknownFormat;
    fn from_str(text: &str) -> Result<Self, UnknownFormat> {
        let word = text.trim();
        match Format::ALL.iter().find(|format| format.name() == word) {
            Some(format) => Ok(*format),
            None if PICTURES.contains(&word) => Err(UnknownFormat::NotBuilt(word.to_owned())),
            None => Err(UnknownFormat::Unknown(word.to_owned())),
        }
    }
}
