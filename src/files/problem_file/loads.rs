//! The loads of a problem: the table `[loads]`, with names of bodies and joints that every kind that is searched for has.

use crate::files::diagnostic::Checked;
use crate::files::loads_file::{self, RawLoads};
use crate::files::toml_text::TomlText;
use crate::mechanism::dyad_chain::kinds::DyadChainKind;
use crate::mechanism::loads::{Loads, Mass, Place, Spring};
use crate::mechanism::multi_loop::LinkPair;
use crate::mechanism::{
    AssemblyMode, Complex, FourBar, InvertedSliderCrank, InvertedSliderCrankParameters, Linkage, LinkageKind,
    MultiLoop, SliderCrank, SliderCrankParameters, Unit,
};
use crate::task::spec::{DesignSpec, LoadsSpec, RequireSpec, TaskSpec};

/// Returns the loads of a problem; `None` without a table.
///
/// # Errors
/// A diagnostic at the key: no unit of lengths; a body or a joint that a kind that is searched for does not have, also one of the
/// six-bars or eight-bars; P in a function; a limit of the torque without loads.
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
    let of_kind =
        |kind: LinkageKind| examples(kind).into_iter().map(move |linkage| (name(kind, &linkage), linkage));
    let linkages: Vec<(String, Linkage)> = kinds.flat_map(of_kind).collect();
    let (metres, applied) = loads_file::of_problem(toml, raw, unit, &linkages)?;
    if task.is_function()
        && let Some(parts) = with_point(&applied)
    {
        let message = "a function has no coupler point: P lies in D";
        return Err(Box::new(toml.at_path(&parts, message).with_help("write D in place of P")));
    }
    Ok(Some(LoadsSpec { metres, applied }))
}

/// Returns the name of a linkage's kind, with that of its chain if there are several.
fn name(kind: LinkageKind, linkage: &Linkage) -> String {
    match linkage {
        Linkage::MultiLoop(linkage) if kind == LinkageKind::SixBar => {
            format!("{} ({})", kind.with_article(), linkage.chain_kind().name())
        }
        _ => kind.with_article().to_string(),
    }
}

/// Returns a linkage of each structure of a kind, by which names are checked.
fn examples(kind: LinkageKind) -> Vec<Linkage> {
    let assembly = AssemblyMode::Plus;
    let of_one_loop = match kind {
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
        LinkageKind::SixBar | LinkageKind::EightBar => {
            let chains = kind.dyads().map_or_else(Vec::new, DyadChainKind::all);
            return chains.into_iter().filter_map(several_loops).collect();
        }
    };
    of_one_loop.into_iter().collect()
}

/// Returns a linkage of a kind of chain, whose joints are all at places of their own.
fn several_loops(kind: DyadChainKind) -> Option<Linkage> {
    let dyads = (0..kind.dyads()).map(|dyad| {
        let apart = dyad as f64;
        let ends = [Complex::new(0.3 + apart, 0.7), Complex::new(4.0 + apart, 0.4 * apart)];
        LinkPair { ends, lengths: [4.0 + apart, 3.0 + apart], side: AssemblyMode::Plus }
    });
    let dyads: Vec<LinkPair> = dyads.collect();
    let pivot = (Complex::new(0.0, 0.0), 1.0);
    MultiLoop::new(kind, pivot, &dyads, Complex::new(2.0, 1.0))
        .ok()
        .map(|linkage| Linkage::MultiLoop(linkage.into()))
}

/// Returns the path of the first key that names P.
fn with_point(loads: &Loads) -> Option<Vec<String>> {
    let is_point = |place: &Place| matches!(place, Place::Joint(name) if name == "P");
    let path = |table: &str, of: &str, key: &str| {
        let parts = ["loads", table, of, key].into_iter().filter(|part| !part.is_empty());
        parts.map(str::to_owned).collect::<Vec<String>>()
    };
    let masses = loads.bodies.iter().find_map(|body| match &body.mass {
        _ if body.body == "P" => Some(path("body", &body.body, "")),
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
