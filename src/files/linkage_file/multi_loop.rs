//! The `[chain]` form in which six-bars and eight-bars are written.

use super::text_of;
use crate::mechanism::multi_loop::keys::{ChainKeys, DyadKeys, PointKeys, StageKeys};
use crate::mechanism::{MultiLoop, Unit};

/// Returns the text of the linkage file of a six-bar or an eight-bar; every number reads back to the same digits.
pub fn multi_loop_to_toml(name: &str, unit: Option<Unit>, linkage: &MultiLoop) -> String {
    let ChainKeys { trace, pivots, crank, .. } = linkage.keys();
    let mut table = format!("[chain]\ntrace = \"{trace}\"\n\n[chain.pivots]\n");
    for (name, [x, y]) in &pivots {
        table.push_str(&format!("{name} = [{x:?}, {y:?}]\n"));
    }
    table.push_str(&format!(
        "\n[chain.crank]\npivot = \"{}\"\njoint = \"{}\"\nlength = {:?}\n",
        crank.pivot, crank.joint, crank.length
    ));
    for stage in linkage.stages() {
        table.push_str(&match stage {
            StageKeys::Dyad(DyadKeys { joint, from: [x, y], lengths: [l1, l2], side }) => format!(
                "\n[[chain.dyad]]\njoint = \"{joint}\"\nfrom = [\"{x}\", \"{y}\"]\nlengths = [{l1:?}, {l2:?}]\nside = {}\n",
                i64::from(side)
            ),
            StageKeys::Point(PointKeys { name, on: [p, q], at: [x, y] }) => format!(
                "\n[[chain.point]]\nname = \"{name}\"\non = [\"{p}\", \"{q}\"]\nat = [{x:?}, {y:?}]\n"
            ),
        });
    }
    let kind = linkage.linkage_kind().with_article().replacen('a', "A", 1);
    let letters = "# A, B and further ones on the ground: fixed pivots. A-C is the crank; each dyad is two links that meet in a\n\
                   # new joint, to the left of the line between its ends where side = 1. P, the traced point, lies on a link.\n";
    text_of(&format!("{kind} ({})", linkage.chain_kind().name()), letters, name, unit, &table)
}
