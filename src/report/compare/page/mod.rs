//! A comparison as one self-contained HTML page: curves that can be shown and hidden, the trade-off chart, tables that
//! can be sorted. Without its script it can still be read and printed.

use super::overlay;
use super::overlay::Overlay;
use super::trade_off;
use super::trade_off::trade_off;
use super::{Comparison, Ranked, SortKey, data, strokes, tables};
use crate::report::canvas::px;
use crate::report::html::page::{Page, escaped};
use crate::report::text::{NO_NUMBER, brief, clean, exact, significant};
use crate::report::words::{defect_names, length_suffix};
use std::fmt::Write;

/// The heading of a column: its text, and a longer text for screen readers if there is one.
type Head = (String, Option<&'static str>);

impl Comparison {
    /// Returns the page. Labels and names are plain text in it, whatever characters they contain.
    pub fn html(&self) -> String {
        let title = self.title();
        let mut body = String::from("<main>\n<header>\n");
        let points = match self.rows.first().filter(|_| self.same_target()) {
            Some(row) => format!("{} target points; ", row.entry.target.len()),
            None => String::new(),
        };
        let _ = writeln!(body, "<h1>{}</h1>", text(&title));
        let ranked = tables::keys_in_words(self);
        let _ = writeln!(body, "<p class=\"sub\">{points}ranked by {ranked}</p>\n</header>");
        let notes = self.notes();
        if !notes.is_empty() {
            let items: String = notes.iter().map(|note| format!("<li>{}</li>\n", escaped(note))).collect();
            let _ = writeln!(body, "<ul class=\"notes\">\n{items}</ul>");
        }
        if !self.rows.is_empty() {
            self.curves(&mut body);
            self.trade(&mut body);
            self.tables(&mut body);
        }
        let _ = writeln!(
            body,
            "<footer><p>Made by linkwright {}. Every figure was computed again by its referee.</p></footer>\n</main>",
            env!("CARGO_PKG_VERSION")
        );
        Page {
            title: &title,
            styles: &[include_str!("compare.css")],
            body: &body,
            data: "null",
            modules: &[include_str!("compare.mjs")],
        }
        .render()
    }

    fn curves(&self, body: &mut String) {
        let overlay = Overlay::new(self);
        body.push_str("<section id=\"curves\">\n<h2>Curves</h2>\n<div class=\"beside\">\n<figure>\n");
        drawing(
            body,
            overlay::WIDTH,
            overlay.height,
            &format!("The coupler curves over the target. {}", self.description()),
            &overlay.canvas.body,
        );
        let mut caption = Vec::new();
        if self.same_target() {
            caption.push("Circles: the target, its point 0 filled.".to_owned());
        }
        caption.extend(overlay.remarks(self));
        let _ = writeln!(body, "<figcaption>{}</figcaption>\n</figure>", escaped(&caption.join(" ")));
        body.push_str("<fieldset class=\"legend\">\n<legend>Curves shown</legend>\n");
        for (i, row) in self.rows[..overlay.drawn].iter().enumerate() {
            let _ = writeln!(
                body,
                concat!(
                    r#"<label data-row="{row}"><input type="checkbox" checked data-row="{row}">"#,
                    r#"<svg class="swatch" viewBox="0 0 36 10" aria-hidden="true"><path d="M2 5H34" {stroke}/></svg>"#,
                    r#"<span class="name">{rank}{front} {label}</span> <span class="sub">{figures}</span></label>"#
                ),
                row = i,
                stroke = strokes::stroke(i),
                rank = row.rank,
                front = star(row),
                label = text(&row.entry.label),
                figures = text(&self.legend_figures(row))
            );
        }
        body.push_str(
            "<p class=\"buttons\"><button type=\"button\" id=\"all\">Show all</button> \
             <button type=\"button\" id=\"none\">Hide all</button></p>\n</fieldset>\n</div>\n</section>\n",
        );
    }

    fn trade(&self, body: &mut String) {
        let Some(canvas) = trade_off(self) else { return };
        body.push_str("<section id=\"trade\">\n<h2>Error, transmission angle, size</h2>\n<figure>\n");
        let description = "Each linkage by its rms error (across), its worst transmission angle (up) and its size (the \
                           size of the mark); the same figures are in the table below.";
        drawing(body, trade_off::WIDTH, trade_off::HEIGHT, description, &canvas.body);
        body.push_str(
            "<figcaption>Across the rms error, up the worst transmission angle: best is the upper left corner. Numbers are \
             ranks, larger marks larger linkages; filled and bold: the Pareto front.</figcaption>\n</figure>\n</section>\n",
        );
    }

    fn tables(&self, body: &mut String) {
        let unit =
            length_suffix(self.rows.first().and_then(|row| row.entry.unit).filter(|_| self.same_unit()));
        let front = self.front_words().map(|words| format!("★ {words}."));
        let unit = if unit.is_empty() { String::new() } else { format!(" Lengths are in{unit}.") };
        body.push_str("<section id=\"figures\">\n<h2>Figures</h2>\n");
        table(body, "Figures", &self.figure_heads(), self.rows.iter().map(|row| self.figure_cells(row)));
        let _ =
            writeln!(body, "<p class=\"sub\">{}{unit}</p>\n</section>", escaped(&front.unwrap_or_default()));
        if let Some(reference) = self.reference_label() {
            let _ = writeln!(
                body,
                "<section id=\"differences\">\n<h2>Above {}, per cent of it</h2>",
                text(reference)
            );
            let heads =
                plain_heads(&[self.first_head(), "rms", "max", "to curve", "transm.", "link ratio", "size"]);
            let rows = self.rows.iter().enumerate().map(|(i, row)| {
                let cells = self.shown_figures().map(|key| {
                    let percent = row.difference_percent.get(key as usize).copied().flatten();
                    let shown = match self.reference == Some(i) {
                        true => "reference".to_owned(),
                        false => tables::signed_percent(percent),
                    };
                    Cell { shown, value: percent, word: false }
                });
                (row, i, cells.into())
            });
            table(body, "Differences", &heads, rows);
            body.push_str(
                "<p class=\"sub\">Where the reference's figure is 0 there is no percentage of it.</p>\n</section>\n",
            );
        }
        body.push_str("<section id=\"parameters\">\n<h2>Parameters</h2>\n");
        let heads = plain_heads(&["type", "Ax", "Ay", "Bx", "By", "a", "b", "c", "d", "e", "t1", "t2"]);
        let rows = self.rows.iter().enumerate().map(|(i, row)| {
            let linkage = &row.entry.candidate.linkage;
            let mut cells = vec![Cell::word(row.entry.candidate.linkage_type.name())];
            cells.extend(data::lengths(linkage).map(|x| Cell {
                shown: brief(x, 6),
                value: Some(x),
                word: false,
            }));
            cells.extend([linkage.assembly().sign(), linkage.side().sign()].map(|sign| Cell {
                shown: format!("{sign:+}"),
                value: Some(sign),
                word: false,
            }));
            (row, i, cells)
        });
        table(body, "Parameters", &heads, rows);
        body.push_str(
            "<p class=\"sub\">A, B fixed pivots; a crank, b coupler, c follower, d and e from its pins C and D to the \
             coupler point; t1 and t2 say on which side D and the coupler point lie.</p>\n</section>\n",
        );
    }

    fn first_head(&self) -> &'static str {
        self.minimised().map_or("sum of squares", |(head, _)| head)
    }

    fn figure_heads(&self) -> Vec<Head> {
        let mut heads =
            plain_heads(&["behind", self.first_head(), "rms", "max", "at", "to curve", "transm."]);
        heads.extend(plain_heads(&["link ratio", "size", "type", "accepted"]));
        for (i, words) in
            [(0, "behind the best, per cent"), (4, "at which point"), (6, "worst transmission angle")]
        {
            heads[i].1 = Some(words);
        }
        if self.keys.len() > 1 {
            heads.extend(self.keys.iter().map(|key| (format!("rank by {}", key.name()), None)));
        }
        heads
    }

    fn figure_cells<'a>(&self, row: &'a Ranked) -> (&'a Ranked, usize, Vec<Cell>) {
        let candidate = &row.entry.candidate;
        let number = |key, digits| Cell::number(row.figure_of(key), digits);
        let behind = match row.behind_percent {
            Some(0.0) => "best".to_owned(),
            percent => tables::signed_percent(percent).trim_start_matches('+').to_owned(),
        };
        let angle = row.figure_of(SortKey::Transmission);
        let accepted = match (candidate.accepted, candidate.defects.is_empty()) {
            (true, true) => "yes".to_owned(),
            (true, false) => format!("yes ({})", defect_names(candidate)),
            (false, _) => {
                const NAMED: usize = 3;
                let mut unmet: Vec<&str> =
                    candidate.requirements.iter().filter(|r| !r.met).map(|r| r.name.as_str()).collect();
                unmet.extend(
                    candidate
                        .defects
                        .iter()
                        .map(|d| d.name())
                        .filter(|name| !unmet.contains(name))
                        .collect::<Vec<_>>(),
                );
                match unmet.len() {
                    0 => "no".to_owned(),
                    n if n > NAMED => format!("no: {} and {} more", unmet[..NAMED].join(", "), n - NAMED),
                    _ => format!("no: {}", unmet.join(", ")),
                }
            }
        };
        let mut cells = vec![
            Cell { shown: behind, value: row.behind_percent, word: false },
            number(self.first_figure(), 4),
            number(SortKey::Rms, 4),
            number(SortKey::Max, 4),
            Cell {
                shown: candidate.error.max_at.to_string(),
                value: Some(candidate.error.max_at as f64),
                word: false,
            },
            number(SortKey::ToCurve, 4),
            Cell {
                shown: angle.map_or(NO_NUMBER.to_owned(), |angle| format!("{}°", significant(angle, 3))),
                value: angle,
                word: false,
            },
            number(SortKey::LinkRatio, 3),
            number(SortKey::Size, 4),
            Cell::word(candidate.linkage_type.name()),
            Cell::word(&accepted),
        ];
        if self.keys.len() > 1 {
            let rank =
                |rank: &usize| Cell { shown: rank.to_string(), value: Some(*rank as f64), word: false };
            cells.extend(row.ranks.iter().map(rank));
        }
        let place = self.rows.iter().position(|other| std::ptr::eq(other, row)).unwrap_or(0);
        (row, place, cells)
    }
}

/// A cell of a table.
struct Cell {
    shown: String,
    /// The value by which it is sorted; words by themselves, missing numbers last.
    value: Option<f64>,
    word: bool,
}

impl Cell {
    fn number(value: Option<f64>, digits: usize) -> Cell {
        Cell { shown: significant(value.unwrap_or(f64::NAN), digits), value, word: false }
    }

    fn word(word: &str) -> Cell {
        Cell { shown: word.to_owned(), value: None, word: true }
    }
}

fn plain_heads(heads: &[&str]) -> Vec<Head> {
    heads.iter().map(|head| ((*head).to_owned(), None)).collect()
}

/// Returns foreign text as markup: cleaned, then escaped.
fn text(text: &str) -> String {
    escaped(&clean(text))
}

fn star(row: &Ranked) -> &'static str {
    if row.on_front {
        " <span role=\"img\" aria-label=\"on the Pareto front\" title=\"on the Pareto front\">★</span>"
    } else {
        ""
    }
}

fn drawing(body: &mut String, width: f64, height: f64, description: &str, markup: &str) {
    let _ = writeln!(
        body,
        "<svg class=\"drawing\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">\n{markup}</svg>",
        px(width),
        px(height),
        escaped(description)
    );
}

/// Writes a table whose first columns are rank and label; each heading is a button that sorts.
fn table<'a>(
    body: &mut String,
    name: &str,
    heads: &[Head],
    rows: impl Iterator<Item = (&'a Ranked, usize, Vec<Cell>)>,
) {
    let _ = writeln!(
        body,
        "<div class=\"scroll\" role=\"region\" tabindex=\"0\" aria-label=\"{name}, scrolls sideways\">\n<table>\n<thead><tr>"
    );
    let head = |(shown, said): &Head, sort: &str| {
        let said = said.map_or(String::new(), |said| format!(" title=\"{said}\" aria-label=\"{said}\""));
        let shown = escaped(shown);
        format!("<th scope=\"col\"{sort}><button type=\"button\"{said}>{shown}</button></th>\n")
    };
    body.push_str(&head(&("#".to_owned(), Some("rank")), " aria-sort=\"ascending\""));
    body.push_str(&head(&("linkage".to_owned(), None), ""));
    heads.iter().for_each(|one| body.push_str(&head(one, "")));
    body.push_str("</tr></thead>\n<tbody>\n");
    for (row, place, cells) in rows {
        let untrue = if row.entry.untrue.is_empty() {
            ""
        } else {
            " <span title=\"the record is not true\">⚠</span>"
        };
        let _ = write!(
            body,
            "<tr data-row=\"{place}\"><td data-value=\"{rank}\">{rank}{}</td><th scope=\"row\">{}{untrue}</th>",
            star(row),
            text(&row.entry.label),
            rank = row.rank,
        );
        for cell in cells {
            let value = match cell.value {
                Some(value) => format!(" data-value=\"{}\"", exact(value)),
                None if cell.word => " class=\"word\"".to_owned(),
                None => " data-value=\"\"".to_owned(),
            };
            let _ = write!(body, "<td{value}>{}</td>", text(&cell.shown));
        }
        body.push_str("</tr>\n");
    }
    body.push_str("</tbody>\n</table>\n</div>\n");
}
