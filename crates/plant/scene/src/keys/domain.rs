//! The extent of a scene, and how it is strained.

use super::table::{table, words};

/// Fastest rate of strain [1/s].
const FASTEST: f64 = 1e6;

table! {
    /// `[domain]`
    #[derive(Default)]
    Domain section {
        /// Periodic axes.
        periodic: Vec<Axis> = absent("none"), "", Any, "[\"x\", \"y\"]";
        /// Lowest corner.
        low: Option<[f64; 3]> = absent("required if periodic"), "m", Finite, "[0, 0, 0]";
        /// Highest corner.
        high: Option<[f64; 3]> = absent("required if periodic"), "m", Finite, "[0.1, 0.1, 0.1]";
        /// A run; its last domain is used, instead of `low` and `high`.
        source: Option<String> = absent("–"), "", File, "\"prepare.mcap\"";
        /// What each periodic axis follows: see below.
        strain: Strains = absent("–"), "", Any, "";
        /// Particles that have fallen past all walls: keep them, or take them out by an outlet one diameter below the lowest place that any wall
        /// reaches until the end. With "keep" the run counts them at its end.
        outside: Outside = absent("\"keep\""), "", Any, "\"remove\"";
    }
}

words! {
    /// `domain.outside`
    #[derive(Default)]
    Outside {
        /// They fall on.
        #[default]
        Keep "keep",
        /// An outlet below the walls takes them out.
        Remove "remove",
    }
}

table! {
    /// `domain.strain`: what each axis follows.
    #[derive(Default)]
    Strains inline {
        /// Along x.
        x: Option<Strain> = absent("–"), "", Any, "";
        /// Along y.
        y: Option<Strain> = absent("–"), "", Any, "";
        /// Along z.
        z: Option<Strain> = absent("–"), "", Any, "";
    }
}

impl Strains {
    /// Of all axes, with their names.
    pub fn axes(&self) -> [(&'static str, Option<&Strain>); 3] {
        [("x", self.x.as_ref()), ("y", self.y.as_ref()), ("z", self.z.as_ref())]
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.axes().iter().all(|(_, strain)| strain.is_none())
    }
}

table! {
    /// What an axis of the domain follows; compression is positive.
    Strain section {
        /// Rate of logarithmic strain; this, `stress` or `path`.
        rate: Option<f64> = absent("–"), "1/s", Within(-FASTEST, FASTEST), "0.05";
        /// Mean stress of contacts and bonds along the axis.
        stress: Option<f64> = absent("–"), "Pa", Finite, "\"100 kPa\"";
        /// Strain or stress over time: see below.
        path: Option<StrainPath> = absent("–"), "", Any, "";
        /// Largest rate of strain with which a stress is followed.
        rate_limit: Option<f64> = absent("required with a stress"), "1/s", Within(1e-12, FASTEST), "1";
    }
}

table! {
    /// A table of strain or stress over time.
    StrainPath inline {
        /// A CSV file with the columns `t` [s], and `strain` or `stress` [Pa].
        source: String = required, "", File, "\"stress.csv\"";
    }
}

words! {
    /// An axis of space.
    #[allow(missing_docs)]
    Axis {
        X "x",
        Y "y",
        Z "z",
    }
}
