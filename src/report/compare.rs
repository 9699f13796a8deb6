//! Linkages of several results side by side, ranked by one figure.

use super::csv::{parameters, written};
use super::grid::{Align, Colour, Grid, Ink};
use super::scene::{Bounds, SAMPLES, circuits};
use super::table::COLUMNS;
use super::text::{cell, clean, exact, shortened_in_front, significant, wrapped};
use crate::record::{Candidate, Record, Unit};
use std::cmp::Ordering;
use std::str::FromStr;

/// What a comparison ranks by.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SortKey {
    /// The sum of squared errors, least first.
    #[default]
    SumSq,
    /// The root of the mean square, least first.
    Rms,
    /// The largest error, least first.
    Max,
    /// The rms distance to the whole coupler curve, least first.
    ToCurve,
    /// The worst transmission angle, greatest first.
    Transmission,
    /// Longest over shortest link, least first.
    LinkRatio,
    /// The diagonal of the box that the joints sweep over the circuit, least first.
    Size,
}

impl SortKey {
    /// Every key.
    pub const ALL: [SortKey; 7] = [
        SortKey::SumSq,
        SortKey::Rms,
        SortKey::Max,
        SortKey::ToCurve,
        SortKey::Transmission,
        SortKey::LinkRatio,
        SortKey::Size,
    ];

    /// Its name on the command line: `to_curve`.
    pub fn name(self) -> &'static str {
        match self {
            SortKey::SumSq => "sum_sq",
            SortKey::Rms => "rms",
            SortKey::Max => "max",
            SortKey::ToCurve => "to_curve",
            SortKey::Transmission => "transmission",
            SortKey::LinkRatio => "link_ratio",
            SortKey::Size => "size",
        }
    }

    fn greatest_first(self) -> bool {
        self == SortKey::Transmission
    }
}

/// A key that doesn't exist.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("no figure is called \"{}\": sort by {}", .0, SortKey::ALL.map(SortKey::name).join(", "))]
pub struct UnknownKey(pub String);

impl FromStr for SortKey {
    type Err = UnknownKey;
    fn from_str(name: &str) -> Result<Self, UnknownKey> {
        SortKey::ALL.into_iter().find(|key| key.name() == name).ok_or_else(|| UnknownKey(clean(name)))
    }
}

/// A linkage with its figures on a target, from a record or evaluated on one.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// What to call it.
    pub label: String,
    /// The linkage, its figures and verdicts.
    pub candidate: Candidate,
    /// The target that the errors are to.
    pub target: Vec<[f64; 2]>,
    /// The unit of its lengths.
    pub unit: Option<Unit>,
}

impl Entry {
    /// `record.candidates[index]`, where there is one.
    pub fn from_record(label: &str, record: &Record, index: usize) -> Option<Entry> {
        let target = record.problem.resolved.task.path.points.clone();
        let candidate = record.candidates.get(index)?.clone();
        Some(Entry { label: label.to_owned(), candidate, target, unit: record.problem.unit })
    }

    /// The diagonal of the box that A, B and the moving joints sweep over the circuits used (half a degree
    /// apart); not a number where the links cannot be joined.
    pub fn size(&self) -> f64 {
        let mut bounds = Bounds::default();
        for joints in circuits(&self.candidate, SAMPLES).iter().flatten() {
            for p in [joints.crank_pin, joints.follower_pin, joints.coupler_point] {
                bounds.hold(p);
            }
        }
        if bounds.width() == 0.0 && bounds.height() == 0.0 {
            return f64::NAN;
        }
        bounds.hold(self.candidate.linkage.crank_pivot());
        bounds.hold(self.candidate.linkage.follower_pivot());
        bounds.diagonal()
    }

    fn figure(&self, key: SortKey) -> f64 {
        let error = &self.candidate.error;
        match key {
            SortKey::SumSq => error.sum_sq,
            SortKey::Rms => error.rms,
            SortKey::Max => error.max,
            SortKey::ToCurve => error.to_curve.rms,
            SortKey::Transmission => self.candidate.transmission_deg.worst,
            SortKey::LinkRatio => self.candidate.link_ratio,
            SortKey::Size => self.size(),
        }
    }
}

/// A ranked entry.
#[derive(Clone, Debug, PartialEq)]
pub struct Ranked {
    /// 1 is the best; equal figures share a rank.
    pub rank: usize,
    /// The entry.
    pub entry: Entry,
    /// The figure that it is ranked by; `None` where it isn't finite.
    pub figure: Option<f64>,
    /// How far the figure is from the best, per cent of the best; `None` where the best is 0 and this isn't.
    pub behind_percent: Option<f64>,
    /// [`Entry::size`].
    pub size: f64,
}

/// Entries in the order of one figure.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// What they are ranked by.
    pub key: SortKey,
    /// Best first; those without the figure last, equals in the order given.
    pub rows: Vec<Ranked>,
}

/// Ranks the entries.
pub fn compare(entries: &[Entry], key: SortKey) -> Comparison {
    let mut rows: Vec<Ranked> = entries
        .iter()
        .map(|entry| {
            let size = entry.size();
            let figure = Some(if key == SortKey::Size { size } else { entry.figure(key) });
            let figure = figure.filter(|f| f.is_finite());
            Ranked { rank: 0, entry: entry.clone(), figure, behind_percent: None, size }
        })
        .collect();
    rows.sort_by(|x, y| match (x.figure, y.figure) {
        (Some(x), Some(y)) if key.greatest_first() => y.total_cmp(&x),
        (Some(x), Some(y)) => x.total_cmp(&y),
        (Some(_), None) => Ordering::Less,
        (None, Some(_)) => Ordering::Greater,
        (None, None) => Ordering::Equal,
    });
    let best = rows.first().and_then(|row| row.figure);
    let mut rank = 0;
    let mut previous = None;
    for (i, row) in rows.iter_mut().enumerate() {
        if i == 0 || row.figure != previous {
            rank = i + 1;
        }
        row.rank = rank;
        previous = row.figure;
        row.behind_percent = match (row.figure, best) {
            (Some(figure), Some(best)) if figure == best => Some(0.0),
            (Some(figure), Some(best)) if best != 0.0 => {
                Some(100.0 * (figure - best).abs() / best.abs()).filter(|p| p.is_finite())
            }
            _ => None,
        };
    }
    Comparison { key, rows }
}

/// The head of [`Comparison::csv`].
pub const COLUMN_NAMES: [&str; 26] = [
    "rank",
    "label",
    "accepted",
    "behind_percent",
    "sum_sq",
    "rms",
    "max",
    "max_at",
    "to_curve_rms",
    "type",
    "transmission_worst_deg",
    "transmission_over",
    "link_ratio",
    "size",
    "Ax",
    "Ay",
    "Bx",
    "By",
    "a",
    "b",
    "c",
    "d",
    "e",
    "t1",
    "t2",
    "unit",
];

impl Comparison {
    /// Whether all errors are to the same target.
    pub fn same_target(&self) -> bool {
        self.rows.windows(2).all(|w| w[0].entry.target == w[1].entry.target)
    }

    /// Whether all lengths have the same unit.
    pub fn same_unit(&self) -> bool {
        self.rows.windows(2).all(|w| w[0].entry.unit == w[1].entry.unit)
    }

    /// Figures and parameters as two tables of text.
    pub fn table(&self, colour: Colour) -> String {
        if self.rows.is_empty() {
            return "  Nothing to compare.\n".to_owned();
        }
        let mut out = colour.paint(Ink::Strong, &format!("Ranked by {}", self.key.name()));
        out.push_str("\n\n");
        out.push_str(&self.figures(colour));
        out.push('\n');
        out.push_str(&self.parameters(colour));
        let mut notes = Vec::new();
        if !self.same_target() {
            notes.push("The targets differ: errors to different targets say little beside each other.");
        }
        if !self.same_unit() {
            notes.push("The units differ: lengths are as they stand in each result.");
        }
        for note in notes {
            out.push('\n');
            out.push_str(&wrapped("  ", "  ", note, COLUMNS));
        }
        out
    }

    fn figures(&self, colour: Colour) -> String {
        use Align::{Left, Right};
        let mut grid = Grid::new(&[
            ("#", Right),
            ("linkage", Left),
            ("behind", Right),
            ("sum of sq", Right),
            ("rms", Right),
            ("max", Right),
            ("to curve", Right),
            ("transm.", Right),
            ("ratio", Right),
            ("size", Right),
            ("accepted", Left),
        ]);
        for row in &self.rows {
            let (candidate, plain) = (&row.entry.candidate, |text: String| (text, Ink::Plain));
            let behind = match row.behind_percent {
                Some(0.0) => "best".to_owned(),
                Some(percent) => format!("{} %", significant(percent, 3)),
                None => super::text::NO_NUMBER.to_owned(),
            };
            grid.row(vec![
                (row.rank.to_string(), Ink::Strong),
                plain(shortened_in_front(&clean(&row.entry.label), 14)),
                plain(behind),
                plain(significant(candidate.error.sum_sq, 4)),
                plain(significant(candidate.error.rms, 3)),
                plain(significant(candidate.error.max, 3)),
                plain(significant(candidate.error.to_curve.rms, 3)),
                plain(format!("{}°", significant(candidate.transmission_deg.worst, 3))),
                plain(significant(candidate.link_ratio, 3)),
                plain(significant(row.size, 3)),
                if candidate.accepted { ("yes".into(), Ink::Good) } else { ("no".into(), Ink::Bad) },
            ]);
        }
        grid.render(colour)
    }

    fn parameters(&self, colour: Colour) -> String {
        use Align::{Left, Right};
        let mut grid = Grid::new(&[
            ("#", Right),
            ("type", Left),
            ("Ax", Right),
            ("Ay", Right),
            ("Bx", Right),
            ("By", Right),
            ("a", Right),
            ("b", Right),
            ("c", Right),
            ("d", Right),
            ("e", Right),
            ("t1", Right),
            ("t2", Right),
        ]);
        for row in &self.rows {
            let linkage = &row.entry.candidate.linkage;
            let (a, b) = (linkage.crank_pivot(), linkage.follower_pivot());
            let lengths = [
                linkage.crank(),
                linkage.coupler(),
                linkage.follower(),
                linkage.crank_side(),
                linkage.follower_side(),
            ];
            let mut cells = vec![
                (row.rank.to_string(), Ink::Strong),
                (row.entry.candidate.linkage_type.name().to_owned(), Ink::Plain),
            ];
            let numbers = [a.re, a.im, b.re, b.im].into_iter().chain(lengths);
            cells.extend(numbers.map(|x| (significant(x, 4), Ink::Plain)));
            let signs = [linkage.assembly().sign(), linkage.side().sign()];
            cells.extend(signs.map(|sign| (format!("{sign:+}"), Ink::Plain)));
            grid.row(cells);
        }
        grid.render(colour)
    }

    /// One row an entry, every number to the last digit.
    pub fn csv(&self) -> String {
        written(
            &COLUMN_NAMES,
            self.rows.iter().map(|row| {
                let (entry, candidate) = (&row.entry, &row.entry.candidate);
                let mut cells = vec![
                    row.rank.to_string(),
                    cell(&entry.label),
                    candidate.accepted.to_string(),
                    row.behind_percent.map_or(String::new(), exact),
                    exact(candidate.error.sum_sq),
                    exact(candidate.error.rms),
                    exact(candidate.error.max),
                    candidate.error.max_at.to_string(),
                    exact(candidate.error.to_curve.rms),
                    candidate.linkage_type.name().to_owned(),
                    exact(candidate.transmission_deg.worst),
                    super::words::over(candidate.transmission_deg.over).to_owned(),
                    exact(candidate.link_ratio),
                    exact(row.size),
                ];
                cells.extend(parameters(&entry.candidate.linkage));
                cells.push(entry.unit.map_or(String::new(), |unit| unit.label().to_owned()));
                cells
            }),
        )
    }
}
