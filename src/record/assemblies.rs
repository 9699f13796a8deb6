//! The assembly at each target point: t1, and of a six-bar or an eight-bar the signs of all of its dyads.

use crate::mechanism::{AssemblyMode, CrankLinkage};
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::borrow::Cow;
use std::ops::Deref;

/// The assembly at each target point. It is a list of t1; the signs of the further dyads of a six-bar are the same at all points,
/// since its crank turns fully, and are written beside each t1: `[[1, -1], [1, -1]]`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Assemblies {
    first: Vec<AssemblyMode>,
    further: Vec<AssemblyMode>,
}

impl Assemblies {
    /// Returns the assemblies of a linkage with t1 at each point.
    pub fn of(linkage: &CrankLinkage, first: Vec<AssemblyMode>) -> Self {
        let further = linkage.multi_loop().map_or(Vec::new(), |linkage| linkage.signs()[1..].to_vec());
        Assemblies { first, further }
    }

    /// Returns t1 at each point.
    pub fn as_slice(&self) -> &[AssemblyMode] {
        &self.first
    }
}

impl From<Vec<AssemblyMode>> for Assemblies {
    fn from(first: Vec<AssemblyMode>) -> Self {
        Assemblies { first, further: Vec::new() }
    }
}

impl Deref for Assemblies {
    type Target = [AssemblyMode];

    fn deref(&self) -> &[AssemblyMode] {
        &self.first
    }
}

impl<'a> IntoIterator for &'a Assemblies {
    type Item = &'a AssemblyMode;
    type IntoIter = std::slice::Iter<'a, AssemblyMode>;

    fn into_iter(self) -> Self::IntoIter {
        self.first.iter()
    }
}

/// The signs at one point.
#[derive(Serialize, Deserialize)]
#[serde(untagged)]
enum Signs {
    One(AssemblyMode),
    Several(Vec<AssemblyMode>),
}

impl Serialize for Assemblies {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let signs = |first: &AssemblyMode| match self.further.is_empty() {
            true => Signs::One(*first),
            false => Signs::Several(std::iter::once(first).chain(&self.further).copied().collect()),
        };
        self.first.iter().map(signs).collect::<Vec<Signs>>().serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Assemblies {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let mut read = Assemblies::default();
        for (i, signs) in Vec::<Signs>::deserialize(deserializer)?.into_iter().enumerate() {
            let all = match signs {
                Signs::One(first) => vec![first],
                Signs::Several(all) => all,
            };
            let Some((first, further)) = all.split_first() else {
                return Err(D::Error::custom(format!("t1_at[{i}] has no sign")));
            };
            if i > 0 && read.further != further {
                let message = format!("t1_at[{i}]: the signs after the first are the same at every point");
                return Err(D::Error::custom(message));
            }
            read.further = further.to_vec();
            read.first.push(*first);
        }
        Ok(read)
    }
}

impl schemars::JsonSchema for Assemblies {
    fn schema_name() -> Cow<'static, str> {
        "Assemblies".into()
    }

    fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
        let sign = generator.subschema_for::<AssemblyMode>();
        schemars::json_schema!({
            "type": "array",
            "items": {"anyOf": [sign, {"type": "array", "items": sign, "minItems": 1}]}
        })
    }
}
