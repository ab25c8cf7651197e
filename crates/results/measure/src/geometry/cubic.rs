//! The cubic through two overlaps with two speeds: where it is zero, and where it is highest.

/// An overlap between two frames.
pub(crate) struct Cubic {
    /// When [s].
    pub times: [f64; 2],
    /// Overlaps [m], and what they would grow by at their speed [m].
    pub ends: [f64; 2],
    pub ways: [f64; 2],
}

impl Cubic {
    /// The overlap [m] at a share of the time between the frames.
    fn at(&self, tau: f64) -> f64 {
        let rest = 1.0 - tau;
        self.ends[0] * (1.0 + 2.0 * tau) * rest * rest
            + self.ways[0] * tau * rest * rest
            + self.ends[1] * tau * tau * (3.0 - 2.0 * tau)
            - self.ways[1] * tau * tau * rest
    }

    /// When it passes zero [s], which the ends must lie on both sides of; else the nearer end.
    pub fn zero(&self) -> f64 {
        let positive = self.ends[0] > 0.0;
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            *(if (self.at(middle) > 0.0) == positive { &mut low } else { &mut high }) = middle;
        }
        self.times[0] + high * (self.times[1] - self.times[0])
    }

    /// Its highest value, found by thirds where it rises at the start and falls at the end.
    pub fn highest(&self) -> f64 {
        let ends = self.ends[0].max(self.ends[1]);
        if !(self.ways[0] > 0.0 && self.ways[1] < 0.0) {
            return ends;
        }
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..60 {
            let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
            if self.at(a) < self.at(b) {
                low = a;
            } else {
                high = b;
            }
        }
        self.at(0.5 * (low + high)).max(ends)
    }
}
