//! Files of loads as text.

use crate::files::generator::mark;
use crate::files::linkage_file::FORMAT;
use crate::mechanism::Unit;
use crate::mechanism::loads::{
    BodyMass, Couple, CrankSpeed, Force, ForceVector, Loads, Mass, Place, Quantity, Spring,
};
use std::f64::consts::TAU;
use std::fmt::Write as _;

/// Returns the text of a file of loads with lengths in a unit; it reads back to the same loads within 12 digits.
pub fn to_toml(name: &str, unit: Unit, loads: &Loads) -> String {
    let writer = Writer { metres: unit.factor_to(Unit::M) };
    let name = string(name);
    let mut text = format!(
        "# Loads of a linkage, {}.\nformat = {FORMAT}\nname = {name}\nunit = \"{}\"\n\n[loads]\n",
        mark(),
        unit.label()
    );
    if loads.gravity != [0.0; 2] {
        line(&mut text, "gravity", &numbers(&loads.gravity));
    }
    let rpm = |speed_rad_s: f64| speed_rad_s * 60.0 / TAU;
    match &loads.speed_rad_s {
        None => {}
        Some(CrankSpeed::Steady(speed)) => line(&mut text, "speed_rpm", &number(rpm(*speed))),
        Some(CrankSpeed::Table(table)) => {
            line(&mut text, "speed_rpm", &rows(table.iter().map(|(angle, speed)| (*angle, [rpm(*speed)]))));
        }
    }
    for body in &loads.bodies {
        writer.body(&mut text, body);
    }
    for force in &loads.forces {
        writer.force(&mut text, force);
    }
    for Couple { body, moment } in &loads.couples {
        text.push_str("\n[[loads.couple]]\n");
        line(&mut text, "body", &string(body));
        quantity(&mut text, "moment_N_m", moment);
    }
    for spring in &loads.springs {
        writer.spring(&mut text, spring);
    }
    text
}

struct Writer {
    metres: f64,
}

impl Writer {
    fn length(&self, metres: f64) -> String {
        number(metres / self.metres)
    }

    fn point(&self, [x, y]: [f64; 2]) -> String {
        numbers(&[x / self.metres, y / self.metres])
    }

    fn place(&self, place: &Place) -> String {
        match place {
            Place::Joint(name) => string(name),
            Place::Fixed(at) => self.point(*at),
            Place::OnBody(body, at) => format!("{{ body = {}, at = {} }}", string(body), self.point(*at)),
        }
    }

    fn body(&self, text: &mut String, BodyMass { body, mass }: &BodyMass) {
        let is_bare = !body.is_empty() && body.chars().all(|c| c.is_ascii_alphanumeric() || c == '-');
        let key = if is_bare { body.clone() } else { string(body) };
        push(text, &format!("\n[loads.body.{key}]\n"));
        match mass {
            Mass::Given { mass_kg, center, inertia_kg_m2 } => {
                line(text, "mass_kg", &number(*mass_kg));
                line(text, "center", &self.point(*center));
                line(text, "inertia_kg_m2", &number(*inertia_kg_m2));
            }
            Mass::AtJoint { mass_kg, joint, inertia_kg_m2 } => {
                line(text, "mass_kg", &number(*mass_kg));
                line(text, "at", &string(joint));
                line(text, "inertia_kg_m2", &number(*inertia_kg_m2));
            }
            Mass::Plate { density_kg_m3, thickness, width } => {
                line(text, "density_kg_m3", &number(*density_kg_m3));
                line(text, "thickness", &self.length(*thickness));
                line(text, "width", &self.length(*width));
            }
        }
    }

    fn force(&self, text: &mut String, force: &Force) {
        text.push_str("\n[[loads.force]]\n");
        line(text, "at", &self.place(&force.at));
        if let Some(body) = &force.body {
            line(text, "body", &string(body));
        }
        match &force.vector {
            ForceVector::Vector(value, along) => {
                quantity(text, "force_N", value);
                if let Some(body) = along {
                    line(text, "along", &string(body));
                }
            }
            ForceVector::Opposing(value) => quantity(text, "opposing_N", value),
        }
    }

    fn spring(&self, text: &mut String, spring: &Spring) {
        text.push_str("\n[[loads.spring]]\n");
        match spring {
            Spring::Extension { ends: [from, to], rate, free_length } => {
                line(text, "from", &self.place(from));
                line(text, "to", &self.place(to));
                line(text, "rate_N_per_m", &number(*rate));
                line(text, "free_length", &self.length(*free_length));
            }
            Spring::Torsion { bodies: [body, against], rate, free_angle } => {
                line(text, "body", &string(body));
                line(text, "against", &string(against));
                line(text, "rate_N_m_per_rad", &number(*rate));
                line(text, "free_angle_deg", &number(free_angle.to_degrees()));
            }
        }
    }
}

fn push(text: &mut String, more: &str) {
    text.push_str(more);
}

fn line(text: &mut String, key: &str, value: &str) {
    // Writing to a text never fails.
    let _ = writeln!(text, "{key} = {value}");
}

/// Writes a constant under its own key, a table of rows under `table`.
fn quantity<const N: usize>(text: &mut String, key: &str, value: &Quantity<N>) {
    match value {
        Quantity::Constant(value) => match value.as_slice() {
            [only] => line(text, key, &number(*only)),
            all => line(text, key, &numbers(all)),
        },
        Quantity::Table(table) => line(text, "table", &rows(table.iter().copied())),
    }
}

/// Returns the rows of a table over the crank angle, which is in radians.
fn rows<const N: usize>(rows: impl Iterator<Item = (f64, [f64; N])>) -> String {
    let row = |(angle, value): (f64, [f64; N])| {
        let cells: Vec<f64> = std::iter::once(angle.to_degrees()).chain(value).collect();
        numbers(&cells)
    };
    let rows: Vec<String> = rows.map(row).collect();
    format!("[{}]", rows.join(", "))
}

fn string(text: &str) -> String {
    toml::Value::String(text.to_owned()).to_string()
}

/// Returns a number to 12 digits: one that was converted from another unit reads as it was written.
fn number(value: f64) -> String {
    let rounded = format!("{value:.11e}").parse().unwrap_or(value);
    format!("{:?}", if rounded == 0.0 { 0.0 } else { rounded })
}

fn numbers(values: &[f64]) -> String {
    let all: Vec<String> = values.iter().map(|value| number(*value)).collect();
    format!("[{}]", all.join(", "))
}
