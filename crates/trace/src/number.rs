//! Numbers in JSON, which cannot express infinity: `"inf"`, `"-inf"` and `"NaN"` are written as strings.
//!
//! For fields as `#[serde(with = "crate::number")]`: a number, or numbers in tuples, arrays, lists and options.
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Writes `value`.
///
/// # Errors
/// Those of the serializer.
pub(crate) fn serialize<T: InJson, S: Serializer>(value: &T, serializer: S) -> Result<S::Ok, S::Error> {
    value.to_json().serialize(serializer)
}

/// Reads what [`serialize`] wrote.
///
/// # Errors
/// Those of the deserializer.
pub(crate) fn deserialize<'de, T: InJson, D: Deserializer<'de>>(deserializer: D) -> Result<T, D::Error> {
    T::Json::deserialize(deserializer).map(T::from_json)
}

/// Values with a form that JSON can hold.
pub(crate) trait InJson {
    /// The form.
    type Json: Serialize + for<'de> Deserialize<'de>;
    fn to_json(&self) -> Self::Json;
    fn from_json(json: Self::Json) -> Self;
}

/// A number in JSON.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
#[serde(untagged)]
pub(crate) enum Number {
    Finite(f64),
    Other(NotFinite),
}

#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub(crate) enum NotFinite {
    #[serde(rename = "inf")]
    Infinity,
    #[serde(rename = "-inf")]
    NegativeInfinity,
    NaN,
}

impl InJson for f64 {
    type Json = Number;

    fn to_json(&self) -> Number {
        match *self {
            Self::INFINITY => Number::Other(NotFinite::Infinity),
            Self::NEG_INFINITY => Number::Other(NotFinite::NegativeInfinity),
            value if value.is_nan() => Number::Other(NotFinite::NaN),
            value => Number::Finite(value),
        }
    }

    fn from_json(number: Number) -> Self {
        match number {
            Number::Finite(value) => value,
            Number::Other(NotFinite::Infinity) => Self::INFINITY,
            Number::Other(NotFinite::NegativeInfinity) => Self::NEG_INFINITY,
            Number::Other(NotFinite::NaN) => Self::NAN,
        }
    }
}

impl InJson for String {
    type Json = Self;

    fn to_json(&self) -> Self {
        self.clone()
    }

    fn from_json(text: Self) -> Self {
        text
    }
}

impl<T: InJson> InJson for Option<T> {
    type Json = Option<T::Json>;

    fn to_json(&self) -> Self::Json {
        self.as_ref().map(T::to_json)
    }

    fn from_json(json: Self::Json) -> Self {
        json.map(T::from_json)
    }
}

impl<T: InJson> InJson for [T; 4] {
    type Json = [T::Json; 4];

    fn to_json(&self) -> Self::Json {
        self.each_ref().map(T::to_json)
    }

    fn from_json(json: Self::Json) -> Self {
        json.map(T::from_json)
    }
}

impl<A: InJson, B: InJson> InJson for (A, B) {
    type Json = (A::Json, B::Json);

    fn to_json(&self) -> Self::Json {
        (self.0.to_json(), self.1.to_json())
    }

    fn from_json((a, b): Self::Json) -> Self {
        (A::from_json(a), B::from_json(b))
    }
}

impl<T: InJson> InJson for Vec<T> {
    type Json = Vec<T::Json>;

    fn to_json(&self) -> Self::Json {
        self.iter().map(T::to_json).collect()
    }

    fn from_json(json: Self::Json) -> Self {
        json.into_iter().map(T::from_json).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn through_json(value: f64) -> f64 {
        let text = serde_json::to_string(&value.to_json()).unwrap();
        f64::from_json(serde_json::from_str(&text).unwrap())
    }

    #[test]
    fn special_numbers_survive_json() {
        for value in [f64::INFINITY, f64::NEG_INFINITY, 0.0, -0.0, f64::MIN_POSITIVE, 5e-324, f64::MAX] {
            assert_eq!(through_json(value).to_bits(), value.to_bits(), "{value}");
        }
        assert!(through_json(f64::NAN).is_nan());
    }

    proptest! {
        #[test]
        fn every_finite_number_survives_json_bit_for_bit(bits in any::<u64>()) {
            let value = f64::from_bits(bits);
            prop_assume!(!value.is_nan());
            prop_assert_eq!(through_json(value).to_bits(), bits);
        }
    }
}
