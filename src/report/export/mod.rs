//! Export of linkages to files for building them: drawings in true millimetres, cutting and printing files, lists.
//!
//! Every file is derived from a linkage and, if there is a run, from its record; the same record gives the same bytes.
//! CAD formats are in millimetres: a length x of the file becomes x times its unit times [`Settings::scale`]; a file
//! without a unit is taken to be in millimetres, which a note mentions. Every size of a plate is a setting with a
//! default that follows from the linkage; [`Exported::notes`] and the file itself state the sizes that were chosen.
//!
//! | format | contents | module |
//! |---|---|---|
//! | `svg`, `svg-plates` | drawings, one unit of the view box a millimetre | `svg`, `skeleton` |
//! | `dxf`, `dxf-plates` | AutoCAD 2000 drawings, `$INSUNITS` millimetres | `dxf`, `drafting`, `marks`, `skeleton` |
//! | `stl` | the plates as closed bodies, laid out side by side | `mesh`, `stl` |
//! | `scad` | an OpenSCAD script with every size as a parameter | `openscad` |
//! | `cut-list`, `cut-list-csv` | hole distances and sizes of each plate, with shop data pins and spacers | `cut_list`, `stock` |
//! | `csv`, `toml`, `json` | the cycle and the linkage, in the file's own unit | |
//! | `png`, `gif` | a picture, the linkage in motion (feature `images`) | `images` |

mod cut_list;
mod drafting;
mod dxf;
mod format;
mod holes;
#[cfg(feature = "images")]
mod images;
mod marks;
mod mesh;
mod model;
mod openscad;
mod settings;
mod skeleton;
mod stl;
mod stock;
mod subject;
mod svg;

pub use format::{Format, UnknownFormat};
pub use settings::{Refusal, Settings};
pub use subject::Subject;

use crate::files::linkage_file;
use crate::mechanism::CrankLinkage;
use crate::mechanism::analysis::driven::{MechanismRequest, analyze_mechanism};
use crate::mechanism::analysis::{Request, analyze, full_turn};
use crate::mechanism::four_bar::motion::CrankMotion;
use crate::record::Tool;
use crate::report::analysis_csv::analysis_csv;
use crate::report::mechanism_text::mechanism_csv;
use crate::report::text::exact;
use model::Model;

/// An exported file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Exported {
    /// The contents of the file: text if [`Format::is_text`].
    pub bytes: Vec<u8>,
    /// The assumptions that were made, one sentence each.
    pub notes: Vec<String>,
}

/// Writes a subject in a format.
///
/// # Errors
/// [`Refusal`] if a setting does not fit the linkage (holes that run into each other, a crank angle at which the loop
/// is open), or if the linkage has no position or no sensible size in millimetres.
pub fn export(subject: &Subject, format: Format, settings: &Settings) -> Result<Exported, Refusal> {
    match format {
        Format::Csv | Format::Toml | Format::Json => own_unit(subject, format, settings),
        _ => {
            let model = Model::new(subject, settings)?;
            let bytes = in_millimetres(&model, format)?;
            Ok(Exported { bytes, notes: model.notes(format) })
        }
    }
}

fn in_millimetres(model: &Model<'_>, format: Format) -> Result<Vec<u8>, Refusal> {
    let text = match format {
        Format::Svg => svg::drawing(model, &model.pose()?),
        Format::SvgPlates => svg::plates(model, &model.plates()?),
        Format::Dxf => drafting::sketch(model, &model.pose()?),
        Format::DxfPlates => drafting::plates(model, &model.plates()?),
        Format::Stl => stl::plates(model, &model.plates()?)?,
        Format::Scad => openscad::script(model)?,
        Format::CutList => cut_list::text(model, &model.plates()?),
        Format::CutListCsv => cut_list::csv(model, &model.plates()?),
        #[cfg(feature = "images")]
        Format::Png => return images::png(model),
        #[cfg(feature = "images")]
        Format::Gif => return images::gif(model),
        Format::Csv | Format::Toml | Format::Json => String::new(),
    };
    Ok(text.into_bytes())
}

/// Writes a subject in one of the formats that keep the file's own unit.
fn own_unit(subject: &Subject, format: Format, settings: &Settings) -> Result<Exported, Refusal> {
    let linkage = model::scaled_loop(&subject.linkage, settings.scale())?;
    let unit = model::unit_of(subject, settings)?;
    let mut notes = Vec::new();
    let text = match format {
        Format::Csv => {
            let speed_rad_s = settings.omega_rad_s.unwrap_or_else(|| {
                notes.push("omega_rad_s = 1: velocities are those at 1 rad/s".to_owned());
                1.0
            });
            let (name, input) = (subject.name.clone(), CrankMotion::steady(speed_rad_s).into());
            let crank_deg = full_turn(settings.positions());
            notes.extend(
                subject.frame_deg.map(|deg| format!("the body's angle is coupler_deg + {}", exact(deg))),
            );
            match linkage {
                CrankLinkage::FourBar(linkage) => {
                    let methods = Vec::new();
                    let all_configurations = false;
                    analysis_csv(&analyze(&Request {
                        name,
                        unit,
                        linkage,
                        crank_deg,
                        input,
                        methods,
                        all_configurations,
                    }))
                }
                _ => {
                    let linkage = linkage.into();
                    let request = MechanismRequest { name, unit, linkage, crank_deg, input };
                    mechanism_csv(&analyze_mechanism(&request))
                }
            }
        }
        Format::Toml => linkage_file::to_toml_with(&subject.legal_name(), unit, &linkage, subject.carried),
        _ => {
            let mut object = serde_json::json!({
                "format": linkage_file::FORMAT,
                "tool": Tool::this(),
                "name": subject.legal_name(),
                "linkage": linkage,
            });
            if let Some(unit) = unit {
                object["unit"] = unit.label().into();
            }
            match subject.carried {
                None => {}
                Some(linkage_file::Carried::Body(frame_deg)) => object["frame_deg"] = frame_deg.into(),
                Some(linkage_file::Carried::Places([input, output], sense)) => {
                    object["input_offset_deg"] = input.into();
                    object["output_offset"] = output.into();
                    object["sense"] = super::words::sense(sense).into();
                }
                Some(linkage_file::Carried::Function([input, output], sense)) => {
                    object["input_offset_deg"] = input.into();
                    object["output_offset_deg"] = output.into();
                    object["sense"] = super::words::sense(sense).into();
                }
            }
            format!("{object:#}\n")
        }
    };
    Ok(Exported { bytes: text.into_bytes(), notes })
}
