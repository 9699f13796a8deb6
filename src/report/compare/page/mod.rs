//! A comparison as one self-contained HTML page: curves that can be shown and hidden, the trade-off chart, tables that
//! can be sorted. Without its script it can still be read and printed.

use super::overlay;
use super::overlay::Overlay;
use super::trade_off;
use super::trade_off::trade_off;
use super::{Comparison, Ranked, SortKey, first_few, strokes, tables};
use crate::record::Candidate;
use crate::report::canvas::{Canvas, px};
use crate::report::csv::parameters_of;
use crate::report::html::page::Page;
use crate::report::html::table::Cell;
use crate::report::text::{brief, clean, exact};
use crate::report::words::{defect_names, length_suffix};
use crate::task::TaskKind;
use maud::{Markup, PreEscaped, html};

/// A function that returns the cell of a row, which is given with its place.
type CellOf<'a> = dyn Fn(usize, &Ranked) -> Cell + 'a;

/// A column of a table that can be sorted.
struct Column<'a> {
    head: &'a str,
    /// A longer heading for screen readers.
    said: Option<&'a str>,
    cell: Box<CellOf<'a>>,
}

impl<'a> Column<'a> {
    fn new(head: &'a str, cell: impl Fn(usize, &Ranked) -> Cell + 'a) -> Self {
        Column { head, said: None, cell: Box::new(cell) }
    }

    /// Returns a column with a figure.
    fn figure(head: &'a str, key: SortKey, digits: usize) -> Self {
        Column::new(head, move |_, row| Cell::number(row.figure_of(key), tables::shown(row, key, digits)))
    }

    /// Returns the column with a longer heading for screen readers.
    fn said(self, said: &'a str) -> Self {
        Column { said: Some(said), ..self }
    }
}

impl Comparison {
    /// Returns the page. Labels and names are plain text in it, whatever characters they contain.
    pub fn html(&self) -> String {
        let title = self.title();
        let points = self.rows.first().filter(|_| self.same_target());
        let points = points.map(|row| {
            let count = row.entry.target.len().max(row.entry.pairs.len());
            format!("{count} target {}s; ", row.entry.kind.noun())
        });
        let notes = self.notes();
        let body = html! {
            main {
                header {
                    h1 { (title) }
                    p.sub { (points.unwrap_or_default()) "ranked by " (tables::keys_in_words(self)) }
                }
                @if !notes.is_empty() { ul.notes { @for note in notes { li { (note) } } } }
                @if !self.rows.is_empty() {
                    (self.curves())
                    @if let Some(section) = self.trade() { (section) }
                    (self.figure_section())
                    @if let Some(section) = self.difference_section() { (section) }
                    (self.parameter_section())
                }
                footer { p {
                    "Made by linkwright " (env!("CARGO_PKG_VERSION"))
                    ". Every figure was computed again by its referee."
                } }
            }
        };
        Page {
            title: &title,
            styles: &[include_str!("compare.css")],
            body,
            data: "null",
            modules: &[include_str!("compare.mjs")],
        }
        .render()
    }

    fn curves(&self) -> Markup {
        let overlay = Overlay::new(self);
        let description = format!("The coupler curves over the target. {}", self.description());
        let target = self.same_target().then(|| format!("{}.", self.circles("the target")));
        let caption: Vec<String> = target.into_iter().chain(overlay.remarks(self)).collect();
        html! {
            section id="curves" {
                h2 { "Curves" }
                div.beside {
                    figure {
                        (drawing(overlay::WIDTH, overlay.height, &description, overlay.canvas))
                        figcaption { (caption.join(" ")) }
                    }
                    fieldset.legend {
                        legend { "Curves shown" }
                        @for (i, row) in self.rows[..overlay.drawn].iter().enumerate() { (self.label(i, row)) }
                        p.buttons {
                            button type="button" id="all" { "Show all" } " "
                            button type="button" id="none" { "Hide all" }
                        }
                    }
                }
            }
        }
    }

    /// Returns the box that shows or hides a curve, with its stroke and its name.
    fn label(&self, i: usize, row: &Ranked) -> Markup {
        let line = format!(r#"<path d="M2 5H34" {}/>"#, strokes::stroke(i));
        html! {
            label data-row=(i) {
                input type="checkbox" checked data-row=(i);
                svg.swatch viewBox="0 0 36 10" aria-hidden="true" { (PreEscaped(line)) }
                " " span.name { (row.rank) (star(row)) " " (clean(&row.entry.label)) }
                " " span.sub { (self.legend_figures(row)) }
            }
        }
    }

    fn trade(&self) -> Option<Markup> {
        let canvas = trade_off(self)?;
        let description = "Each linkage by its rms error (across), its worst transmission angle (up) and its size (the \
                           size of the mark); the same figures are in the table below.";
        Some(html! {
            section id="trade" {
                h2 { "Error, transmission angle, size" }
                figure {
                    (drawing(trade_off::WIDTH, trade_off::HEIGHT, description, canvas))
                    figcaption {
                        "Across the rms error, up the worst transmission angle: best is the upper left corner. \
                         Numbers are ranks, larger marks larger linkages; filled and bold: the Pareto front."
                    }
                }
            }
        })
    }

    fn figure_section(&self) -> Markup {
        let unit = length_suffix(self.unit());
        let unit = if unit.is_empty() { unit } else { format!(" Lengths are in{unit}.") };
        let front = self.front_words().map_or(String::new(), |words| format!("★ {words}."));
        let ranks: Vec<String> = match self.keys.as_slice() {
            [_] => Vec::new(),
            several => several.iter().map(|key| format!("rank by {}", key.name())).collect(),
        };
        let kind = if self.has_angles() {
            Some(TaskKind::Motion)
        } else {
            self.rows.first().map(|row| row.entry.kind)
        };
        let at = format!("at which {}", kind.unwrap_or(TaskKind::Path).noun());
        let mut columns = vec![
            Column::new("behind", |_, row| Cell::number(row.behind_percent, tables::behind(row)))
                .said("behind the best, per cent"),
            Column::figure(self.first_head("sum of squares"), self.first_figure(), 4),
            Column::figure("rms", SortKey::Rms, 4),
            Column::figure("max", SortKey::Max, 4),
            Column::new("at", |_, row| Cell::whole(row.entry.candidate.error.max_at)).said(&at),
            Column::figure("to curve", SortKey::ToCurve, 4),
            Column::figure("transm.", SortKey::Transmission, 3).said("worst transmission angle"),
            Column::figure("link ratio", SortKey::LinkRatio, 3),
            Column::figure("size", SortKey::Size, 4),
            Column::figure("extent", SortKey::Extent, 4),
            Column::new("type", |_, row| Cell::words(row.entry.candidate.type_name())),
            Column::new("accepted", |_, row| Cell::words(verdict(&row.entry.candidate))),
        ];
        if self.has_angles() {
            const AFTER: usize = 5;
            let of_angles = [
                Column::figure("angle", SortKey::AngleRms, 3).said("rms error of the body's angle"),
                Column::figure("angle max", SortKey::AngleMax, 3).said("largest error of the body's angle"),
            ];
            columns.splice(AFTER..AFTER, of_angles);
        }
        let rank = |(k, head)| Column::new(head, move |_, row| Cell::whole(row.ranks[k]));
        columns.extend(ranks.iter().map(String::as_str).enumerate().map(rank));
        self.sorted(("figures", "Figures"), "Figures", &columns, &(front + &unit))
    }

    fn difference_section(&self) -> Option<Markup> {
        let reference = self.reference_label()?;
        let mut heads = vec![self.first_head("sum of squares"), "rms", "max"];
        heads.extend(if self.has_angles() { &["angle", "angle max"][..] } else { &["to curve"] });
        heads.extend(["transm.", "link ratio", "size", "extent"]);
        let column = |(head, key): (_, SortKey)| {
            Column::new(head, move |place, row| {
                let percent = row.difference_percent.get(key as usize).copied().flatten();
                let is_reference = self.reference == Some(place);
                let shown = || tables::signed_percent(percent);
                Cell::number(percent, if is_reference { "reference".to_owned() } else { shown() })
            })
        };
        let columns: Vec<Column> = heads.into_iter().zip(self.shown_figures()).map(column).collect();
        let title = format!("Above {}, per cent of it", clean(reference));
        let note = "Where the reference's figure is 0 there is no percentage of it.";
        Some(self.sorted(("differences", "Differences"), &title, &columns, note))
    }

    fn parameter_section(&self) -> Markup {
        let mut columns = vec![Column::new("type", |_, row| Cell::words(row.entry.candidate.type_name()))];
        columns.extend(parameters_of(self.linkages()).into_iter().map(|parameter| {
            Column::new(parameter.0, move |_, row| {
                let (value, shown) =
                    tables::parameter(&parameter, &row.entry.candidate.linkage, |x| brief(x, 6));
                Cell::number(value, shown)
            })
        }));
        let note = "A, B fixed pivots; a crank, b coupler, c follower, d and e from its pins C and D to the coupler \
                    point; t1 and t2 say on which side D and the coupler point lie.";
        self.sorted(("parameters", "Parameters"), "Parameters", &columns, note)
    }

    /// Returns the section of a table, with a note below.
    fn sorted(&self, (id, name): (&str, &str), title: &str, columns: &[Column], note: &str) -> Markup {
        html! {
            section id=(id) {
                h2 { (title) }
                (self.scrolling(name, columns))
                p.sub { (note) }
            }
        }
    }

    /// Returns a table whose first columns are rank and label; each heading is a button that sorts.
    fn scrolling(&self, name: &str, columns: &[Column]) -> Markup {
        let heads = [("#", Some("rank")), ("linkage", None)];
        let heads = heads.into_iter().chain(columns.iter().map(|column| (column.head, column.said)));
        html! {
            div.scroll role="region" tabindex="0" aria-label={ (name) ", scrolls sideways" } {
                table {
                    thead { tr {
                        @for (i, (shown, said)) in heads.enumerate() {
                            th scope="col" aria-sort=[(i == 0).then_some("ascending")] {
                                button type="button" title=[said] aria-label=[said] { (shown) }
                            }
                        }
                    } }
                    tbody {
                        @for (place, row) in self.rows.iter().enumerate() {
                            tr data-row=(place) {
                                td data-value=(row.rank) { (row.rank) (star(row)) }
                                th scope="row" {
                                    (clean(&row.entry.label))
                                    @if !row.entry.untrue.is_empty() {
                                        " " span title="the record is not true" { "⚠" }
                                    }
                                }
                                @for column in columns {
                                    @let Cell { text, value, class } = (column.cell)(place, row);
                                    @let number = class.map(|_| value.map_or(String::new(), exact));
                                    td class=[class.is_none().then_some("word")] data-value=[number] {
                                        (clean(&text))
                                    }
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}

/// Returns whether a candidate is accepted, with its defects or with the requirements that it misses.
fn verdict(candidate: &Candidate) -> String {
    match (candidate.accepted, candidate.defects.is_empty()) {
        (true, true) => return "yes".to_owned(),
        (true, false) => return format!("yes ({})", defect_names(candidate)),
        (false, _) => {}
    }
    let mut unmet: Vec<&str> =
        candidate.requirements.iter().filter(|r| !r.met).map(|r| r.name.as_str()).collect();
    let defects = candidate.defects.iter().map(|d| d.name());
    let others: Vec<&str> = defects.filter(|name| !unmet.contains(name)).collect();
    unmet.extend(others);
    if unmet.is_empty() { "no".to_owned() } else { format!("no: {}", first_few(&unmet)) }
}

fn star(row: &Ranked) -> Markup {
    html! {
        @if row.on_front {
            " " span role="img" aria-label="on the Pareto front" title="on the Pareto front" { "★" }
        }
    }
}

fn drawing(width: f64, height: f64, description: &str, canvas: Canvas) -> Markup {
    html! {
        svg.drawing viewBox={ "0 0 " (px(width)) " " (px(height)) } role="img" aria-label=(description) {
            (PreEscaped(canvas.body))
        }
    }
}
