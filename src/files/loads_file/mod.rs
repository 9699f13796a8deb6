//! Loads: the table `[loads]` of a linkage file, and files of loads alone, read by the same code.
//!
//! A loads file has `format`, `unit` and `[loads]`, and is about the linkage that it is read for, against which its names of bodies
//! and joints are checked.

mod raw;
mod write;

pub(crate) use raw::RawLoads;
pub use write::to_toml;

use super::diagnostic::{Checked, Diagnostic};
use super::input_text;
use super::linkage_file::{AnyLinkageFile, FORMAT, check_format, checked_name};
use super::toml_text::{TomlText, nearest};
use super::toml_values::{Count, OnlyTable};
use crate::mechanism::loads::{
    BodyMass, Couple, CrankSpeed, Drive, Force, ForceVector, LoadError, LoadFault, LoadKey, LoadedLinkage,
    Loads, Mass, Place, Quantity, Spring,
};
use crate::mechanism::{Linkage, Unit};
use raw::{RawBody, RawCouple, RawForce, RawPlace, RawSpeed, RawSpring, Row};
use schemars::JsonSchema;
use serde::Deserialize;
use std::f64::consts::TAU;
use std::path::Path;

/// A file of loads.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "LoadsFile")]
struct RawLoadsFile {
    format: Option<Count>,
    name: Option<String>,
    unit: Option<Unit>,
    loads: Option<OnlyTable<RawLoads>>,
}

/// The name of the coupler point, which also names the body that carries it.
const TRACED: &str = "P";

/// Help for lengths without a unit.
const UNIT_HELP: &str =
    "write unit = \"mm\" (or cm, m, in) below format: torques and masses need real lengths";

/// Reads a file of loads for a linkage.
///
/// # Errors
/// A [`Diagnostic`] that points at the fault: a key, a number, or a name that the linkage does not have; a missing unit, of this
/// file or of the linkage.
pub fn load(path: &Path, linkage: &AnyLinkageFile) -> Checked<Loads> {
    let text = input_text::read(path)?;
    parse(&path.display().to_string(), &text, linkage)
}

/// Reads a file of loads without a linkage, so that its names of bodies and joints are not checked.
///
/// # Errors
/// A [`Diagnostic`] that points at the fault.
pub fn load_alone(path: &Path) -> Checked<Loads> {
    let (text, file) = (input_text::read(path)?, path.display().to_string());
    let toml = TomlText { file: &file, text: input_text::without_mark(&text) };
    let (loads, unit) = tables(&toml)?;
    let loads = Reader { toml: &toml, metres: unit.factor_to(Unit::M) }.loads(loads)?;
    if let Some(Err(fault)) = loads.speed_rad_s.as_ref().map(Drive::of) {
        return Err(Box::new(explain(&toml, &LoadError { key: LoadKey::Top("speed"), fault })));
    }
    Ok(loads)
}

/// Reads the text of a file of loads; `file_name` is shown in diagnostics.
///
/// # Errors
/// As [`load`].
pub fn parse(file_name: &str, text: &str, linkage: &AnyLinkageFile) -> Checked<Loads> {
    let toml = TomlText { file: file_name, text: input_text::without_mark(text) };
    let (loads, unit) = tables(&toml)?;
    let Some(of_linkage) = linkage.unit else {
        let help = "write unit = \"mm\" (or cm, m, in) into the linkage's own file";
        return toml.refuse_file(
            format!("the linkage {} has no unit, so that its lengths in metres are not known", linkage.name),
            help,
        );
    };
    checked(&toml, loads, unit, (&linkage.linkage, of_linkage))
}

/// Reads the table and the unit of a file of loads.
fn tables(toml: &TomlText<'_>) -> Checked<(RawLoads, Unit)> {
    let raw: RawLoadsFile = toml.read()?;
    check_format(toml, raw.format, FORMAT)?;
    checked_name(toml, raw.name, "loads")?;
    let Some(OnlyTable(loads)) = raw.loads else {
        return toml.refuse_file("there are no loads in this file", "a loads file has a table [loads]");
    };
    let Some(unit) = raw.unit else {
        return toml.refuse_file("the key `unit` is missing: loads need the unit of lengths", UNIT_HELP);
    };
    Ok((loads, unit))
}

/// Reads the loads of a linkage file.
pub(crate) fn of_linkage_file(
    toml: &TomlText<'_>,
    raw: RawLoads,
    unit: Option<Unit>,
    linkage: &Linkage,
) -> Checked<Loads> {
    let Some(unit) = unit else {
        return toml.refuse_key(
            "loads",
            "the key `unit` is missing: loads need the unit of lengths",
            UNIT_HELP,
        );
    };
    checked(toml, raw, unit, (linkage, unit))
}

/// Reads the loads of a problem, checked against a linkage of each structure that is searched for, with its name where there are
/// several. Returns the unit of lengths in metres with them.
pub(crate) fn of_problem(
    toml: &TomlText<'_>,
    raw: RawLoads,
    unit: Option<Unit>,
    linkages: &[(String, Linkage)],
) -> Checked<(f64, Loads)> {
    let Some(unit) = unit else {
        let message = "the key `unit` is missing: loads need the unit of lengths";
        return toml.refuse_key("loads", message, UNIT_HELP);
    };
    let metres = unit.factor_to(Unit::M);
    let loads = Reader { toml, metres }.loads(raw)?;
    for (name, linkage) in linkages {
        if let Err(error) = LoadedLinkage::new(linkage, unit, &loads) {
            let diagnostic = explain(toml, &error);
            let message = match linkages.len() {
                1 => diagnostic.message.clone(),
                _ => format!("{name}, which is searched for: {}", diagnostic.message),
            };
            return Err(Box::new(Diagnostic { message, ..diagnostic }));
        }
    }
    Ok((metres, loads))
}

/// Converts a speed from turns a minute and degrees.
fn speed(raw: RawSpeed) -> CrankSpeed {
    let rad_s = |rpm: f64| rpm * (TAU / 60.0);
    match raw {
        RawSpeed::Steady(rpm) => CrankSpeed::Steady(rad_s(rpm.0)),
        RawSpeed::Table(rows) => CrankSpeed::Table(
            rows.into_iter().map(|Row([deg, rpm])| (deg.to_radians(), rad_s(rpm))).collect(),
        ),
    }
}

/// Converts raw loads to SI and checks them against a linkage.
fn checked(
    toml: &TomlText<'_>,
    raw: RawLoads,
    unit: Unit,
    (linkage, of_linkage): (&Linkage, Unit),
) -> Checked<Loads> {
    let loads = Reader { toml, metres: unit.factor_to(Unit::M) }.loads(raw)?;
    match LoadedLinkage::new(linkage, of_linkage, &loads) {
        Ok(_) => Ok(loads),
        Err(error) => Err(Box::new(explain(toml, &error))),
    }
}

/// Returns the parts of the path of a load's key.
fn parts(key: &LoadKey) -> Vec<String> {
    let path = |table: &str, of: &str, key: &str| {
        let parts = ["loads", table, of, key].into_iter().filter(|part| !part.is_empty());
        parts.map(str::to_owned).collect::<Vec<String>>()
    };
    match key {
        LoadKey::Top(key) => path("", "", if *key == "speed" { "speed_rpm" } else { key }),
        LoadKey::Body(name, key) => path("body", name, key),
        LoadKey::Force(i, key) => path("force", &i.to_string(), key),
        LoadKey::Couple(i, key) => path("couple", &i.to_string(), key),
        LoadKey::Spring(i, key) => path("spring", &i.to_string(), key),
    }
}

/// Returns the diagnostic of a load that does not fit, at the key that it is about; the values of a table are under `table`.
fn explain(toml: &TomlText<'_>, error: &LoadError) -> Diagnostic {
    let mut parts = parts(&error.key);
    let is_speed = matches!(error.key, LoadKey::Top(_));
    match error.fault {
        LoadFault::BadTable if !is_speed => {
            if let Some(last) = parts.last_mut() {
                *last = "table".to_owned();
            }
        }
        LoadFault::SpeedJumps { row } | LoadFault::SpeedStops { row, .. } => parts.push(row.to_string()),
        _ => {}
    }
    let message = error.fault.to_string();
    let whole_table = matches!(&error.key, LoadKey::Body(_, ""));
    let diagnostic =
        if whole_table { toml.at_key_path(&parts, message) } else { toml.at_path(&parts, message) };
    diagnostic.with_help(hint(&error.fault) + &error.fault.remedy())
}

/// Returns the name that an unknown one is nearest to, as a question.
fn hint(fault: &LoadFault) -> String {
    let (LoadFault::UnknownBody { name, known } | LoadFault::UnknownJoint { name, known }) = fault else {
        return String::new();
    };
    let known: Vec<&str> = known.iter().map(String::as_str).collect();
    nearest(name, &known).map_or_else(String::new, |name| format!("did you mean \"{name}\"? "))
}

/// Reads raw loads, with metres in the unit of their lengths.
struct Reader<'t, 'a> {
    toml: &'t TomlText<'a>,
    metres: f64,
}

impl Reader<'_, '_> {
    fn refuse<T>(&self, path: &[&str], message: &str, help: &str) -> Checked<T> {
        let parts: Vec<String> = path.iter().map(|part| (*part).to_owned()).collect();
        Err(Box::new(self.toml.at_key_path(&parts, message).with_help(help)))
    }

    fn point(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [x * self.metres, y * self.metres]
    }

    fn loads(&self, raw: RawLoads) -> Checked<Loads> {
        let mut loads = Loads {
            gravity: raw.gravity.map_or([0.0; 2], |gravity| gravity.0),
            speed_rad_s: raw.speed_rpm.map(speed),
            ..Loads::default()
        };
        for (body, OnlyTable(raw)) in raw.body.map_or_else(Default::default, |bodies| bodies.0) {
            let mass = self.mass(&body, &raw)?;
            loads.bodies.push(BodyMass { body, mass });
        }
        for (i, OnlyTable(raw)) in raw.force.into_iter().enumerate() {
            loads.forces.push(self.force(i, raw)?);
        }
        for (i, OnlyTable(raw)) in raw.couple.into_iter().enumerate() {
            loads.couples.push(self.couple(i, raw)?);
        }
        for (i, OnlyTable(raw)) in raw.spring.into_iter().enumerate() {
            loads.springs.push(self.spring(i, raw)?);
        }
        Ok(loads)
    }

    fn mass(&self, name: &str, raw: &RawBody) -> Checked<Mass> {
        let refuse = |key: &str, message: &str, help: &str| {
            let path = ["loads", "body", name, key];
            self.refuse(if key.is_empty() { &path[..3] } else { &path }, message, help)
        };
        match (raw.mass_kg, raw.density_kg_m3) {
            (Some(mass), None) => {
                if raw.thickness.is_some() || raw.width.is_some() {
                    let key = if raw.thickness.is_some() { "thickness" } else { "width" };
                    return refuse(key, "thickness and width go with density_kg_m3", "remove it");
                }
                let inertia_kg_m2 = raw.inertia_kg_m2.map_or(0.0, |inertia| inertia.0);
                // The mass of what hangs at P lies there, whatever body carries it.
                let own = (name == TRACED && raw.center.is_none()).then(|| TRACED.to_owned());
                if let Some(joint) = raw.at.clone().or(own) {
                    if raw.center.is_some() {
                        let help = "keep one of the two keys";
                        return refuse("at", "two centres of mass: center and at", help);
                    }
                    return Ok(Mass::AtJoint { mass_kg: mass.0, joint, inertia_kg_m2 });
                }
                Ok(Mass::Given {
                    mass_kg: mass.0,
                    center: self.point(raw.center.map_or([0.0; 2], |center| center.0)),
                    inertia_kg_m2,
                })
            }
            (None, Some(density)) => {
                let given = [
                    ("center", raw.center.is_some()),
                    ("at", raw.at.is_some()),
                    ("inertia_kg_m2", raw.inertia_kg_m2.is_some()),
                ];
                if let Some((key, _)) = given.into_iter().find(|(_, there)| *there) {
                    let help = "remove it, or give mass_kg in place of density_kg_m3";
                    return refuse(key, "centre and inertia of a plate follow from its outline", help);
                }
                let (Some(thickness), Some(width)) = (raw.thickness, raw.width) else {
                    let help = "add thickness = 3 and width = 20, in the file's unit";
                    return refuse("density_kg_m3", "a plate needs a thickness and a width", help);
                };
                Ok(Mass::Plate {
                    density_kg_m3: density.0,
                    thickness: thickness.0 * self.metres,
                    width: width.0 * self.metres,
                })
            }
            (Some(_), Some(_)) => {
                refuse("density_kg_m3", "two masses: mass_kg and density_kg_m3", "keep one of the two keys")
            }
            (None, None) => refuse(
                "",
                "this body has no mass",
                "add mass_kg = 0.2, or density_kg_m3 with thickness and width",
            ),
        }
    }

    fn place(&self, raw: RawPlace) -> Place {
        match raw {
            RawPlace::Joint(name) => Place::Joint(name),
            RawPlace::Fixed(at) => Place::Fixed(self.point(at)),
            RawPlace::OnBody(place) => Place::OnBody(place.body, self.point(place.at.0)),
        }
    }

    fn force(&self, i: usize, raw: RawForce) -> Checked<Force> {
        let number = i.to_string();
        let refuse = |key: &str, message: &str, help: &str| {
            self.refuse(&["loads", "force", &number, key], message, help)
        };
        let vector = match (raw.force, raw.table, raw.opposing) {
            (Some(force), None, None) => ForceVector::Vector(Quantity::Constant(force.0), raw.along),
            (None, Some(table), None) => {
                let row = |Row([deg, x, y]): Row<3>| (deg.to_radians(), [x, y]);
                ForceVector::Vector(Quantity::Table(table.into_iter().map(row).collect()), raw.along)
            }
            (None, None, Some(size)) => {
                if raw.along.is_some() {
                    return refuse("along", "a force against a velocity has its direction", "remove along");
                }
                ForceVector::Opposing(Quantity::Constant([size.0]))
            }
            (None, None, None) => {
                let help = "add force_N = [0, -10], table = [[0, 0, -10], [180, 0, -5]] or opposing_N = 5";
                return refuse("at", "this force has no size", help);
            }
            (Some(_), Some(_), _) => {
                return refuse("table", "two sizes: force_N and table", "keep one of the two");
            }
            (.., Some(_)) => return refuse("opposing_N", "two sizes of one force", "keep one of the two"),
        };
        Ok(Force { at: self.place(raw.at), body: raw.body, vector })
    }

    fn couple(&self, i: usize, raw: RawCouple) -> Checked<Couple> {
        let number = i.to_string();
        let refuse = |key: &str, message: &str, help: &str| {
            self.refuse(&["loads", "couple", &number, key], message, help)
        };
        let moment = match (raw.moment, raw.table) {
            (Some(moment), None) => Quantity::Constant([moment.0]),
            (None, Some(table)) => {
                Quantity::Table(table.into_iter().map(|Row([deg, m])| (deg.to_radians(), [m])).collect())
            }
            (Some(_), Some(_)) => {
                return refuse("table", "two moments: moment_N_m and table", "keep one of the two keys");
            }
            (None, None) => {
                let help = "add moment_N_m = 0.3, or table = [[0, 0.3], [180, 0.1]]";
                return refuse("body", "this couple has no moment", help);
            }
        };
        Ok(Couple { body: raw.body, moment })
    }

    fn spring(&self, i: usize, raw: RawSpring) -> Checked<Spring> {
        let number = i.to_string();
        let refuse = |key: &str, message: &str, help: &str| {
            self.refuse(&["loads", "spring", &number, key], message, help)
        };
        let is_torsion = raw.body.is_some();
        let of_torsion = [
            ("against", raw.against.is_some()),
            ("rate_N_m_per_rad", raw.torsion_rate.is_some()),
            ("free_angle_deg", raw.free_angle_deg.is_some()),
        ];
        let of_extension = [
            ("from", raw.from.is_some()),
            ("to", raw.to.is_some()),
            ("rate_N_per_m", raw.rate.is_some()),
            ("free_length", raw.free_length.is_some()),
        ];
        let strange: &[(&str, bool)] = if is_torsion { &of_extension } else { &of_torsion };
        if let Some((key, _)) = strange.iter().find(|(_, there)| *there) {
            let help = "a spring has from, to, rate_N_per_m and free_length, or body, rate_N_m_per_rad and free_angle_deg";
            return refuse(key, &format!("{key} is of the other kind of spring"), help);
        }
        if let Some(body) = raw.body {
            let Some(rate) = raw.torsion_rate else {
                return refuse("body", "this torsion spring has no rate", "add rate_N_m_per_rad = 0.5");
            };
            let Some(free) = raw.free_angle_deg else {
                return refuse("body", "this torsion spring has no free angle", "add free_angle_deg = 90");
            };
            let against = raw.against.unwrap_or_else(|| "ground".to_owned());
            let (rate, free_angle) = (rate.0, free.0.to_radians());
            return Ok(Spring::Torsion { bodies: [body, against], rate, free_angle });
        }
        let (Some(from), Some(to)) = (raw.from, raw.to) else {
            let key = of_extension.iter().find(|(_, there)| *there).map_or("", |(key, _)| key);
            let help = "add from = \"D\" and to = [50, 80]: joints, fixed points or places on bodies";
            return refuse(key, "this spring lacks an end", help);
        };
        let Some(rate) = raw.rate else {
            return refuse("from", "this spring has no rate", "add rate_N_per_m = 400");
        };
        let Some(free) = raw.free_length else {
            let help = "add free_length = 30, in the file's unit: the length at which it bears no force";
            return refuse("from", "this spring has no free length", help);
        };
        let ends = [self.place(from), self.place(to)];
        Ok(Spring::Extension { ends, rate: rate.0, free_length: free.0 * self.metres })
    }
}
