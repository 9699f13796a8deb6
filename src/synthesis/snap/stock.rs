//! Stock lengths: the lengths that are available.

/// A stock of lengths.
#[derive(Clone, Debug, PartialEq)]
pub enum Stock {
    /// All multiples of a step.
    Grid(f64),
    /// A list of lengths, ascending, each once.
    List(Vec<f64>),
}

/// The error of an invalid stock of lengths.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StockError {
    /// A step or length that is not positive and finite.
    #[error("{0} is no stock length: a positive number below 1e12 is needed")]
    NotPositive(f64),
    /// The list is empty.
    #[error("there is no length in the list: give at least one")]
    Empty,
    /// Text that is not a number.
    #[error(
        "line {line}: `{text}` is not a number; write one length a line or several separated by commas or spaces, comments after #"
    )]
    NotANumber {
        /// Number of the line, counted from 1.
        line: usize,
        /// The text found.
        text: String,
    },
}

fn checked(value: f64) -> Result<f64, StockError> {
    if value > 0.0 && value < crate::mechanism::MAX_MAGNITUDE {
        Ok(value)
    } else {
        Err(StockError::NotPositive(value))
    }
}

impl Stock {
    /// Creates the stock of all multiples of `step`.
    ///
    /// # Errors
    /// [`StockError`] for a step that is not positive and finite.
    pub fn grid(step: f64) -> Result<Self, StockError> {
        checked(step).map(Stock::Grid)
    }

    /// Creates the stock of these lengths, given in any order.
    ///
    /// # Errors
    /// [`StockError`] for an empty list, or a length that is not positive and finite.
    pub fn list(lengths: &[f64]) -> Result<Self, StockError> {
        let mut list = lengths.iter().map(|l| checked(*l)).collect::<Result<Vec<_>, _>>()?;
        list.sort_by(f64::total_cmp);
        list.dedup();
        if list.is_empty() { Err(StockError::Empty) } else { Ok(Stock::List(list)) }
    }

    /// Parses the lengths in a text: separated by white space, commas or semicolons; text after # is ignored.
    ///
    /// # Errors
    /// As [`Stock::list`], and for text that is not a number.
    pub fn parse(text: &str) -> Result<Self, StockError> {
        let mut lengths = Vec::new();
        for (i, line) in text.trim_start_matches('\u{feff}').lines().enumerate() {
            let content = line.split('#').next().unwrap_or_default();
            for word in content.split(|c: char| c.is_whitespace() || c == ',' || c == ';') {
                if !word.is_empty() {
                    let number = word.parse::<f64>().ok().filter(|n| n.is_finite());
                    lengths.push(
                        number.ok_or_else(|| StockError::NotANumber { line: i + 1, text: word.into() })?,
                    );
                }
            }
        }
        Stock::list(&lengths)
    }

    /// Returns the `count` stock lengths nearest to `value` in [low, high], nearest first (of two equally near the
    /// shorter).
    pub fn near(&self, value: f64, count: usize, low: f64, high: f64) -> Vec<f64> {
        let inside = |l: &f64| *l >= low && *l <= high;
        let mut lengths: Vec<f64> = match self {
            Stock::List(list) => list.iter().copied().filter(inside).collect(),
            Stock::Grid(step) => {
                let wide = count as f64;
                let middle = (value.max(low).min(high) / step).round();
                let first = (middle - wide).max(1.0);
                (0..=2 * count + 1).map(|i| on_grid(*step, first + i as f64)).filter(inside).collect()
            }
        };
        lengths.sort_by(|x, y| (x - value).abs().total_cmp(&(y - value).abs()).then(x.total_cmp(y)));
        lengths.truncate(count);
        lengths
    }

    /// Describes the stock in words: `multiples of 5`, `12 lengths from 5 to 60`.
    pub fn words(&self) -> String {
        match self {
            Stock::Grid(step) => format!("multiples of {step}"),
            Stock::List(list) => match list.len() {
                1 => format!("the one length {}", list[0]),
                n if n <= 6 => list.iter().map(|l| l.to_string()).collect::<Vec<_>>().join(", "),
                n => format!("{n} lengths from {} to {}", list[0], list[n - 1]),
            },
        }
    }
}

/// Returns `count` steps rounded as written in decimal: 3 steps of 0.1 are 0.3.
fn on_grid(step: f64, count: f64) -> f64 {
    let written = format!("{step}");
    let decimals = written.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    format!("{:.decimals$}", step * count).parse().unwrap_or(step * count)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_lengths_come_first_and_keep_to_their_limits() {
        let grid = Stock::grid(0.1).expect("a step");
        assert_eq!(grid.near(0.3, 3, 0.0, 10.0), [0.3, 0.2, 0.4]);
        assert_eq!(grid.near(0.02, 2, 0.0, 10.0), [0.1, 0.2]);
        assert_eq!(grid.near(7.0, 3, 0.0, 0.55), [0.5, 0.4, 0.3]);
        let list = Stock::list(&[40.0, 10.0, 25.0, 25.0]).expect("lengths");
        assert_eq!(list.near(26.0, 2, 0.0, 100.0), [25.0, 40.0]);
        assert_eq!(list.near(26.0, 9, 30.0, 100.0), [40.0]);
    }

    #[test]
    fn a_list_is_read_from_text_and_what_is_no_length_is_named() {
        let text = "12.7, 25.4  # inches\n\n38.1;50.8\n";
        assert_eq!(Stock::parse(text), Ok(Stock::List(vec![12.7, 25.4, 38.1, 50.8])));
        let wrong = StockError::NotANumber { line: 2, text: "x".into() };
        assert_eq!(Stock::parse("1\n2 x"), Err(wrong));
        assert_eq!(Stock::parse("# nothing"), Err(StockError::Empty));
        assert_eq!(Stock::parse("1 -3"), Err(StockError::NotPositive(-3.0)));
        assert_eq!(Stock::grid(0.0), Err(StockError::NotPositive(0.0)));
    }
}
