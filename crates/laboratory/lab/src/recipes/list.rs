//! The list of tests: a line each.

use super::Recipe;
use super::{crush, direct_shear, drum, heap, oedometer, repose, triaxial, triaxial_periodic, uniaxial};

/// All tests.
pub const ALL: [&dyn Recipe; 9] = [
    &direct_shear::DirectShear,
    &uniaxial::Uniaxial,
    &triaxial::Triaxial,
    &triaxial_periodic::TriaxialPeriodic,
    &oedometer::Oedometer,
    &repose::Repose,
    &heap::Heap,
    &drum::Drum,
    &crush::Crush,
];

/// The test of a name.
pub fn find(name: &str) -> Option<&'static dyn Recipe> {
    ALL.into_iter().find(|recipe| recipe.name() == name)
}
