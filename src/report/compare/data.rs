//! A comparison as CSV and JSON, for spreadsheets and scripts: every number to the last digit.

use super::{Comparison, LeftOut, Ranked, SortKey};
use crate::mechanism::{CrankLinkage, Unit};
use crate::record::{Candidate, Tool};
use crate::report::csv::{Column, OF_MOTION, cells, figures, names, parameters, parameters_of, written};
use crate::report::text::{cell, exact};
use crate::report::words;
use crate::task::Defect;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Serialize;
use std::borrow::Cow;

/// The version of the format of [`Comparison::json`].
pub const JSON_FORMAT: u32 = 1;

/// The figures of a candidate that are columns here too, by their names in its own table.
const FIGURES: [&str; 10] = [
    "sum_sq",
    "objective",
    "rms",
    "max",
    "max_at",
    "to_curve_rms",
    "type",
    "transmission_worst_deg",
    "transmission_over",
    "link_ratio",
];

/// The columns before those figures.
const PLACE: [Column<Ranked>; 5] = [
    ("rank", |row| row.rank.to_string()),
    ("label", |row| cell(&row.entry.label)),
    ("accepted", |row| row.entry.candidate.accepted.to_string()),
    ("on_front", |row| row.on_front.to_string()),
    ("behind_percent", |row| number(row.behind_percent)),
];

fn number(value: Option<f64>) -> String {
    value.map_or(String::new(), exact)
}

/// Linkages side by side.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "Compared")]
struct Json<'a> {
    /// The version of the format.
    format: u32,
    /// The program that has compared them.
    tool: Tool,
    /// The figures by which they are ranked, in order.
    sort: Vec<&'static str>,
    /// The unit of all lengths; null where they have none in common.
    unit: Option<&'static str>,
    /// Whether all were found for one target.
    same_target: bool,
    /// Whether the lengths of all are in one unit.
    same_unit: bool,
    /// The figures that the front is of.
    front_of: [&'static str; 3],
    /// The label of the one that the others are compared with.
    reference: Option<&'a str>,
    /// The linkages, better first.
    rows: Vec<Row<'a>>,
    /// Results that could not be compared.
    left_out: &'a [LeftOut],
    /// Remarks in words.
    notes: Vec<String>,
}

/// A linkage among others.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "ComparedRow")]
struct Row<'a> {
    /// Its place, from 1.
    rank: usize,
    label: &'a str,
    /// Whether it is a candidate of a run.
    of_run: bool,
    /// The name of its target.
    target: &'a str,
    /// Whether it meets everything that was asked of it.
    accepted: bool,
    /// Whether none of the others is better in all figures of the front.
    on_front: bool,
    /// Its place by each of the figures by which they are ranked.
    ranks: Figures<usize>,
    /// By how much it is worse than the best, in per cent of the first figure.
    behind_percent: Option<f64>,
    /// Its figures by their names.
    figures: Figures<f64>,
    /// By how much each figure is above that of the reference.
    #[serde(skip_serializing_if = "Option::is_none")]
    percent_above_reference: Option<Figures<f64>>,
    /// The point with the largest error.
    max_at: usize,
    /// In a motion: the angle from the direction C -> D to the body's x axis, degrees.
    #[serde(skip_serializing_if = "Option::is_none")]
    frame_deg: Option<f64>,
    #[serde(rename = "type")]
    linkage_type: &'static str,
    /// The motion over which the transmission angle is judged.
    transmission_over: &'static str,
    unit: Option<&'static str>,
    linkage: &'a CrankLinkage,
    /// The crank angle at each point, degrees.
    crank_deg: &'a [f64],
    defects: &'a [Defect],
    /// The requirements that it does not meet.
    unmet: Vec<&'a str>,
    /// The figures for which its record has other values.
    recorded_differently: &'a [String],
}

/// The values for some keys, as an object in their order; a missing value is null.
struct Figures<T>(Vec<(SortKey, Option<T>)>);

impl<T: JsonSchema> JsonSchema for Figures<T> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "Figures".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let value = generator.subschema_for::<T>();
        json_schema!({ "type": "object", "additionalProperties": { "oneOf": [value, { "type": "null" }] } })
    }
}

impl<T: Serialize> Serialize for Figures<T> {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(key, value)| (key.name(), value)))
    }
}

impl<'a> Row<'a> {
    fn new(row: &'a Ranked, keys: &[SortKey], has_angles: bool) -> Self {
        let (entry, candidate) = (&row.entry, &row.entry.candidate);
        let figures = SortKey::ALL.into_iter().filter(|key| has_angles || !key.is_of_motions());
        let differences = SortKey::ALL.into_iter().zip(row.difference_percent.iter().copied());
        let differences = differences.filter(|(key, _)| has_angles || !key.is_of_motions());
        Row {
            rank: row.rank,
            label: &entry.label,
            of_run: entry.of_run,
            target: &entry.target_name,
            accepted: candidate.accepted,
            on_front: row.on_front,
            ranks: Figures(keys.iter().copied().zip(row.ranks.iter().map(|rank| Some(*rank))).collect()),
            behind_percent: row.behind_percent,
            figures: Figures(figures.map(|key| (key, row.figure_of(key))).collect()),
            percent_above_reference: (!row.difference_percent.is_empty())
                .then(|| Figures(differences.collect())),
            max_at: candidate.error.max_at,
            frame_deg: candidate.frame_deg,
            linkage_type: candidate.type_name(),
            transmission_over: words::over(candidate.transmission_deg.over),
            unit: entry.unit.map(Unit::label),
            linkage: &candidate.linkage,
            crank_deg: &candidate.crank_deg,
            defects: &candidate.defects,
            unmet: candidate.requirements.iter().filter(|r| !r.met).map(|r| r.name.as_str()).collect(),
            recorded_differently: &entry.untrue,
        }
    }
}

impl Comparison {
    /// Returns the schema of [`Comparison::json`].
    pub fn schema(generator: &mut SchemaGenerator) -> Schema {
        generator.subschema_for::<Json<'static>>()
    }

    /// Returns one row for each entry, every number to the last digit: place, figures and parameters; with several keys a
    /// column `rank_KEY` for each follows, with a reference a column `KEY_percent_above` for each figure. With a motion among
    /// the rows there are the errors of its body's angle.
    pub fn csv(&self) -> String {
        let several = self.keys.len() > 1;
        let of_motion: &[Column<Candidate>] = if self.has_angles() { &OF_MOTION } else { &[] };
        let differences: Vec<SortKey> =
            SortKey::ALL.into_iter().filter(|key| self.has_angles() || !key.is_of_motions()).collect();
        let head = names(&PLACE).chain(FIGURES).chain(["size", "extent"]).chain(names(of_motion));
        let of_linkage = parameters_of(self.linkages());
        let head = head.chain(names(&of_linkage));
        let mut head: Vec<String> = head.chain(["unit", "recorded_differently"]).map(str::to_owned).collect();
        if several {
            head.extend(self.keys.iter().map(|key| format!("rank_{}", key.name())));
        }
        if self.reference.is_some() {
            head.extend(differences.iter().map(|key| format!("{}_percent_above", key.name())));
        }
        let rows = self.rows.iter().map(|row| {
            let entry = &row.entry;
            let mut line = cells(&PLACE, row);
            line.extend(figures(&entry.candidate, &FIGURES));
            line.extend([SortKey::Size, SortKey::Extent].map(|key| number(row.figure_of(key))));
            line.extend(cells(of_motion, &entry.candidate));
            line.extend(parameters(&of_linkage, &entry.candidate.linkage));
            line.push(entry.unit.map_or(String::new(), |unit| unit.label().to_owned()));
            line.push(cell(&entry.untrue.join("; ")));
            if several {
                line.extend(row.ranks.iter().map(usize::to_string));
            }
            if !row.difference_percent.is_empty() {
                let of = |key: &SortKey| row.difference_percent.get(*key as usize).copied().flatten();
                line.extend(differences.iter().map(of).map(number));
            }
            line
        });
        written(head, rows)
    }

    /// Returns the whole comparison as JSON. Later versions may add keys; none is renamed.
    pub fn json(&self) -> String {
        let json = Json {
            format: JSON_FORMAT,
            tool: Tool::this(),
            sort: self.keys.iter().map(|key| key.name()).collect(),
            unit: self.unit().map(Unit::label),
            same_target: self.same_target(),
            same_unit: self.same_unit(),
            front_of: [SortKey::Rms, SortKey::Transmission, SortKey::Size].map(SortKey::name),
            reference: self.reference_label(),
            rows: self.rows.iter().map(|row| Row::new(row, &self.keys, self.has_angles())).collect(),
            left_out: &self.left_out,
            notes: self.notes(),
        };
        // The keys are strings and no value can fail, so that it can always be written.
        serde_json::to_string_pretty(&json).map(|text| text + "\n").unwrap_or_default()
    }
}
