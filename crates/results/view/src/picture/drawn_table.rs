//! One table of what a picture shows.

use crate::Role;
use crate::things::bodies::bodies;
use record::ClumpRecord;
use stream::Table;

#[derive(Debug, Clone)]
pub struct DrawnTable<'a> {
    /// How it is drawn.
    pub role: Role,
    /// For messages.
    pub name: String,
    /// x, y, z, radius, fields.
    pub table: &'a Table,
    /// Names of the kinds that the field `material` counts.
    pub kinds: Vec<String>,
    /// Shapes of clumps.
    pub clumps: Vec<ClumpRecord>,
}

impl DrawnTable<'_> {
    /// The rows of each clump.
    pub(super) fn bodies(&self) -> Vec<Vec<u32>> {
        if self.role == Role::Grains { bodies(self.table) } else { Vec::new() }
    }
}
