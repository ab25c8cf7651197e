//! `[[fill]]` and `[[insert]]`: entries that make grains, and the keys that both have.

use super::{Diameter, Lattice, ShareOf, geometry, unit};
use serde::Deserialize;

/// What an entry says about the grains that it makes.
#[derive(Debug, Clone, Copy)]
pub struct GrainKeys<'a> {
    /// Material; empty where there is a clump, or where sizes name theirs.
    pub material: &'a str,
    /// Name of a `[[clump]]`: clumps instead of spheres.
    pub clump: Option<&'a str>,
    /// Sizes of clumps over that of their shape [–].
    pub scale: Option<Diameter>,
    /// Diameters [m].
    pub diameter: Diameter,
    /// Sizes with shares instead of `diameter`.
    pub sizes: Option<&'a toml::Value>,
    /// What the shares of `sizes` are of.
    pub by: Option<ShareOf>,
}

impl GrainKeys<'_> {
    /// Names of the materials of spheres, and the file of their sizes.
    pub fn names(&self) -> (Vec<String>, Option<String>) {
        let rows = self.sizes.and_then(toml::Value::as_array).into_iter().flatten();
        let named = rows.filter_map(|row| Some(row.as_array()?.get(2)?.as_str()?.to_owned()));
        let own = (!self.material.is_empty()).then(|| self.material.to_owned());
        let file = self.sizes.and_then(|value| value.as_str().or_else(|| value.get("file")?.as_str()));
        (own.into_iter().chain(named).collect(), file.map(str::to_owned))
    }
}

/// A table that makes grains: the keys that all such tables have, and its own. Serde cannot refuse unknown keys of a struct within a struct.
macro_rules! makes_grains {
    ($(#[$about:meta])* $name:ident { $($own:tt)* }) => {
        $(#[$about])*
        #[derive(Debug, Clone, PartialEq, Deserialize)]
        #[serde(deny_unknown_fields)]
        pub struct $name {
            /// Material, unless there is a `clump`.
            #[serde(default)]
            pub material: String,
            /// Name of a `[[clump]]`: clumps instead of spheres.
            pub clump: Option<String>,
            /// Sizes of clumps over that of their shape, uniform in the range [–].
            #[serde(default, deserialize_with = "unit::plain")]
            pub scale: Option<Diameter>,
            /// Diameters, uniform in the range [m], unless there is a `clump`.
            #[serde(default, deserialize_with = "unit::metres")]
            pub diameter: Diameter,
            /// Sizes with shares instead of `diameter`: see [`crate::plan`].
            pub sizes: Option<toml::Value>,
            /// What the shares of `sizes` are of.
            #[serde(default)]
            pub by: Option<ShareOf>,
            /// Seed of the random numbers.
            #[serde(default)]
            pub seed: u64,
            $($own)*
        }

        impl $name {
            /// What it says about its grains.
            pub fn grains(&self) -> GrainKeys<'_> {
                let $name { material, clump, scale, diameter, sizes, by, .. } = self;
                GrainKeys {
                    material,
                    clump: clump.as_deref(),
                    scale: *scale,
                    diameter: *diameter,
                    sizes: sizes.as_ref(),
                    by: *by,
                }
            }
        }
    };
}

makes_grains! {
    /// `[[fill]]`
    Fill {
        /// Where; spheres lie wholly inside.
        #[serde(deserialize_with = "geometry::shape")]
        pub shape: String,
        /// Mass [kg]; this or `count`.
        #[serde(default, deserialize_with = "unit::kilograms")]
        pub mass: Option<f64>,
        /// Number; this or `mass`.
        pub count: Option<u64>,
        /// Velocity at t = 0 [m/s].
        #[serde(default, deserialize_with = "unit::metres_a_second")]
        pub velocity: [f64; 3],
        /// Cluster of all its spheres; absent: none.
        pub cluster: Option<u32>,
        /// Spheres on a lattice, as many as fit, instead of `count` or `mass` at random.
        pub lattice: Option<Lattice>,
    }
}

makes_grains! {
    /// `[[insert]]`
    Insert {
        /// Cross-section, thicker along the velocity than the largest diameter.
        #[serde(deserialize_with = "geometry::shape")]
        pub shape: String,
        /// Velocity [m/s]; particles keep it until they leave the shape.
        #[serde(deserialize_with = "unit::metres_a_second")]
        pub velocity: [f64; 3],
        /// Rate [kg/s]; this or `rate_count`.
        #[serde(default, deserialize_with = "unit::kilograms_a_second")]
        pub rate: Option<f64>,
        /// Rate [1/s]; this or `rate`.
        #[serde(default, deserialize_with = "unit::a_second")]
        pub rate_count: Option<f64>,
        /// When it opens [s].
        #[serde(default, deserialize_with = "unit::seconds")]
        pub from: f64,
        /// When it closes [s]; absent: never.
        #[serde(default, deserialize_with = "unit::seconds")]
        pub until: Option<f64>,
        /// Mass after which it closes [kg]; absent: none.
        #[serde(default, deserialize_with = "unit::kilograms")]
        pub mass: Option<f64>,
        /// Number after which it closes; absent: none.
        pub count: Option<u64>,
        /// Time after which it opens again [s]: `mass` and `count` are those of each time; absent: never.
        #[serde(default, deserialize_with = "unit::seconds")]
        pub repeat: Option<f64>,
        /// How often it opens in all; absent: without end.
        pub times: Option<u64>,
    }
}

impl Fill {
    /// The key that says how much: `count` or `mass`.
    pub(crate) fn amount(&self) -> &'static str {
        if self.count.is_some() { "count" } else { "mass" }
    }
}

impl Insert {
    /// When it closes for the first time [s]: what repeats is open for a period at most.
    pub fn ends(&self) -> Option<f64> {
        self.until.or(self.repeat.map(|period| self.from + period))
    }
}
