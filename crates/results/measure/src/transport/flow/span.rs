//! Grains through a plane, and what passed in a span of time.

/// One grain through the plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlaneCrossing {
    /// When [s].
    pub time: f64,
    /// Whether in the direction of the normal.
    pub forward: bool,
    /// Mass [kg].
    pub mass: f64,
}

/// What passed in a span of time.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Span {
    /// Start [s].
    pub from: f64,
    /// End [s].
    pub to: f64,
    /// Grains along the normal, and against it.
    pub count: [u64; 2],
    /// Mass [kg] along the normal, and against it.
    pub mass: [f64; 2],
}

impl Span {
    pub(super) fn add(&mut self, pass: &PlaneCrossing) {
        let side = usize::from(!pass.forward);
        self.count[side] += 1;
        self.mass[side] += pass.mass;
    }

    /// Net mass flow along the normal [kg/s].
    pub fn mass_flow(&self) -> f64 {
        (self.mass[0] - self.mass[1]) / (self.to - self.from)
    }

    /// Net number flow along the normal [1/s].
    pub fn number_flow(&self) -> f64 {
        (self.count[0] as f64 - self.count[1] as f64) / (self.to - self.from)
    }
}
