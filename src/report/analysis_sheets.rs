//! placeholder until the sheets land
use crate::analysis::Analysis;
use crate::linkage::FourBar;
use crate::record::Unit;
/// x
pub fn analysis_svg(_: &Analysis) -> String {
    String::new()
}
/// x
pub fn cognates_svg(_: &str, _: Option<Unit>, _: &FourBar, _: &[FourBar]) -> String {
    String::new()
}
