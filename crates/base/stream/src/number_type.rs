//! Types of numbers that a column can have.

use crate::Values;

/// Type of a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum NumberType {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

/// Runs `$body` with `$T` as the Rust type and `$V` as the variant of `Values` that `$kind` names.
macro_rules! of_kind {
    ($kind:expr, $T:ident, $V:ident => $body:expr) => {{
        macro_rules! arm {
            ($t:ty, $v:ident) => {{
                type $T = $t;
                #[allow(unused_imports)]
                use $crate::Values::$v as $V;
                $body
            }};
        }
        match $kind {
            $crate::number_type::NumberType::I8 => arm!(i8, I8),
            $crate::number_type::NumberType::U8 => arm!(u8, U8),
            $crate::number_type::NumberType::I16 => arm!(i16, I16),
            $crate::number_type::NumberType::U16 => arm!(u16, U16),
            $crate::number_type::NumberType::I32 => arm!(i32, I32),
            $crate::number_type::NumberType::U32 => arm!(u32, U32),
            $crate::number_type::NumberType::F32 => arm!(f32, F32),
            $crate::number_type::NumberType::F64 => arm!(f64, F64),
        }
    }};
}
pub(crate) use of_kind;

impl NumberType {
    /// The kind that a PLY header's word names, in the old or the new spelling.
    pub fn named(word: &str) -> Option<NumberType> {
        Some(match word {
            "char" | "int8" => NumberType::I8,
            "uchar" | "uint8" => NumberType::U8,
            "short" | "int16" => NumberType::I16,
            "ushort" | "uint16" => NumberType::U16,
            "int" | "int32" => NumberType::I32,
            "uint" | "uint32" => NumberType::U32,
            "float" | "float32" => NumberType::F32,
            "double" | "float64" => NumberType::F64,
            _ => return None,
        })
    }

    /// The word for a PLY header. The old spelling is understood by every reader.
    pub fn word(self) -> &'static str {
        ["char", "uchar", "short", "ushort", "int", "uint", "float", "double"][self as usize]
    }

    /// Bytes of one number.
    pub fn size(self) -> usize {
        [1, 1, 2, 2, 4, 4, 4, 8][self as usize]
    }

    /// Whether it holds whole numbers only.
    pub fn is_integer(self) -> bool {
        !matches!(self, NumberType::F32 | NumberType::F64)
    }

    /// An empty column of this kind.
    pub fn empty(self) -> Values {
        of_kind!(self, T, V => V(Vec::<T>::new()))
    }
}

impl Values {
    /// The type of the column.
    pub fn kind(&self) -> NumberType {
        match self {
            Values::I8(_) => NumberType::I8,
            Values::U8(_) => NumberType::U8,
            Values::I16(_) => NumberType::I16,
            Values::U16(_) => NumberType::U16,
            Values::I32(_) => NumberType::I32,
            Values::U32(_) => NumberType::U32,
            Values::F32(_) => NumberType::F32,
            Values::F64(_) => NumberType::F64,
        }
    }
}
