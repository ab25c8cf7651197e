//! Types of numbers that a column can have.

use crate::Values;

/// Type of a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Kind {
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
            $crate::kind::Kind::I8 => arm!(i8, I8),
            $crate::kind::Kind::U8 => arm!(u8, U8),
            $crate::kind::Kind::I16 => arm!(i16, I16),
            $crate::kind::Kind::U16 => arm!(u16, U16),
            $crate::kind::Kind::I32 => arm!(i32, I32),
            $crate::kind::Kind::U32 => arm!(u32, U32),
            $crate::kind::Kind::F32 => arm!(f32, F32),
            $crate::kind::Kind::F64 => arm!(f64, F64),
        }
    }};
}
pub(crate) use of_kind;

impl Kind {
    /// The kind that a PLY header's word names, in the old or the new spelling.
    pub fn named(word: &str) -> Option<Kind> {
        Some(match word {
            "char" | "int8" => Kind::I8,
            "uchar" | "uint8" => Kind::U8,
            "short" | "int16" => Kind::I16,
            "ushort" | "uint16" => Kind::U16,
            "int" | "int32" => Kind::I32,
            "uint" | "uint32" => Kind::U32,
            "float" | "float32" => Kind::F32,
            "double" | "float64" => Kind::F64,
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
        !matches!(self, Kind::F32 | Kind::F64)
    }

    /// An empty column of this kind.
    pub fn empty(self) -> Values {
        of_kind!(self, T, V => V(Vec::<T>::new()))
    }
}

impl Values {
    /// The type of the column.
    pub fn kind(&self) -> Kind {
        match self {
            Values::I8(_) => Kind::I8,
            Values::U8(_) => Kind::U8,
            Values::I16(_) => Kind::I16,
            Values::U16(_) => Kind::U16,
            Values::I32(_) => Kind::I32,
            Values::U32(_) => Kind::U32,
            Values::F32(_) => Kind::F32,
            Values::F64(_) => Kind::F64,
        }
    }
}
