//! An analysis as CSV: one row for each configuration and crank angle; a cell without a number is empty.

use super::csv::written;
use super::text::exact;
use crate::mechanism::FourBar;
use crate::mechanism::analysis::{Analysis, Row};

/// The header row of [`analysis_csv`].
pub const ANALYSIS_COLUMNS: [&str; 29] = [
    "crank_deg",
    "t1",
    "t2",
    "Cx",
    "Cy",
    "Dx",
    "Dy",
    "Px",
    "Py",
    "coupler_deg",
    "follower_deg",
    "transmission_deg",
    "omega3_rad_s",
    "omega4_rad_s",
    "vCx",
    "vCy",
    "vDx",
    "vDy",
    "vPx",
    "vPy",
    "alpha3_rad_s2",
    "alpha4_rad_s2",
    "aCx",
    "aCy",
    "aDx",
    "aDy",
    "aPx",
    "aPy",
    "status",
];

/// Returns every row of every configuration as CSV.
pub fn analysis_csv(analysis: &Analysis) -> String {
    let rows = analysis.configurations.iter().flat_map(|c| c.rows.iter().map(|r| cells(&c.linkage, r)));
    written(&ANALYSIS_COLUMNS, rows)
}

fn cells(linkage: &FourBar, row: &Row) -> Vec<String> {
    let natural = linkage.natural_coordinates();
    let mut cells = vec![
        exact(row.crank_deg),
        format!("{}", natural.assembly.sign()),
        format!("{}", natural.side.sign()),
    ];
    let mut push = |numbers: Option<&[f64]>, count: usize| match numbers {
        Some(numbers) => cells.extend(numbers.iter().map(|n| exact(*n))),
        None => cells.extend(std::iter::repeat_n(String::new(), count)),
    };
    let pose = row.pose.map(|p| {
        let ([cx, cy], [dx, dy], [px, py]) = (p.crank_pin, p.follower_pin, p.coupler_point);
        [cx, cy, dx, dy, px, py, p.coupler_deg, p.follower_deg, p.transmission_deg]
    });
    push(pose.as_ref().map(|p| p.as_slice()), 9);
    let rates = row.rates.map(|r| {
        [
            r.omega3_rad_s,
            r.omega4_rad_s,
            r.vC[0],
            r.vC[1],
            r.vD[0],
            r.vD[1],
            r.vP[0],
            r.vP[1],
            r.alpha3_rad_s2,
            r.alpha4_rad_s2,
            r.aC[0],
            r.aC[1],
            r.aD[0],
            r.aD[1],
            r.aP[0],
            r.aP[1],
        ]
    });
    push(rates.as_ref().map(|r| r.as_slice()), 16);
    cells.push(row.status.word().to_owned());
    cells
}
