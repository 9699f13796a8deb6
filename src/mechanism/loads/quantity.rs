//! Quantities of N numbers that are constant, or given over the crank angle.

use super::LoadFault;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::f64::consts::TAU;

/// A quantity that is constant, or given over the crank angle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Written", into = "Written")]
pub enum Quantity<const N: usize> {
    /// Constant.
    Constant([f64; N]),
    /// (crank angle in radians, value) in ascending order within one turn; linear between them, and periodic.
    Table(Vec<(f64, [f64; N])>),
}

/// A quantity as it is written in a record.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
enum Written {
    /// The numbers.
    Constant(Vec<f64>),
    /// (crank angle in radians, numbers) in ascending order within one turn.
    Table(Vec<(f64, Vec<f64>)>),
}

impl<const N: usize> From<Quantity<N>> for Written {
    fn from(quantity: Quantity<N>) -> Written {
        match quantity {
            Quantity::Constant(value) => Written::Constant(value.into()),
            Quantity::Table(rows) => {
                Written::Table(rows.into_iter().map(|(angle, value)| (angle, value.into())).collect())
            }
        }
    }
}

impl<const N: usize> TryFrom<Written> for Quantity<N> {
    type Error = String;

    fn try_from(written: Written) -> Result<Self, String> {
        let numbers = |value: Vec<f64>| -> Result<[f64; N], String> {
            <[f64; N]>::try_from(value).map_err(|value| format!("{} numbers in place of {N}", value.len()))
        };
        Ok(match written {
            Written::Constant(value) => Quantity::Constant(numbers(value)?),
            Written::Table(rows) => {
                let rows = rows.into_iter().map(|(angle, value)| Ok((angle, numbers(value)?)));
                Quantity::Table(rows.collect::<Result<_, String>>()?)
            }
        })
    }
}

impl<const N: usize> JsonSchema for Quantity<N> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "Quantity".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        Written::json_schema(generator)
    }
}

impl<const N: usize> Quantity<N> {
    /// Checks that all numbers are finite, and that a table has two rows or more, in ascending order within one turn.
    ///
    /// # Errors
    /// [`LoadFault::NotFinite`] or [`LoadFault::BadTable`].
    pub(super) fn check(&self) -> Result<(), LoadFault> {
        let finite = |values: &[f64]| match values.iter().find(|value| !value.is_finite()) {
            Some(value) => Err(LoadFault::NotFinite(*value)),
            None => Ok(()),
        };
        match self {
            Quantity::Constant(value) => finite(value),
            Quantity::Table(rows) => {
                rows.iter().try_for_each(|(angle, value)| {
                    finite(&[*angle])?;
                    finite(value)
                })?;
                let ascends = rows.windows(2).all(|pair| pair[0].0 < pair[1].0);
                let turn = TAU * (1.0 + 4.0 * f64::EPSILON);
                let within = rows.len() > 1 && rows[rows.len() - 1].0 - rows[0].0 <= turn;
                if ascends && within { Ok(()) } else { Err(LoadFault::BadTable) }
            }
        }
    }

    /// Returns the value at a crank angle (radians).
    pub(super) fn at(&self, crank_angle: f64) -> [f64; N] {
        let rows = match self {
            Quantity::Constant(value) => return *value,
            Quantity::Table(rows) => rows,
        };
        let [(begin, first), ..] = rows.as_slice() else { return [0.0; N] };
        let angle = begin + (crank_angle - begin).rem_euclid(TAU);
        let next = rows.partition_point(|(at, _)| *at <= angle);
        let (from, low) = rows[next.max(1) - 1];
        let (to, high) = rows.get(next).copied().unwrap_or((begin + TAU, *first));
        let share = if to > from { ((angle - from) / (to - from)).clamp(0.0, 1.0) } else { 0.0 };
        std::array::from_fn(|i| low[i] + (high[i] - low[i]) * share)
    }
}

impl<const N: usize> Quantity<N> {
    /// Returns the quantity with every value mapped; a table keeps its crank angles.
    #[must_use]
    pub fn map(&self, mut value: impl FnMut([f64; N]) -> [f64; N]) -> Self {
        match self {
            Quantity::Constant(numbers) => Quantity::Constant(value(*numbers)),
            Quantity::Table(rows) => {
                Quantity::Table(rows.iter().map(|(angle, numbers)| (*angle, value(*numbers))).collect())
            }
        }
    }

    /// Returns the quantity over crank angles that are mapped to `turn + angle`, or to `turn - angle` if they are reversed.
    #[must_use]
    pub fn turned(&self, turn: f64, reversed: bool) -> Self {
        match self {
            Quantity::Constant(_) => self.clone(),
            Quantity::Table(rows) => {
                let image = |(angle, value): &(f64, [f64; N])| {
                    (turn + if reversed { -angle } else { *angle }, *value)
                };
                let mut rows: Vec<_> = rows.iter().map(image).collect();
                if reversed {
                    rows.reverse();
                }
                Quantity::Table(rows)
            }
        }
    }
}
