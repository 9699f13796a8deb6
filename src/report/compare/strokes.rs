//! The strokes of a comparison's curves, which differ in colour and dashes.

/// Okabe and Ito's colours for colour-blind readers, without the colour of targets.
const COLOURS: [&str; 6] = ["#0072b2", "#009e73", "#cc79a7", "#b87a00", "#1f2a36", "#3a9bd0"];
const DASHES: [&str; 4] = ["", "9 4", "2 4", "12 4 2 4"];

/// The largest number of curves that can be distinguished.
pub(super) const MOST: usize = COLOURS.len() * DASHES.len();

/// Returns the colour of the curve of a row.
pub(super) fn colour(row: usize) -> &'static str {
    COLOURS[row % COLOURS.len()]
}

/// Returns the stroke of the curve of a row: colour and dashes differ from row to row.
pub(super) fn stroke(row: usize) -> String {
    let dashes = DASHES[(row + row / COLOURS.len()) % DASHES.len()];
    let dashes = if dashes.is_empty() { String::new() } else { format!(r#" stroke-dasharray="{dashes}""#) };
    format!(
        r#"fill="none" stroke="{}" stroke-width="2.2" stroke-linejoin="round" stroke-linecap="round"{dashes}"#,
        colour(row)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_strokes_are_alike() {
        let mut strokes: Vec<String> = (0..MOST).map(stroke).collect();
        strokes.sort();
        strokes.dedup();
        assert_eq!(strokes.len(), MOST);
        for pair in (0..MOST).collect::<Vec<_>>().windows(2) {
            assert_ne!(colour(pair[0]), colour(pair[1]));
        }
    }
}
