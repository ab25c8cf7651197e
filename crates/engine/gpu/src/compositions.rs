//! The compositions of effects that devices have: all that scenes can ask for, each a function.

use core::any::TypeId;

macro_rules! names {
    ($([$first:ident $($part:ident)*] $effects:ty;)*) => {
        /// Their names, which are also those of the functions that compute them.
        pub const NAMES: &[&str] = &[$(concat!("contacts_", stringify!($first) $(, "_", stringify!($part))*)),*];

        /// Number of the composition of this type.
        pub fn number(of: TypeId) -> Option<usize> {
            [$(TypeId::of::<$effects>()),*].iter().position(|known| *known == of)
        }
    };
}
laws::compositions!(names);
