//! Whole numbers: keys that count, and whole numbers where a key takes any.
//!
//! A number that is whole is one however it is written: 100, 1e2 and 100.0 are the same.

use super::value::{KeyUnit, KeyValue};
use serde::de::{Deserializer, Error, Unexpected, Visitor};
use std::fmt;
use std::marker::PhantomData;

/// Methods of a visitor that takes whole numbers of any size as numbers.
macro_rules! whole_as_number {
    ($value:ty) => {
        fn visit_i64<E: serde::de::Error>(self, value: i64) -> Result<$value, E> {
            self.visit_f64(value as f64)
        }

        fn visit_u64<E: serde::de::Error>(self, value: u64) -> Result<$value, E> {
            self.visit_f64(value as f64)
        }

        fn visit_i128<E: serde::de::Error>(self, value: i128) -> Result<$value, E> {
            self.visit_f64(value as f64)
        }

        fn visit_u128<E: serde::de::Error>(self, value: u128) -> Result<$value, E> {
            self.visit_f64(value as f64)
        }
    };
}

pub(super) use whole_as_number;

/// A type of whole numbers from 0.
trait Whole: TryFrom<u64> + TryFrom<i128> {
    /// The largest.
    const MOST: u64;
}

/// Reads a whole number.
struct WholeVisitor<T>(PhantomData<T>);

impl<T: Whole> WholeVisitor<T> {
    /// The error for a number, as it was written.
    fn refused<V, E: Error>(&self, number: &str) -> Result<V, E> {
        Err(E::invalid_value(Unexpected::Other(&format!("number `{number}`")), self))
    }
}

impl<T: Whole> Visitor<'_> for WholeVisitor<T> {
    type Value = T;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "a whole number from 0 to {}", T::MOST)
    }

    fn visit_i128<E: Error>(self, value: i128) -> Result<T, E> {
        T::try_from(value).or_else(|_| self.refused(&value.to_string()))
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<T, E> {
        self.visit_i128(value.into())
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<T, E> {
        self.visit_i128(value.into())
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<T, E> {
        // 2⁶⁴ is the first number that is too large; u64::MAX as a number is 2⁶⁴.
        let whole = value.fract() == 0.0 && (0.0..u64::MAX as f64).contains(&value);
        let number = if whole { T::try_from(value as u64).ok() } else { None };
        number.map_or_else(|| self.refused(&geom::Shown(value).to_string()), Ok)
    }
}

macro_rules! whole_numbers {
    ($($type:ty)*) => { $(
        impl Whole for $type {
            const MOST: u64 = <$type>::MAX as u64;
        }

        impl KeyValue for $type {
            fn kind() -> String {
                "integer".to_owned()
            }

            fn read<'de, D: Deserializer<'de>>(_: KeyUnit, from: D) -> Result<$type, D::Error> {
                from.deserialize_any(WholeVisitor(PhantomData))
            }

            fn numbers(&self) -> Vec<f64> {
                vec![*self as f64]
            }
        }
    )* };
}

whole_numbers! { u32 u64 }
