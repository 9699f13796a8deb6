//! The loads of a problem: the table `[loads]`, with names of bodies and joints that every kind that is searched for has.

use crate::files::diagnostic::Checked;
use crate::files::loads_file::{self, RawLoads};
use crate::files::toml_text::TomlText;
use crate::mechanism::loads::{Loads, Mass, Place, Spring};
use crate::mechanism::{
    AssemblyMode, Complex, FourBar, InvertedSliderCrank, InvertedSliderCrankParameters, Linkage, LinkageKind,
    SliderCrank, SliderCrankParameters, Unit,
};
use crate::task::spec::{DesignSpec, LoadsSpec, RequireSpec, TaskSpec};

/// Returns the loads of a problem; `None` without a table.
///
/// # Errors
/// A diagnostic at the key: no unit of lengths; a body or a joint that a kind that is searched for does not have; six-bars and
/// eight-bars, whose bodies differ from one to the next; P in a function; a limit of the torque without loads.
pub(super) fn of(
    toml: &TomlText<'_>,
    raw: Option<RawLoads>,
    unit: Option<Unit>,
    (task, design, require): (&TaskSpec, &DesignSpec, &RequireSpec),
) -> Checked<Option<LoadsSpec>> {
    let Some(raw) = raw else {
        if require.peak_torque_max.is_some() {
            let help = "add a table [loads] with unit = \"mm\" below format, such as gravity = [0, -9.81] and \
                        [loads.body.coupler] with mass_kg = 1 and at = \"P\"; or remove the key";
            return toml.refuse("require.peak_torque_max", "a torque needs loads, and there are none", help);
        }
        return Ok(None);
    };
    let kinds = LinkageKind::ALL.into_iter().filter(|kind| design.searches(*kind));
    let mut linkages = Vec::new();
    for kind in kinds {
        let Some(linkage) = example(kind) else {
            let message =
                format!("loads go with linkages of one loop, and {} has several", kind.with_article());
            let help =
                "remove [loads], and look at what is found with `linkwright analyze LINKAGE --loads FILE`";
            return toml.refuse_key("loads", message, help);
        };
        linkages.push((kind, linkage));
    }
    let (metres, applied) = loads_file::of_problem(toml, raw, unit, &linkages)?;
    if task.is_function()
        && let Some(parts) = with_point(&applied)
    {
        let message = "a function has no coupler point: P lies in D";
        return Err(Box::new(toml.at_path(&parts, message).with_help("write D in place of P")));
    }
    Ok(Some(LoadsSpec { metres, applied }))
}

/// Returns a linkage of a kind, by which names are checked; `None` of several loops.
fn example(kind: LinkageKind) -> Option<Linkage> {
    let assembly = AssemblyMode::Plus;
    match kind {
        LinkageKind::FourBar => {
            let pivots = [Complex::new(0.0, 0.0), Complex::new(4.0, 0.0)];
            let offset = Complex::new(2.0, 1.0);
            FourBar::with_coupler_offset(pivots, [1.0, 4.0, 3.0], offset, assembly).ok().map(Linkage::FourBar)
        }
        LinkageKind::SliderCrank => {
            let parameters = SliderCrankParameters {
                crank_pivot: [0.0, 0.0],
                crank: 1.0,
                coupler: 4.0,
                line_point: [0.0, 0.5],
                line_deg: 0.0,
                coupler_x: 2.0,
                coupler_y: 1.0,
                assembly,
            };
            SliderCrank::new(parameters).ok().map(Linkage::SliderCrank)
        }
        LinkageKind::InvertedSliderCrank => {
            let parameters = InvertedSliderCrankParameters {
                crank_pivot: [0.0, 0.0],
                block_pivot: [4.0, 0.0],
                crank: 1.0,
                offset: 0.5,
                coupler_x: 2.0,
                coupler_y: 1.0,
                assembly,
            };
            InvertedSliderCrank::new(parameters).ok().map(Linkage::InvertedSliderCrank)
        }
        LinkageKind::SixBar | LinkageKind::EightBar => None,
    }
}

/// Returns the path of the first key that names P.
fn with_point(loads: &Loads) -> Option<Vec<String>> {
    let is_point = |place: &Place| matches!(place, Place::Joint(name) if name == "P");
    let path = |table: &str, of: &str, key: &str| ["loads", table, of, key].map(str::to_owned).to_vec();
    let masses = loads.bodies.iter().find_map(|body| match &body.mass {
        Mass::AtJoint { joint, .. } if joint == "P" => Some(path("body", &body.body, "at")),
        _ => None,
    });
    let force = loads.forces.iter().position(|force| is_point(&force.at));
    let springs = || {
        loads.springs.iter().enumerate().find_map(|(i, spring)| match spring {
            Spring::Extension { ends: [from, _], .. } if is_point(from) => {
                Some(path("spring", &i.to_string(), "from"))
            }
            Spring::Extension { ends: [_, to], .. } if is_point(to) => {
                Some(path("spring", &i.to_string(), "to"))
            }
            _ => None,
        })
    };
    masses.or_else(|| force.map(|i| path("force", &i.to_string(), "at"))).or_else(springs)
}
