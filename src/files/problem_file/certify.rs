//! Reads `solve.certify` and the table `[certify]`.

use super::raw::RawCertify;
use crate::files::diagnostic::{Checked, Diagnostic};
use crate::files::toml_text::TomlText;
use crate::task::spec::{CertifySpec, MAX_CERTIFY_S, TaskSpec};

/// Returns how a certificate is worked out, if `asked` (`solve.certify`) is true, and a warning if something is asked
/// for in vain.
pub(super) fn of(
    toml: &TomlText<'_>,
    asked: bool,
    table: Option<RawCertify>,
    path: &TaskSpec,
) -> Checked<(Option<CertifySpec>, Option<Diagnostic>)> {
    let default = CertifySpec::default();
    let is_given = table.is_some();
    let RawCertify { gap, time_limit_s } = table.unwrap_or_default();
    let gap = gap.map_or(default.gap, |n| n.0);
    if !(gap > 0.0 && gap < 1.0) {
        let help = "write the part of the best sum that the proof may leave open, such as 1e-4";
        return toml.refuse("certify.gap", format!("gap = {gap} is not between 0 and 1"), help);
    }
    let time_limit_s = time_limit_s.map_or(default.time_limit_s, |n| n.0);
    if !(time_limit_s > 0.0 && time_limit_s <= MAX_CERTIFY_S) {
        let range = format!("a time limit is above 0 and at most {MAX_CERTIFY_S:e} seconds");
        let message = format!("time_limit_s = {time_limit_s}: {range}");
        return toml.refuse("certify.time_limit_s", message, "write seconds; the default is 300");
    }
    let warning = if asked && path.body.is_some() {
        let help = "remove the key; how often the best answer came back is recorded all the same";
        Some(toml.at("solve.certify", "no certificate is available for poses of a body").with_help(help))
    } else if asked && path.timing.as_ref().is_none_or(|timing| !timing.free.is_empty()) {
        let help = "give the points crank angles (task.path.timing), or remove the key; how often the best answer \
                    came back is recorded all the same";
        Some(toml.at("solve.certify", "no certificate is available for free timing").with_help(help))
    } else if is_given && !asked {
        let help = "write certify = true under [solve], or run `linkwright certify` on the result";
        Some(toml.at("certify", "[certify] is read only where a certificate is asked for").with_help(help))
    } else {
        None
    };
    Ok((asked.then_some(CertifySpec { gap, time_limit_s }), warning))
}
