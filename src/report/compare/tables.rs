//! A comparison as text tables for a terminal.

use super::{Comparison, Ranked, SortKey};
use crate::mechanism::CrankLinkage;
use crate::report::csv::{Parameter, names, parameters_of};
use crate::report::grid::Align::{Left, Right};
use crate::report::grid::{Colour, Grid, Ink, plain, verdict};
use crate::report::text::{COLUMNS, NO_NUMBER, clean, columns_of, indented, shortened_in_front, significant};

/// The largest width of a label, in columns.
const LABEL: usize = 28;
/// The smallest width of a label, in columns.
const LEAST_LABEL: usize = 6;

/// Returns `+12.3 %`, `0 %`, or `-` without a number.
pub(super) fn signed_percent(percent: Option<f64>) -> String {
    match percent {
        Some(percent) if percent > 0.0 => format!("+{} %", significant(percent, 3)),
        Some(percent) => format!("{} %", significant(percent, 3)),
        None => NO_NUMBER.to_owned(),
    }
}

/// Returns a figure with its unit of angle; `-` if it is missing.
pub(super) fn shown(row: &Ranked, key: SortKey, digits: usize) -> String {
    let degrees = if key == SortKey::Transmission || key.is_of_motions() { "°" } else { "" };
    let figure = row.figure_of(key);
    figure.map_or(NO_NUMBER.to_owned(), |figure| format!("{}{degrees}", significant(figure, digits)))
}

/// Returns the difference from the best: `best`, `12.3 %`, or `-` without a number.
pub(super) fn behind(row: &Ranked) -> String {
    match row.behind_percent {
        Some(0.0) => "best".to_owned(),
        percent => signed_percent(percent).trim_start_matches('+').to_owned(),
    }
}

/// Returns the rank, with a star if the row is on the Pareto front.
pub(super) fn marked_rank(row: &Ranked) -> String {
    format!("{}{}", row.rank, if row.on_front { "*" } else { "" })
}

/// Returns the keys in words: `sum_sq, then transmission`.
pub(super) fn keys_in_words(comparison: &Comparison) -> String {
    comparison.keys.iter().map(|key| key.name()).collect::<Vec<_>>().join(", then ")
}

impl Comparison {
    /// Returns figures, parameters and, with a reference, the differences from it, as tables of text; notes below.
    pub fn table(&self, colour: Colour) -> String {
        if self.rows.is_empty() {
            return "  Nothing to compare.\n".to_owned();
        }
        let mut out = colour.paint(Ink::Strong, &format!("Ranked by {}", keys_in_words(self)));
        out.push_str("\n\n");
        out.push_str(&within(COLUMNS, |label| self.figures(colour, label)));
        out.push('\n');
        if self.keys.len() > 1 {
            out.push_str(&self.ranks(colour));
            out.push('\n');
        }
        out.push_str(&self.parameters(colour));
        if let Some(reference) = self.reference_label() {
            let head =
                format!("\n  Above {}, per cent of it\n", shortened_in_front(&clean(reference), LABEL));
            out.push_str(&head);
            out.push_str(&within(COLUMNS, |label| self.differences(colour, label)));
        }
        let front = self.front_words().map(|words| format!("* {words}"));
        for note in front.into_iter().chain(self.notes()) {
            out.push('\n');
            out.push_str(&indented(&note));
        }
        out
    }

    /// Returns the heading of the first figure, `plain` for the sum of squares.
    pub(super) fn first_head(&self, plain: &'static str) -> &'static str {
        self.minimised().map_or(plain, |(head, _)| head)
    }

    /// Returns the figure of the first column: the objective, or the sum of squares.
    pub(super) fn first_figure(&self) -> SortKey {
        if self.minimised().is_some() { SortKey::Objective } else { SortKey::SumSq }
    }

    /// Returns the figures of the tables, in the order of their columns.
    pub(super) fn shown_figures(&self) -> Vec<SortKey> {
        use SortKey::{AngleMax, AngleRms, Extent, LinkRatio, Max, Rms, Size, ToCurve, Transmission};
        let first = self.first_figure();
        match self.has_angles() {
            false => vec![first, Rms, Max, ToCurve, Transmission, LinkRatio, Size, Extent],
            true => vec![first, Rms, Max, AngleRms, AngleMax, Transmission, LinkRatio, Size, Extent],
        }
    }

    /// Returns the headings of those figures after the first.
    fn heads(&self) -> Vec<&'static str> {
        let head = |key: &SortKey| match key {
            SortKey::ToCurve => "to curve",
            SortKey::Transmission => "transm.",
            SortKey::LinkRatio => "ratio",
            SortKey::AngleRms => "angle",
            SortKey::AngleMax => "max",
            key => key.name(),
        };
        self.shown_figures()[1..].iter().map(head).collect()
    }

    fn figures(&self, colour: Colour, label: usize) -> String {
        let heads = self.heads();
        let mut grid = Grid::new(&[
            (Left, &["#", "linkage"]),
            (Right, &["behind", self.first_head("sum of sq")]),
            (Right, &heads),
            (Left, &["ok"]),
        ]);
        let first = self.first_figure();
        for row in &self.rows {
            let figure = |key| plain(shown(row, key, if key == first { 4 } else { 3 }));
            let accepted = row.entry.candidate.accepted;
            let untrue = if row.entry.untrue.is_empty() { "" } else { "!" };
            let rank = (format!("{}{untrue}", marked_rank(row)), Ink::Strong);
            let mut cells = vec![rank, plain(named(row, label)), plain(behind(row))];
            cells.extend(self.shown_figures().into_iter().map(figure));
            cells.push(verdict(if accepted { "yes" } else { "no" }, accepted));
            grid.row(cells);
        }
        grid.render(colour)
    }

    /// Returns the table of the ranks by each key.
    fn ranks(&self, colour: Colour) -> String {
        let keys: Vec<&str> = self.keys.iter().map(|key| key.name()).collect();
        let mut grid = Grid::new(&[(Left, &["#", "linkage"]), (Right, &keys)]);
        for row in &self.rows {
            let mut cells = vec![(row.rank.to_string(), Ink::Strong), plain(named(row, LABEL))];
            cells.extend(row.ranks.iter().map(|rank| plain(rank.to_string())));
            grid.row(cells);
        }
        grid.render(colour)
    }

    fn differences(&self, colour: Colour, label: usize) -> String {
        let heads = self.heads();
        let mut grid = Grid::new(&[
            (Left, &["#", "linkage"]),
            (Right, &[self.first_head("sum of sq")]),
            (Right, &heads),
        ]);
        for (i, row) in self.rows.iter().enumerate() {
            let mut cells = vec![(row.rank.to_string(), Ink::Strong), plain(named(row, label))];
            cells.extend(self.shown_figures().into_iter().map(|key| {
                let percent = row.difference_percent.get(key as usize).copied().flatten();
                plain(if self.reference == Some(i) { "ref".to_owned() } else { signed_percent(percent) })
            }));
            grid.row(cells);
        }
        grid.render(colour)
    }

    fn parameters(&self, colour: Colour) -> String {
        let of_linkage = parameters_of(self.linkages());
        let heads: Vec<&str> = names(&of_linkage).collect();
        let mut grid = Grid::new(&[(Left, &["#", "type"]), (Right, &heads)]);
        for row in &self.rows {
            let linkage = &row.entry.candidate.linkage;
            let kind = row.entry.candidate.type_name();
            let shown = |column| plain(parameter(column, linkage, |x| significant(x, 4)).1);
            grid.row(
                [(row.rank.to_string(), Ink::Strong), plain(kind)]
                    .into_iter()
                    .chain(of_linkage.iter().map(shown)),
            );
        }
        grid.render(colour)
    }
}

/// Returns a parameter of a linkage with its text; signs are `+1` or `-1`. NaN and no text where the kind has none.
pub(super) fn parameter(
    (name, of): &Parameter,
    linkage: &CrankLinkage,
    length: impl Fn(f64) -> String,
) -> (f64, String) {
    let Some(value) = of(linkage) else { return (f64::NAN, String::new()) };
    (value, if name.starts_with('t') { format!("{value:+}") } else { length(value) })
}

fn named(row: &Ranked, label: usize) -> String {
    shortened_in_front(&clean(&row.entry.label), label)
}

/// Returns the table with the longest labels that fit.
fn within(columns: usize, table: impl Fn(usize) -> String) -> String {
    let wide = |text: &str| text.lines().map(columns_of).max().unwrap_or(0);
    // Colour codes take no columns on a terminal but are counted: they shorten a label by at most a few letters.
    let mut label = LABEL;
    loop {
        let text = table(label);
        if label <= LEAST_LABEL || wide(&text) <= columns {
            return text;
        }
        label -= 1;
    }
}
