//! Serialisation of floating-point numbers in JSON, exact to the last bit and including infinities and NaN.
//!
//! A finite number is a JSON number, written as the shortest text that reads back as the same double; the others
//! are the texts `"inf"`, `"-inf"` and `"nan"`.

use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// A floating-point number, possibly infinite or NaN, that is serialised exactly.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Exact(#[serde(with = "self")] pub f64);

#[derive(Deserialize)]
#[serde(untagged)]
enum Written {
    Number(f64),
    Word(String),
}

/// Writes a number; for `#[serde(with = ..)]`.
///
/// # Errors
/// Those of the serializer.
pub fn serialize<S: Serializer>(number: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    match number {
        n if n.is_finite() => serializer.serialize_f64(*n),
        n if n.is_nan() => serializer.serialize_str("nan"),
        n if *n > 0.0 => serializer.serialize_str("inf"),
        _ => serializer.serialize_str("-inf"),
    }
}

/// Reads a number; for `#[serde(with = ..)]`.
///
/// # Errors
/// If the value is neither a number nor one of the three words.
pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    match Written::deserialize(deserializer)? {
        Written::Number(number) => Ok(number),
        Written::Word(word) => match word.as_str() {
            "inf" => Ok(f64::INFINITY),
            "-inf" => Ok(f64::NEG_INFINITY),
            "nan" => Ok(f64::NAN),
            _ => Err(D::Error::custom(format!("{word:?} is not a number"))),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn every_double_comes_back(bits in any::<u64>()) {
            let number = f64::from_bits(bits);
            let text = serde_json::to_string(&Exact(number)).expect("it is written");
            let Exact(back) = serde_json::from_str(&text).expect("it is read");
            prop_assert!(back.to_bits() == bits || (back.is_nan() && number.is_nan()));
        }
    }

    #[test]
    fn what_json_has_no_number_for_is_a_word() {
        let words = [f64::INFINITY, f64::NEG_INFINITY, f64::NAN, -0.0].map(Exact);
        assert_eq!(serde_json::to_string(&words).expect("text"), r#"["inf","-inf","nan",-0.0]"#);
        assert!(serde_json::from_str::<Exact>("\"1e5\"").is_err());
        assert!(serde_json::from_str::<Exact>("null").is_err());
    }
}
