//! The space between the walls of a specimen, or of its periodic domain.

/// Size of a specimen in each row.
pub struct Room {
    /// Lengths along x, y and z [m].
    pub lengths: [Vec<f64>; 3],
    /// Its volume [m³].
    pub volume: Vec<f64>,
}

impl Room {
    /// A box of these lengths.
    pub(crate) fn of_box(lengths: [Vec<f64>; 3]) -> Room {
        let rows = 0..lengths[0].len();
        let volume = rows.map(|i| lengths.iter().map(|l| l[i]).product()).collect();
        Room { lengths, volume }
    }
}
