//! An analysis as CSV: one row for each configuration and crank angle; a cell without a number is empty. With loads there are more
//! columns, and a comment above the header.

use super::csv::{Column, names, written};
use super::loads;
use super::text::exact;
use crate::mechanism::FourBar;
use crate::mechanism::analysis::{Analysis, Pose, Rates, Row};

/// The columns of a position: the moving joints, then the angles of coupler, follower and transmission.
pub(super) const POSE: [Column<Pose, f64>; 9] = [
    ("Cx", |p| p.crank_pin[0]),
    ("Cy", |p| p.crank_pin[1]),
    ("Dx", |p| p.follower_pin[0]),
    ("Dy", |p| p.follower_pin[1]),
    ("Px", |p| p.coupler_point[0]),
    ("Py", |p| p.coupler_point[1]),
    ("coupler_deg", |p| p.coupler_deg),
    ("follower_deg", |p| p.follower_deg),
    ("transmission_deg", |p| p.transmission_deg),
];

/// The columns of velocities and of accelerations, eight each: those of the links, then those of the joints.
pub(super) const RATES: [[Column<Rates, f64>; 8]; 2] = [
    [
        ("omega3_rad_s", |r| r.omega3_rad_s),
        ("omega4_rad_s", |r| r.omega4_rad_s),
        ("vCx", |r| r.vC[0]),
        ("vCy", |r| r.vC[1]),
        ("vDx", |r| r.vD[0]),
        ("vDy", |r| r.vD[1]),
        ("vPx", |r| r.vP[0]),
        ("vPy", |r| r.vP[1]),
    ],
    [
        ("alpha3_rad_s2", |r| r.alpha3_rad_s2),
        ("alpha4_rad_s2", |r| r.alpha4_rad_s2),
        ("aCx", |r| r.aC[0]),
        ("aCy", |r| r.aC[1]),
        ("aDx", |r| r.aD[0]),
        ("aDy", |r| r.aD[1]),
        ("aPx", |r| r.aP[0]),
        ("aPy", |r| r.aP[1]),
    ],
];

/// Returns every row of every configuration as CSV.
pub fn analysis_csv(analysis: &Analysis) -> String {
    let head = ["crank_deg", "t1", "t2"].into_iter().chain(names(&POSE));
    let head = head.chain(RATES.iter().flat_map(|rates| names(rates))).map(str::to_owned);
    let of_loads = analysis.loads.iter().flat_map(loads::columns);
    let head = head.chain(of_loads).chain(["status".to_owned()]);
    let comment = analysis.loads.as_ref().map_or_else(String::new, loads::comment);
    let rows =
        analysis.configurations.iter().flat_map(|c| c.rows.iter().map(|r| cells(analysis, &c.linkage, r)));
    comment + &written(head, rows)
}

fn cells(analysis: &Analysis, linkage: &FourBar, row: &Row) -> Vec<String> {
    let signs = [linkage.assembly().sign(), linkage.side().sign()];
    let mut cells = vec![exact(row.crank_deg)];
    cells.extend(signs.map(|sign| sign.to_string()));
    let pose = POSE.iter().map(|(_, of)| row.pose.as_ref().map(of));
    let rates = RATES.iter().flatten().map(|(_, of)| row.rates.as_ref().map(of));
    cells.extend(pose.chain(rates).map(|number| number.map_or(String::new(), exact)));
    cells.extend(analysis.loads.iter().flat_map(|record| loads::cells(record, row.loads.as_deref())));
    cells.push(row.status.word().to_owned());
    cells
}
