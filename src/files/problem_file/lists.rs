//! Reads the lists that stand beside the targets: one value a target, in the problem file or as a column of its points
//! file.

use super::raw::RawTiming;
use super::target::Target;
use crate::files::diagnostic::{Checked, counted};
use crate::files::toml_text::TomlText;
use crate::files::toml_values::{OneOrEach, OnlyTable};
use crate::task::AngleOffset;
use crate::task::spec::TimingSpec;

/// The place of a list: the file, and the targets that it belongs to.
pub(super) struct Lists<'a> {
    pub toml: &'a TomlText<'a>,
    /// The targets: their table and their number.
    pub target: &'a Target,
    /// The points file, as it is named.
    pub file: Option<&'a str>,
}

impl Lists<'_> {
    fn key(&self, key: &str) -> String {
        format!("{}.{key}", self.target.kind.table())
    }

    /// Returns a list that is given in the problem file or as a column of the points file; `what` names one of its values.
    pub fn list<T>(
        &self,
        key: &str,
        what: &str,
        here: Option<Vec<T>>,
        column: Option<Vec<T>>,
    ) -> Checked<Option<Vec<T>>> {
        let n = self.target.points.len();
        let place = self.key(key);
        match (here, column) {
            (Some(_), Some(_)) => {
                let (name, file) = (key.trim_start_matches("timing."), self.file.unwrap_or_default());
                let message = format!("{name} is given here and as a column of {file}");
                self.toml.refuse(&place, message, "remove one of the two")
            }
            (Some(list), _) if list.len() != n => {
                let message =
                    format!("{} and {}", counted(n, self.target.kind.noun()), counted(list.len(), what));
                self.toml.refuse(
                    &place,
                    message,
                    format!("give one {what} for each {}", self.target.kind.noun()),
                )
            }
            (here, column) => Ok(here.or(column)),
        }
    }

    /// Returns tolerances, one a target; none is negative. `what` names one in a list, `of` its measure.
    pub fn tolerances(
        &self,
        key: &str,
        [what, of]: [&str; 2],
        here: Option<&OneOrEach>,
        column: Option<Vec<f64>>,
    ) -> Checked<Option<Vec<f64>>> {
        let n = self.target.points.len();
        let here = here.map(|tolerance| match tolerance {
            OneOrEach::One(tolerance) => vec![*tolerance; n],
            OneOrEach::Each(list) => list.clone(),
        });
        let list = self.list(key, what, here, column)?;
        if let Some((j, t)) = list.iter().flatten().enumerate().find(|(_, t)| **t < 0.0) {
            let message = format!("{key} = {t}: {of} cannot be negative");
            return self.toml.refuse(&self.key(&format!("{key}.{j}")), message, "write 0 or more");
        }
        Ok(list)
    }

    /// Returns the weights, one a target, above zero.
    pub fn weights(&self, here: Option<Vec<f64>>, column: Option<Vec<f64>>) -> Checked<Option<Vec<f64>>> {
        let weight = self.list("weight", "weight", here, column)?;
        if let Some((j, w)) = weight.iter().flatten().enumerate().find(|(_, w)| **w <= 0.0) {
            let message = format!("weight = {w}: a weight is positive");
            let help =
                format!("write a number above 0; leave the {} out to ignore it", self.target.kind.noun());
            return self.toml.refuse(&self.key(&format!("weight.{j}")), message, help);
        }
        Ok(weight)
    }

    /// Returns the prescribed crank angles, one a target.
    pub fn timing(
        &self,
        table: Option<&OnlyTable<RawTiming>>,
        column: Option<Vec<Option<f64>>>,
    ) -> Checked<Option<TimingSpec>> {
        let (here, offset) = match table {
            Some(OnlyTable(timing)) => {
                let angles = timing.crank_deg.as_ref().map(|list| list.iter().map(|angle| angle.0).collect());
                (angles, timing.offset)
            }
            None => (None, AngleOffset::default()),
        };
        let crank_deg = self.list("timing.crank_deg", "crank angle", here, column)?;
        if crank_deg.is_none() && table.is_some() {
            let help = format!(
                "add crank_deg, one angle a {}, or remove [{}.timing] for free timing",
                self.target.kind.noun(),
                self.target.kind.table()
            );
            return self.toml.refuse_key(&self.key("timing"), "the crank angles are missing", help);
        }
        let Some(angles) = crank_deg else { return Ok(None) };
        let given = angles.iter().flatten().count();
        if given < 2 {
            let message =
                format!("{} of {} have a crank angle", given, counted(angles.len(), self.target.kind.noun()));
            let help = "give two of them crank angles at least; without any, leave out the timing";
            return self.toml.refuse_key(&self.key("timing.crank_deg"), message, help);
        }
        Ok(TimingSpec::partly(&angles, offset))
    }
}
