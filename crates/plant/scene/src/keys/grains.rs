//! `[[fill]]` and `[[insert]]`: entries that make grains, and the keys that both have.

use super::table::table;
use super::{Lattice, OneOrRange, ShapeText, ShareOf};
use dem::setup::WhenBlocked;

/// What an entry says about the grains that it makes.
#[derive(Debug, Clone, Copy)]
pub struct GrainKeys<'a> {
    /// Material; none where there is a clump, or where sizes name theirs.
    pub material: Option<&'a str>,
    /// Name of a `[[clump]]`: clumps instead of spheres.
    pub clump: Option<&'a str>,
    /// Sizes of clumps over that of their shape [–].
    pub scale: Option<OneOrRange>,
    /// Diameters [m].
    pub diameter: Option<OneOrRange>,
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
        let own = self.material.map(str::to_owned);
        let file = self.sizes.and_then(|value| value.as_str().or_else(|| value.get("file")?.as_str()));
        (own.into_iter().chain(named).collect(), file.map(str::to_owned))
    }
}

/// A table that makes grains: the keys that all such tables have, and its own.
macro_rules! makes_grains {
    ($(#[$about:meta])* $name:ident { $($own:tt)* }) => {
        table! {
            $(#[$about])*
            $name section {
                /// Material of the grains.
                material: Option<String> = absent("required without `clump`, unless each of `sizes` names one"), "", Any, "\"glass\"";
                /// Diameter, or a range [smallest, largest]; uniform in the range.
                diameter: Option<OneOrRange> = absent("this or `sizes`, without `clump`"), "m", Pair, "[\"4 mm\", \"6 mm\"]";
                /// Sizes with shares, see [sizes](#sizes).
                sizes: Option<toml::Value> = absent("this or `diameter`"), "m", Any, "[[0.004, 1], [0.006, 2]]";
                /// What the shares of `sizes` are of.
                by: Option<ShareOf> = absent("\"mass\""), "", Any, "\"number\"";
                /// Clumps of this name instead of spheres.
                clump: Option<String> = absent("–"), "", Any, "\"stone\"";
                /// With `clump`: factor on its size, or a range [smallest, largest].
                scale: Option<OneOrRange> = absent("1"), "", Pair, "[0.8, 1.2]";
                /// Seed of the random numbers; entries with one seed still differ.
                seed: u64 = absent("0"), "", Any, "7";
                $($own)*
            }
        }

        impl $name {
            /// What it says about its grains.
            pub fn grains(&self) -> GrainKeys<'_> {
                let $name { material, clump, scale, diameter, sizes, by, .. } = self;
                GrainKeys {
                    material: material.as_deref().filter(|name| !name.is_empty()),
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
        /// Where: `box:…`, `sphere:…`, `cylinder:…`, `cone:…` or `mesh:FILE` (closed; also `mesh:FILE,units=mm,transform=MATRIX.txt`); spheres lie
        /// wholly inside.
        shape: ShapeText = required, "m", Any, "\"box:0,0,0,0.1,0.1,0.1\"";
        /// Mass to place; this, `count` or `lattice`.
        mass: Option<f64> = absent("–"), "kg", Positive, "2";
        /// Number to place.
        count: Option<u64> = absent("–"), "", AtLeast(1.0), "500";
        /// Equal spheres that touch, on all sites of this lattice that hold a whole sphere.
        lattice: Option<Lattice> = absent("–"), "", Any, "\"hexagonal\"";
        /// [Cluster](#clusters) of all its spheres.
        cluster: Option<u32> = absent("0"), "", Any, "1";
        /// Velocity at t = 0.
        velocity: [f64; 3] = absent("0"), "m/s", Finite, "[0, 0, -1]";
    }
}

makes_grains! {
    /// `[[insert]]`
    Insert {
        /// Where grains are inserted: `box:…`, `sphere:…`, `cylinder:…`, `cone:…` or `mesh:FILE` (closed), as for `[[fill]]`; thicker along `velocity` than the largest diameter.
        shape: ShapeText = required, "m", Any, "\"box:0,0,0.2,0.1,0.1,0.22\"";
        /// Velocity of the grains inside the shape.
        velocity: [f64; 3] = required, "m/s", Finite, "[0, 0, -1]";
        /// Mass rate; this or `rate_count`.
        rate: Option<f64> = absent("–"), "kg/s", Positive, "\"1.5 t/h\"";
        /// Number rate; this or `rate`.
        rate_count: Option<f64> = absent("–"), "1/s", Positive, "100";
        /// Start of the insertion.
        from: f64 = absent("0"), "s", Within(0.0, record::LATEST), "0.1";
        /// End of the insertion.
        until: Option<f64> = absent("never"), "s", Any, "1";
        /// The insertion ends when it has inserted this mass; this or `count`.
        mass: Option<f64> = absent("no limit"), "kg", Positive, "2";
        /// The insertion ends when it has inserted this number (a clump counts as one); this or `mass`.
        count: Option<u64> = absent("no limit"), "", AtLeast(1.0), "500";
        /// The insertion opens again this long after `from`, and again; at least `until` − `from`. It needs `until`, `mass` or `count`: each time
        /// ends when it has inserted that, at `until`, or when the next begins, whichever comes first.
        repeat: Option<f64> = absent("never"), "s", Positive, "5";
        /// With `repeat`: how often it opens in all.
        times: Option<u64> = absent("no limit"), "", AtLeast(1.0), "3";
        /// Where another grain has the place of one that is due: it comes in at this place later, when that is free; it does not come in; the run stops.
        when_blocked: WhenBlocked = absent("\"wait\""), "", Any, "\"skip\"";
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
