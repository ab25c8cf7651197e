//! Laws of contacts and bonds for the pairs of materials, the contacts of an earlier run, and the time step that they allow.

pub(in crate::plan) mod accuracy;
pub(in crate::plan) mod bonds;
pub(in crate::plan) mod contacts;
pub(in crate::plan) mod earlier_contacts;
pub(in crate::plan) mod wall_contacts;
