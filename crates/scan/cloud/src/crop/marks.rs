//! Marks: why a point goes, as a property of a cloud.

use crate::points::Cloud;

/// The property of marked clouds: 0, or the number of the [`Reason`].
pub const MARK: &str = "removed";

/// Why a point goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum Reason {
    /// It is in no shape to keep, or in one to remove.
    Shape = 1,
    /// It is beyond the outer shape.
    Outer,
    /// It is far from its neighbours.
    Outlier,
    /// Its surface lies along the line of sight.
    Grazing,
    Ground,
    /// It is on no surface.
    Scattered,
    /// It belongs to a smaller part.
    SmallerPart,
    /// Another point is as near as `--distinct` says.
    Repeated,
    /// It does not fulfil the condition on its properties.
    Condition,
}

/// The last of them.
pub(crate) const LAST: Reason = Reason::Condition;

/// The marks of a cloud: of a property [`MARK`] of which every value is 0 or the number of a [`Reason`].
pub fn marks(cloud: &Cloud) -> Option<Vec<u8>> {
    let values = cloud.attributes.get(MARK)?.to_f64();
    let reasons = 0..=LAST as u8;
    values.iter().map(|v| reasons.clone().find(|r| f64::from(*r) == *v)).collect()
}
