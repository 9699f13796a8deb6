//! Points files: CSV with a header row with `x,y` and optionally `crank_deg`, `weight`, `tolerance`, of poses
//! also `angle_deg` and `tolerance_deg`; of a function's pairs `input_deg,output_deg` and optionally `weight`,
//! `tolerance_deg`, or `input_deg,output` (places of a slider) and optionally `weight`, `tolerance`; `#` comments.

use crate::files::diagnostic::{Checked, Diagnostic, counted, quoted};
use crate::files::input_text;
use crate::files::toml_text::nearest;
use crate::mechanism::MAX_MAGNITUDE;
use std::ops::Range;
use std::path::Path;

pub use crate::task::spec::MAX_POINTS;

/// The columns of a file of points or poses; the first two are needed.
const COLUMNS: Layout = Layout {
    columns: ["x", "y", "crank_deg", "weight", "tolerance", "angle_deg", "tolerance_deg"],
    one: "point",
};
/// The columns of a file of pairs.
const PAIRS: Layout =
    Layout { columns: ["input_deg", "output_deg", "", "weight", "", "", "tolerance_deg"], one: "pair" };
/// The columns of a file of pairs whose outputs are places of a slider.
const PLACES: Layout =
    Layout { columns: ["input_deg", "output", "", "weight", "tolerance", "", ""], one: "pair" };
/// The columns whose cells may be empty.
const ANGLE: usize = 5;
const CRANK: usize = 2;

/// The columns that are read from a file, by their places in [`PointsFile`], and the word for one row.
#[derive(Clone, Copy)]
struct Layout {
    columns: [&'static str; 7],
    one: &'static str,
}

impl Layout {
    /// Returns the names of the columns.
    fn names(&self) -> Vec<&'static str> {
        self.columns.into_iter().filter(|column| !column.is_empty()).collect()
    }
}

/// The points of a CSV file and their other columns.
#[derive(Clone, Debug, PartialEq)]
pub struct PointsFile {
    /// The file as the user named it.
    pub file: String,
    /// The text of the file.
    pub text: String,
    /// The points; of pairs the input and the output, degrees.
    pub points: Vec<[f64; 2]>,
    /// The crank angle at each point, in degrees; `None` where the cell is empty.
    pub crank_deg: Option<Vec<Option<f64>>>,
    /// The weight of each point.
    pub weight: Option<Vec<f64>>,
    /// The largest error accepted at each point.
    pub tolerance: Option<Vec<f64>>,
    /// The angle of a body at each point, in degrees; `None` where the cell is empty.
    pub angle_deg: Option<Vec<Option<f64>>>,
    /// The largest error of that angle accepted at each point, in degrees.
    pub tolerance_deg: Option<Vec<f64>>,
    /// The place of each point's row in the text.
    pub rows: Vec<Range<usize>>,
    /// Whether the outputs of pairs are places of a slider.
    pub of_places: bool,
    /// Warnings about ignored columns.
    pub warnings: Vec<Diagnostic>,
}

/// Returns whether a file has a column of body angles, so that its rows are poses. An unreadable file is left to the
/// diagnostics of [`load`], and a pipe, which can be read only once.
pub fn holds_poses(path: &Path) -> bool {
    has_column(path, COLUMNS.columns[ANGLE])
}

/// Returns whether a file has a column of inputs, so that its rows are pairs of a function.
pub fn holds_pairs(path: &Path) -> bool {
    has_column(path, PAIRS.columns[0])
}

/// Returns whether the header of a file names a column.
fn has_column(path: &Path, name: &str) -> bool {
    let text = if path.is_file() { input_text::read(path).unwrap_or_default() } else { String::new() };
    names_column(&text, name)
}

/// Returns whether the header of a text names a column.
fn names_column(text: &str, name: &str) -> bool {
    let header = Rows::new("", input_text::without_mark(text)).header().ok().flatten();
    header.is_some_and(|header| header.cells.iter().any(|cell| cell.eq_ignore_ascii_case(name)))
}

/// Reads the points of a file.
///
/// # Errors
/// A [`Diagnostic`] that points at the row and cell at fault.
pub fn load(path: &Path) -> Result<PointsFile, Box<Diagnostic>> {
    let text = input_text::read(path)?;
    parse(&path.display().to_string(), &text)
}

/// Reads the points of a text; `file` is shown in diagnostics.
///
/// # Errors
/// A [`Diagnostic`] that points at the row and cell at fault.
pub fn parse(file: &str, text: &str) -> Result<PointsFile, Box<Diagnostic>> {
    parse_as(&COLUMNS, file, text)
}

/// Reads the pairs of a function from a file.
///
/// # Errors
/// A [`Diagnostic`] that points at the row and cell at fault.
pub fn load_pairs(path: &Path) -> Result<PointsFile, Box<Diagnostic>> {
    let text = input_text::read(path)?;
    parse_pairs(&path.display().to_string(), &text)
}

/// Reads the pairs of a function from a text; `file` is shown in diagnostics. The outputs are angles in a column `output_deg`
/// or places of a slider in a column `output`.
///
/// # Errors
/// A [`Diagnostic`] that points at the row and cell at fault.
pub fn parse_pairs(file: &str, text: &str) -> Result<PointsFile, Box<Diagnostic>> {
    let [of_angles, of_places] = [PAIRS, PLACES].map(|layout| names_column(text, layout.columns[1]));
    if of_places && !of_angles {
        return Ok(PointsFile { of_places: true, ..parse_as(&PLACES, file, text)? });
    }
    parse_as(&PAIRS, file, text)
}

fn parse_as(layout: &Layout, file: &str, text: &str) -> Result<PointsFile, Box<Diagnostic>> {
    let [first, second] = [layout.columns[0], layout.columns[1]];
    let text = input_text::without_mark(text);
    let mut table = Rows::new(file, text);
    let Some(header) = table.header()? else {
        let help = format!("write a first line {first},{second} and then one {} a line", layout.one);
        return Err(table.at(None, "the file is empty", help));
    };
    let columns = Columns::of(&table, &header, layout)?;
    let mut values = columns.place.map(|place| place.map(|_| Vec::new()));
    let mut angles = columns.place[ANGLE].map(|_| Vec::new());
    let mut cranks = columns.place[CRANK].map(|_| Vec::new());
    let mut rows = Vec::new();
    while let Some(row) = table.next_row()? {
        // Spreadsheets leave empty cells at the end, and leave out cells of columns that are not read.
        let beyond = row.cells.iter().skip(header.cells.len()).any(|cell| !cell.is_empty());
        let short = columns.place.iter().flatten().any(|place| *place >= row.cells.len());
        if beyond || short {
            return Err(table.ragged(&row, header.cells.len()));
        }
        if rows.len() == MAX_POINTS {
            let help =
                format!("leave out {}s: a few hundred describe all that a four-bar can do", layout.one);
            return Err(table.at(
                row.span,
                format!("there are more than {MAX_POINTS} {}s", layout.one),
                help,
            ));
        }
        for (column, list) in [(ANGLE, &mut angles), (CRANK, &mut cranks)] {
            if let (Some(place), Some(list)) = (columns.place[column], list) {
                let is_empty = row.cells.get(place).is_none_or(String::is_empty);
                let name = layout.columns[column];
                list.push(if is_empty { None } else { Some(table.number(&row, place, name)?) });
            }
        }
        for ((name, place), list) in layout.columns.iter().zip(columns.place).zip(&mut values) {
            let may_be_empty = [ANGLE, CRANK].iter().any(|column| layout.columns[*column] == *name);
            let (Some(place), Some(list)) = (place.filter(|_| !may_be_empty), list) else {
                continue;
            };
            let value = table.number(&row, place, name)?;
            let remedy = match *name {
                "weight" if value <= 0.0 => "a weight is positive; leave the row out to ignore a point",
                "tolerance" | "tolerance_deg" if value < 0.0 => "a tolerance is 0 or more",
                _ => {
                    list.push(value);
                    continue;
                }
            };
            return Err(table.at(row.cell_span(text, place), format!("{name} = {value}"), remedy));
        }
        rows.push(row.span);
    }
    if rows.is_empty() {
        let help = format!("write one {} a line, such as 1.5,2", layout.one);
        return Err(table.at(header.span, format!("there are no {}s under the header", layout.one), help));
    }
    let [x, y, _, weight, tolerance, _, tolerance_deg] = values;
    let points = x.into_iter().flatten().zip(y.into_iter().flatten()).map(|(x, y)| [x, y]).collect();
    let (file, text) = (file.to_owned(), text.to_owned());
    let (angle_deg, crank_deg, warnings) = (angles, cranks, columns.warnings);
    Ok(PointsFile {
        file,
        text,
        points,
        crank_deg,
        weight,
        tolerance,
        angle_deg,
        tolerance_deg,
        of_places: false,
        rows,
        warnings,
    })
}

/// A row: its cells, trimmed, and its place in the text.
struct Row {
    cells: Vec<String>,
    span: Range<usize>,
}

impl Row {
    /// Returns the place of a cell, without the blanks around it.
    fn cell_span(&self, text: &str, index: usize) -> Range<usize> {
        let row = &text[self.span.clone()];
        let (mut start, mut cell, mut in_quotes) = (0, 0, false);
        let mut found = 0..row.len();
        for (i, c) in row.char_indices().chain([(row.len(), ',')]) {
            match c {
                '"' => in_quotes = !in_quotes,
                ',' if !in_quotes || i == row.len() => {
                    if cell == index {
                        found = start..i;
                        break;
                    }
                    (start, cell) = (i + 1, cell + 1);
                }
                _ => {}
            }
        }
        let cell = &row[found.clone()];
        let start = self.span.start + found.start + (cell.len() - cell.trim_start().len());
        start..start + cell.trim().len()
    }
}

/// The rows of a text that are neither blank nor comments.
struct Rows<'a> {
    file: &'a str,
    text: &'a str,
    reader: csv::Reader<&'a [u8]>,
}

impl<'a> Rows<'a> {
    fn new(file: &'a str, text: &'a str) -> Self {
        let reader = csv::ReaderBuilder::new()
            .has_headers(false)
            .flexible(true)
            .trim(csv::Trim::All)
            .comment(Some(b'#'))
            .from_reader(text.as_bytes());
        Rows { file, text, reader }
    }

    /// Returns the first row, after the line `sep=,` that some spreadsheets write above it.
    fn header(&mut self) -> Checked<Option<Row>> {
        let first = self.next_row()?;
        match &first {
            Some(row) if self.text.get(row.span.clone()).is_some_and(|line| line.trim() == "sep=,") => {
                self.next_row()
            }
            _ => Ok(first),
        }
    }

    fn next_row(&mut self) -> Checked<Option<Row>> {
        let mut record = csv::StringRecord::new();
        loop {
            let start = self.reader.position().byte() as usize;
            match self.reader.read_record(&mut record) {
                Ok(true) => {}
                Ok(false) => return Ok(None),
                Err(error) => {
                    return Err(self.at(None, format!("the file is no CSV: {error}"), "check its quotes"));
                }
            }
            let blank = record.iter().all(str::is_empty);
            let comment = record.get(0).is_some_and(|cell| cell.starts_with('#'));
            if !blank && !comment {
                let end = self.reader.position().byte() as usize;
                let span = row_span(self.text, start, end);
                let cells = record.iter().map(|cell| unquoted(cell).to_owned()).collect();
                return Ok(Some(Row { cells, span }));
            }
        }
    }

    /// Returns a diagnostic about a place, or about the whole file.
    fn at(
        &self,
        span: impl Into<Option<Range<usize>>>,
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> Box<Diagnostic> {
        Box::new(Diagnostic::new(self.file, self.text, message).at(span).with_help(help))
    }

    fn ragged(&self, row: &Row, expected: usize) -> Box<Diagnostic> {
        let found = row.cells.len();
        let help = if row.cells.iter().any(|c| c.contains(';')) {
            "separate cells with commas, not with semicolons"
        } else if self.text[row.span.clone()].matches('"').count() % 2 == 1 {
            "a quote is opened and not closed; numbers need no quotes"
        } else if found == 2 * expected {
            "if these are decimal commas, write a decimal point: 1.5"
        } else {
            "give each row a cell for each column"
        };
        let cells = counted(found, "cell");
        self.at(row.span.clone(), format!("this row has {cells}, the header has {expected}"), help)
    }

    /// Returns the finite number in a cell.
    fn number(&self, row: &Row, index: usize, column: &str) -> Checked<f64> {
        let cell = row.cells.get(index).map_or("", String::as_str);
        let refuse =
            |message: String, help: &str| Err(self.at(row.cell_span(self.text, index), message, help));
        match cell.parse::<f64>() {
            Ok(value) if value.abs() <= MAX_MAGNITUDE => Ok(value),
            Ok(value) if value.is_finite() => refuse(
                format!("{column} = {} is too large: numbers go up to {MAX_MAGNITUDE:e}", quoted(cell)),
                crate::files::toml_text::too_large_help(column),
            ),
            Ok(_) => refuse(
                format!("{column} = {} is not a finite number", quoted(cell)),
                "leave the row out or give its value",
            ),
            Err(_) if cell.is_empty() => {
                refuse(format!("the cell of {column} is empty"), "give its value or leave the row out")
            }
            Err(_) if is_decimal_comma(cell) => refuse(
                format!("{column} = {} has a decimal comma", quoted(cell)),
                "write a decimal point: 1.5",
            ),
            Err(_) => refuse(
                format!("{column} = {} is not a number", quoted(cell)),
                "write a number such as 1.5 or 2e-3",
            ),
        }
    }
}

/// Returns the place of the row itself: without the comments and blank lines before it and the line's end after it.
fn row_span(text: &str, start: usize, end: usize) -> Range<usize> {
    let end = end.min(text.len());
    let mut start = start.min(end);
    loop {
        let rest = &text[start..end];
        let line = rest.split_inclusive('\n').next().unwrap_or("");
        if line.is_empty() || !(line.trim().is_empty() || line.starts_with('#')) {
            let blank = rest.len() - rest.trim_start().len();
            return start + blank..start + rest.trim_end().len().max(blank);
        }
        start += line.len();
    }
}

/// Returns a cell without the quotes that were kept because of blanks before them: `1, "2"`.
fn unquoted(cell: &str) -> &str {
    let inner = cell.strip_prefix('"').and_then(|cell| cell.strip_suffix('"'));
    inner.filter(|inner| !inner.contains('"')).map_or(cell, str::trim)
}

fn is_decimal_comma(cell: &str) -> bool {
    cell.matches(',').count() == 1 && cell.replace(',', ".").parse::<f64>().is_ok()
}

/// The places of the columns in a row.
struct Columns {
    place: [Option<usize>; 7],
    warnings: Vec<Diagnostic>,
}

impl Columns {
    fn of(table: &Rows<'_>, header: &Row, layout: &Layout) -> Checked<Columns> {
        let refuse = |message: &str, help: &str| Err(table.at(header.span.clone(), message, help));
        if let [only] = header.cells.as_slice()
            && let Some((_, name)) =
                [(';', "semicolons"), ('\t', "tabs")].iter().find(|(c, _)| only.contains(*c))
        {
            let help = "separate them with commas and write numbers with a decimal point; \
                        in a spreadsheet, save as \"CSV (comma delimited)\"";
            return refuse(&format!("the columns are separated by {name}"), help);
        }
        if header.cells.iter().all(|c| c.is_empty() || c.parse::<f64>().is_ok() || is_decimal_comma(c)) {
            let help = format!("write a first line {},{}", layout.columns[0], layout.columns[1]);
            return refuse("the header is missing: the first row holds numbers", &help);
        }
        let mut columns = Columns { place: [None; 7], warnings: Vec::new() };
        let mut extra = Vec::new();
        for (i, cell) in header.cells.iter().enumerate() {
            let name = cell.to_lowercase();
            match layout.columns.iter().position(|c| *c == name && !c.is_empty()) {
                Some(c) if columns.place[c].is_some() => {
                    let message = format!("there are two columns {name}");
                    let help = "remove or rename one of them";
                    return Err(table.at(header.cell_span(table.text, i), message, help));
                }
                Some(c) => columns.place[c] = Some(i),
                None if cell.is_empty() => {}
                None => extra.push(i),
            }
        }
        columns.warnings.extend(extra_columns(table, header, &extra, layout));
        if let Some(c) = columns.place[..2].iter().position(Option::is_none) {
            let [first, second] = [layout.columns[0], layout.columns[1]];
            let help = format!(
                "name the columns in the first row: {} ({first} and {second} are needed)",
                layout.names().join(", ")
            );
            return refuse(&format!("there is no column {}", layout.columns[c]), &help);
        }
        Ok(columns)
    }
}

/// Returns one warning for all columns that are not read; it points at the first.
fn extra_columns(table: &Rows<'_>, header: &Row, extra: &[usize], layout: &Layout) -> Option<Diagnostic> {
    /// The largest number of columns that the warning names, to keep it short.
    const NAMED: usize = 6;
    let first = *extra.first()?;
    let named: Vec<String> = extra.iter().take(NAMED).map(|&i| quoted(&header.cells[i])).collect();
    let more = if extra.len() > NAMED { format!(" and {} more", extra.len() - NAMED) } else { String::new() };
    let message = match extra.len() {
        1 => format!("the column {} is not used", named[0]),
        _ => format!("the columns {}{more} are not used", named.join(", ")),
    };
    let hint = nearest(&header.cells[first], &layout.names())
        .map_or(String::new(), |n| format!("did you mean {n}? "));
    let help = format!("{hint}columns that are read: {}", layout.names().join(", "));
    let span = header.cell_span(table.text, first);
    Some(Diagnostic::new(table.file, table.text, message).at(span).with_help(help))
}
