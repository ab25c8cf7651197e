//! What veils a sample: a colour, and how much of what is behind it hides.

/// The colour times the share, and the share that is hidden.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Veil {
    colour: [f32; 3],
    share: f32,
}

impl Veil {
    /// Lays a colour on it that hides so much of what is behind.
    pub fn lay(&mut self, colour: [f32; 3], hides: f32) {
        self.colour = std::array::from_fn(|k| self.colour[k] + hides * (colour[k] - self.colour[k]));
        self.share += hides * (1.0 - self.share);
    }

    /// A colour as seen through it.
    pub fn over(self, under: [f32; 3]) -> [f32; 3] {
        std::array::from_fn(|k| under[k] * (1.0 - self.share) + self.colour[k])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_hides_all_is_seen_alone_and_half_a_veil_is_half_seen() {
        let mut veil = Veil::default();
        assert_eq!(veil.over([0.2, 0.4, 0.6]), [0.2, 0.4, 0.6]);
        veil.lay([1.0, 0.0, 0.0], 0.5);
        assert_eq!(veil.over([0.0, 1.0, 0.0]), [0.5, 0.5, 0.0]);
        veil.lay([0.0, 0.0, 1.0], 1.0);
        assert_eq!(veil.over([0.5, 0.5, 0.5]), [0.0, 0.0, 1.0]);
    }
}
