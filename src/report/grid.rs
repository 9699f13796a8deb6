//! A table of text with aligned columns, and the colours of a terminal.

use super::text::{clean, columns_of, markdown, shortened};

/// The choice whether text has terminal colours. The words are complete without them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Colour {
    /// Plain text.
    #[default]
    Never,
    /// ANSI colours.
    Always,
}

/// The role of a piece of text, which determines its colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ink {
    Plain,
    Strong,
    Faint,
    Good,
    Bad,
}

impl Colour {
    pub(super) fn paint(self, ink: Ink, text: &str) -> String {
        let code = match ink {
            Ink::Plain => "",
            Ink::Strong => "1",
            Ink::Faint => "2",
            Ink::Good => "32",
            Ink::Bad => "31",
        };
        if self == Colour::Never || code.is_empty() || text.is_empty() {
            text.to_owned()
        } else {
            format!("\x1b[{code}m{text}\x1b[0m")
        }
    }
}

/// The alignment of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Align {
    Left,
    Right,
}

/// A cell: its text and its ink.
pub(super) type Cell = (String, Ink);

/// Returns a cell without a colour.
pub(super) fn plain(text: impl Into<String>) -> Cell {
    (text.into(), Ink::Plain)
}

/// Returns a cell with a verdict.
pub(super) fn verdict(text: impl Into<String>, good: bool) -> Cell {
    (text.into(), if good { Ink::Good } else { Ink::Bad })
}

/// A column of a table: its alignment, its heading, and the cell of a row.
pub(super) type Column<'a, Row> = (Align, &'static str, &'a dyn Fn(&Row) -> Cell);

/// A table: the headings, and rows of cells.
pub(super) struct Grid {
    heads: Vec<(String, Align)>,
    rows: Vec<Vec<Cell>>,
}

impl Grid {
    /// Returns the table of these rows.
    pub(super) fn of<Row>(rows: &[Row], columns: &[Column<'_, Row>]) -> Self {
        let heads = columns.iter().map(|(align, head, _)| ((*head).to_owned(), *align)).collect();
        let cells = |row| columns.iter().map(|(.., cell)| cell(row)).collect();
        Grid { heads, rows: rows.iter().map(cells).collect() }
    }

    /// Returns an empty table with headings, neighbours with one alignment together.
    pub(super) fn new(groups: &[(Align, &[&str])]) -> Self {
        let heads =
            groups.iter().flat_map(|(align, heads)| heads.iter().map(|head| ((*head).to_owned(), *align)));
        Grid { heads: heads.collect(), rows: Vec::new() }
    }

    /// Adds a row. Cells beyond the headings are left out, missing ones are empty.
    pub(super) fn row(&mut self, cells: impl IntoIterator<Item = Cell>) {
        self.rows.push(cells.into_iter().collect());
    }

    /// Returns the table with every cell cut to a number of columns.
    pub(super) fn shortened(mut self, columns: usize) -> Self {
        self.rows.iter_mut().flatten().for_each(|(text, _)| *text = shortened(text, columns));
        self
    }

    /// Returns the table as Markdown.
    pub(super) fn markdown(&self) -> String {
        let line = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
        let rule = |align| if align == Align::Right { "---:" } else { "---" };
        let mut out = line(self.heads.iter().map(|(head, _)| head.clone()).collect());
        out.push_str(&line(self.heads.iter().map(|(_, align)| rule(*align).to_owned()).collect()));
        for row in &self.rows {
            out.push_str(&line(
                row.iter().take(self.heads.len()).map(|(text, _)| markdown(&clean(text))).collect(),
            ));
        }
        out
    }

    /// Returns the lines, each after two spaces, with columns two spaces apart.
    pub(super) fn render(&self, colour: Colour) -> String {
        let widths: Vec<usize> = (0..self.heads.len())
            .map(|i| {
                let cells = self.rows.iter().filter_map(|row| row.get(i)).map(|cell| columns_of(&cell.0));
                cells.fold(columns_of(&self.heads[i].0), usize::max)
            })
            .collect();
        let heads: Vec<Cell> = self.heads.iter().map(|h| (h.0.clone(), Ink::Faint)).collect();
        let mut out = String::new();
        for row in std::iter::once(&heads).chain(&self.rows) {
            let mut line = String::new();
            for (i, (&(_, align), &width)) in self.heads.iter().zip(&widths).enumerate() {
                let (text, ink) = row.get(i).map_or(("", Ink::Plain), |cell| (cell.0.as_str(), cell.1));
                let (free, text) = (" ".repeat(width - columns_of(text)), colour.paint(ink, text));
                line += &match align {
                    Align::Left => format!("  {text}{free}"),
                    Align::Right => format!("  {free}{text}"),
                };
            }
            out.push_str(line.trim_end());
            out.push('\n');
        }
        out
    }
}
