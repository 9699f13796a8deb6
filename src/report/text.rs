//! Formatting of numbers and foreign text for a terminal, for XML and for a spreadsheet.

use std::fmt::Write;

/// The text for a number that is not finite.
pub const NO_NUMBER: &str = "-";

/// The decimal exponents that are written without `e`: 0.0001 up to below a million.
const PLAIN_EXPONENTS: std::ops::RangeInclusive<i32> = -4..=5;

/// Returns `value` with `digits` significant digits, such as `0.02240`, `31.42`, `7.416e-7`; 0 is `0`.
///
/// ```
/// use linkwright::internals::report::text::significant;
/// assert_eq!(significant(0.022396524, 4), "0.02240");
/// assert_eq!(significant(9.99996, 4), "10.00");
/// assert_eq!(significant(7.4157e-7, 4), "7.416e-7");
/// assert_eq!(significant(f64::NAN, 4), "-");
/// ```
pub fn significant(value: f64, digits: usize) -> String {
    if !value.is_finite() {
        return NO_NUMBER.to_owned();
    }
    if value == 0.0 {
        return "0".to_owned();
    }
    let digits = digits.max(1);
    let scientific = format!("{:.*e}", digits - 1, value);
    // The exponent after rounding: 9.9999 may have become 1.000e1.
    let (_, exponent) = split(&scientific);
    if !PLAIN_EXPONENTS.contains(&exponent) {
        return scientific;
    }
    let decimals = (digits as i32 - 1 - exponent).max(0) as usize;
    format!("{value:.decimals$}")
}

/// Returns a positive number as [`significant`] does, rounded so that the text is never more than the number.
///
/// ```
/// use linkwright::internals::report::text::{at_least, at_most};
/// assert_eq!((at_most(0.12349, 4), at_least(0.12341, 4)), ("0.1234".into(), "0.1235".into()));
/// assert_eq!((at_most(0.5, 2), at_least(0.5, 2)), ("0.50".into(), "0.50".into()));
/// ```
pub fn at_most(value: f64, digits: usize) -> String {
    on_one_side(value, digits, -1.0, |shown| shown <= value)
}

/// Returns a positive number as [`significant`] does, rounded so that the text is never less than the number.
pub fn at_least(value: f64, digits: usize) -> String {
    on_one_side(value, digits, 1.0, |shown| shown >= value)
}

/// Returns a gap in per cent with two digits, never less than the gap itself.
pub fn percent_up(gap: f64) -> String {
    let percent = 100.0 * gap;
    // The product is rounded, so the text, with the point moved by two places, is compared with the gap itself.
    without_zeros(&on_one_side(percent, 2, 1.0, |shown| {
        let scientific = format!("{shown:e}");
        let (mantissa, exponent) = split(&scientific);
        format!("{mantissa}e{}", exponent - 2).parse().is_ok_and(|shown: f64| shown >= gap)
    }))
}

/// Returns [`significant`] of a number, or one unit of the last digit further (`way`) if that is not right.
fn on_one_side(value: f64, digits: usize, way: f64, is_right: impl Fn(f64) -> bool) -> String {
    let text = significant(value, digits);
    if text.parse().map_or(true, is_right) {
        return text;
    }
    let (_, exponent) = split(&format!("{value:e}"));
    let unit = 10.0_f64.powi(exponent + 1 - digits as i32);
    // The nearest text was at most half a unit on the wrong side.
    significant(value + 0.75 * way * unit, digits)
}

/// Returns mantissa and exponent of a number in the form `1.5e-3`.
fn split(scientific: &str) -> (&str, i32) {
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((scientific, "0"));
    (mantissa, exponent.parse().unwrap_or(0))
}

/// Returns a number as [`significant`] does, without zeros at the end of the decimals: `30`, `0.5`.
pub fn brief(value: f64, digits: usize) -> String {
    without_zeros(&significant(value, digits))
}

fn without_zeros(text: &str) -> String {
    let (mantissa, exponent) = text.split_at(text.find('e').unwrap_or(text.len()));
    let short =
        if mantissa.contains('.') { mantissa.trim_end_matches('0').trim_end_matches('.') } else { mantissa };
    format!("{short}{exponent}")
}

/// Returns the shortest text that reads back as the same number; empty for a number that is not finite.
///
/// ```
/// use linkwright::internals::report::text::exact;
/// assert_eq!((exact(5.0), exact(0.1), exact(1e-300)), ("5".into(), "0.1".into(), "1e-300".into()));
/// ```
pub fn exact(value: f64) -> String {
    let mut text = String::new();
    push_exact(&mut text, value);
    text
}

/// Appends a number as [`exact`] writes it.
pub(super) fn push_exact(text: &mut String, value: f64) {
    let start = text.len();
    // If both write the digits without an exponent, zmij is several times as fast as `fmt`.
    let plain = value == 0.0 || (1e-4..1e15).contains(&value.abs());
    if plain {
        text.push_str(zmij::Buffer::new().format_finite(value));
    } else if value.is_finite() {
        // Writing to a String cannot fail.
        let _ = write!(text, "{value:?}");
    }
    if text[start..].ends_with(".0") {
        text.truncate(text.len() - 2);
    }
}

/// Returns a whole number in groups of three digits: `12,345`.
pub fn grouped(value: u64) -> String {
    let mut text = value.to_string();
    for i in (1..text.len()).rev().skip(2).step_by(3) {
        text.insert(i, ',');
    }
    text
}

/// Returns a number with its noun: `1 cognate`, `2 cognates`.
pub(crate) fn plural(n: usize, noun: &str) -> String {
    format!("{n} {noun}{}", if n == 1 { "" } else { "s" })
}

/// The largest number of characters of foreign text that are shown.
pub const LONGEST_TEXT: usize = 200;
/// The largest number of characters of a sentence that is shown whole.
const LONGEST_SENTENCE: usize = 800;

/// Returns foreign text on one line, without characters that act on a terminal or change the reading direction: control
/// characters become a space or nothing, runs of spaces one space, and the text is cut after [`LONGEST_TEXT`]
/// characters.
///
/// ```
/// assert_eq!(linkwright::internals::report::text::clean("a\x1b[31mb\n c\u{202e}"), "a[31mb c");
/// ```
pub fn clean(text: &str) -> String {
    clean_to(text, LONGEST_TEXT)
}

/// Cleans text as [`clean`] does, for sentences, which may be longer.
pub(super) fn clean_sentence(text: &str) -> String {
    clean_to(text, LONGEST_SENTENCE)
}

fn clean_to(text: &str, longest: usize) -> String {
    let mut clean = String::new();
    // Far more than is shown, but limited: even a name of a gigabyte costs no more than this.
    for c in text.chars().take(16 * longest) {
        if c.is_whitespace() {
            if !clean.ends_with(' ') {
                clean.push(' ');
            }
        } else if !c.is_control() && !is_invisible(c) {
            clean.push(c);
        }
    }
    shortened(clean.trim(), longest)
}

/// Returns whether a character is a mark of reading direction, a joiner, a separator, a tag or a non-character.
fn is_invisible(c: char) -> bool {
    matches!(c,
        '\u{ad}' | '\u{61c}' | '\u{180e}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}'
        | '\u{2060}'..='\u{206f}' | '\u{fdd0}'..='\u{fdef}' | '\u{feff}' | '\u{fff0}'..='\u{fffb}'
        | '\u{e0000}'..='\u{e0fff}')
        || (c as u32) & 0xfffe == 0xfffe
}

/// Returns at most `columns` columns of a text, with an ellipsis if it was cut.
pub fn shortened(text: &str, columns: usize) -> String {
    if columns_of(text) <= columns {
        return text.to_owned();
    }
    let mut short = String::new();
    let mut used = 0;
    for c in text.chars() {
        used += columns_of_char(c);
        if used >= columns {
            break;
        }
        short.push(c);
    }
    short.truncate(short.trim_end().len());
    short.push('…');
    short
}

/// Shortens a text as [`shortened`] does, but at its beginning: the end of a path is the most useful part.
pub fn shortened_in_front(text: &str, columns: usize) -> String {
    let reversed: String = text.chars().rev().collect();
    shortened(&reversed, columns).chars().rev().collect()
}

/// Returns the number of columns of a terminal that a text occupies.
pub fn columns_of(text: &str) -> usize {
    text.chars().map(columns_of_char).sum()
}

/// Returns 0 for combining marks, 2 for the blocks that terminals draw wide, otherwise 1.
fn columns_of_char(c: char) -> usize {
    match c as u32 {
        0x300..=0x36f | 0x1ab0..=0x1aff | 0x20d0..=0x20ff | 0xfe00..=0xfe0f => 0,
        0x1100..=0x115f
        | 0x2e80..=0xa4cf
        | 0xac00..=0xd7a3
        | 0xf900..=0xfaff
        | 0xfe30..=0xfe6f
        | 0xff00..=0xff60
        | 0xffe0..=0xffe6
        | 0x1f300..=0x1faff
        | 0x20000..=0x3fffd => 2,
        _ => 1,
    }
}

/// Returns the approximate width of a text in the usual sans-serif faces.
pub(super) fn text_width(text: &str, font_size: f64) -> f64 {
    0.56 * font_size * columns_of(text) as f64
}

/// Returns the text with a capital first letter.
pub(super) fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}

/// Returns cleaned foreign text as XML character data or attribute value.
///
/// ```
/// assert_eq!(linkwright::internals::report::text::xml("<a b='c'> & \u{0}"), "&lt;a b=&#39;c&#39;&gt; &amp;");
/// ```
pub fn xml(text: &str) -> String {
    let escapes = [('&', "&amp;"), ('<', "&lt;"), ('>', "&gt;"), ('"', "&quot;"), ('\'', "&#39;")];
    escapes.into_iter().fold(clean(text), |text, (mark, escape)| text.replace(mark, escape))
}

/// Returns clean text as Markdown, with its markup characters escaped.
pub(super) fn markdown(text: &str) -> String {
    let escape = |c: char| "|*_`<[\\#".contains(c).then_some('\\');
    text.chars().flat_map(|c| escape(c).into_iter().chain([c])).collect()
}

/// The width of all text output, in columns.
pub const COLUMNS: usize = 100;

/// Returns cleaned foreign text for a CSV cell: a text that a spreadsheet would take for a formula gets an apostrophe.
pub fn cell(text: &str) -> String {
    let clean = clean(text);
    if clean.starts_with(['=', '+', '-', '@']) { format!("'{clean}") } else { clean }
}

/// Returns words in lines of at most [`COLUMNS`] columns, each after two spaces.
pub(super) fn indented(text: &str) -> String {
    wrapped("  ", "  ", text, COLUMNS)
}

/// Returns words in lines of at most `columns` columns, each after `indent`, the first after `lead`.
pub fn wrapped(lead: &str, indent: &str, text: &str, columns: usize) -> String {
    let mut out = String::new();
    let mut line = lead.to_owned();
    let mut empty = true;
    for word in text.split(' ').filter(|w| !w.is_empty()) {
        if !empty && columns_of(&line) + 1 + columns_of(word) > columns {
            out.push_str(&line);
            out.push('\n');
            line = indent.to_owned();
            empty = true;
        }
        if !empty {
            line.push(' ');
        }
        line.push_str(word);
        empty = false;
    }
    out.push_str(line.trim_end());
    out.push('\n');
    out
}

#[cfg(test)]
mod tests {
    use super::{at_least, at_most, exact, percent_up};
    use crate::numbers::arithmetic::streams::{stream, unit};

    #[test]
    fn a_bound_is_never_shown_on_the_other_side_of_itself() {
        for value in
            [9.236430336755e-3, 0.1 + 0.2, 1.0, 999_999.96, 7.4157e-7, 2.0_f64.powi(-30), 123_456.789]
        {
            for digits in 1..12 {
                let (low, high) = (at_most(value, digits), at_least(value, digits));
                let read = |text: &str| text.parse::<f64>().expect("a number");
                assert!(read(&low) <= value && value <= read(&high), "{value}: {low} {high}");
                let unit = 10.0_f64.powi(value.log10().floor() as i32 + 1 - digits as i32);
                assert!(read(&high) - read(&low) < 1.001 * unit, "{value}: {low} {high}");
            }
        }
    }

    #[test]
    fn a_gap_is_never_shown_smaller_than_it_is() {
        for (gap, shown) in [
            (1e-4, "0.01"),
            (9.99e-5, "0.01"),
            (1.01e-4, "0.011"),
            (1.00000009e-4, "0.011"),
            (0.9999, "100"),
            (4.2e-9, "4.2e-7"),
            (0.5, "50"),
            (1.0, "100"),
            (0.0, "0"),
        ] {
            assert_eq!(percent_up(gap), shown, "{gap}");
        }
        for gap in [3.3e-5, 1.234e-3, 0.0987, 0.999] {
            let shown: f64 = percent_up(gap).parse().expect("a number");
            let percent = 100.0 * gap * (1.0 - 1e-15);
            assert!(shown >= percent && shown < 1.101 * percent, "{gap}: {shown}");
        }
    }

    #[test]
    fn exact_numbers_are_written_as_the_language_does() {
        let mut random = stream(3, 0);
        for i in 0..200_000 {
            let exponent =
                if i % 2 == 0 { -6.0 + 24.0 * unit(&mut random) } else { -3.0 + 6.0 * unit(&mut random) };
            let mut value = (unit(&mut random) - 0.5) * 10_f64.powf(exponent);
            if i % 3 == 0 {
                // Few digits, as people write numbers.
                value = format!("{value:.4}").parse().expect("a number");
            }
            let shown = format!("{value:?}");
            let shown = shown.strip_suffix(".0").unwrap_or(&shown);
            // Of two equally short and near texts either may be written; zmij takes the even one, as the record does.
            let same = exact(value) == shown || (exact(value).len() == shown.len() && shown.len() > 15);
            assert!(same, "{value:?}: {}", exact(value));
            assert_eq!(exact(value).parse(), Ok(value));
        }
        for (value, shown) in
            [(0.0, "0"), (-0.0, "-0"), (1e-4, "0.0001"), (9.99e-5, "9.99e-5"), (1e15, "1000000000000000")]
        {
            assert_eq!(exact(value), shown);
        }
        assert_eq!(exact(f64::NAN), "");
    }
}
