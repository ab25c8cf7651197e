//! Zones that grains leave and enter a stage by, `[[outlet]]` and `[[inlet]]`, and those that take grains out: `[[remove]]`.

use super::table::table;
use super::{OrAuto, PlaneText, ShapeText};
use dem::setup::{ZoneMotion, ZoneTest};

table! {
    /// `[[outlet]]`
    Outlet section {
        /// Storage plane `px,py,pz,nx,ny,nz`; the normal points downstream.
        plane: PlaneText = required, "m", Any, "[0, 0, 0.2, 0, 0, -1]";
        /// Length of the zone; "auto" is 1.2 × the largest diameter.
        length: OrAuto = absent("\"auto\""), "m", Positive, "0.01";
        /// Motion of grains in the zone.
        motion: ZoneMotion = absent("\"constant\""), "", Any, "\"ballistic\"";
        /// Which point of a grain triggers a crossing.
        test: ZoneTest = absent("\"centre\""), "", Any, "\"lowest\"";
        /// With "recorded": time between samples of paths.
        samples: Option<f64> = absent("ten steps"), "s", Positive, "1e-4";
        /// Mark of the plant that the stage was cut from ([stages.md](../how-to/stages.md#what-is-refused)).
        plant: Option<String> = absent("none"), "", Any, "\"1f3a\"";
    }
}

table! {
    /// `[[remove]]`
    Remove section {
        /// Where grains are taken out: `box:…`, `sphere:…`, `cylinder:…`, `cone:…` or `mesh:FILE` (closed), as for `[[insert]]`.
        shape: ShapeText = required, "m", Any, "\"box:0,0,0,0.1,0.1,0.02\"";
    }
}

table! {
    /// `[[inlet]]`
    Inlet section {
        /// Calculation plane; the normal points downstream.
        plane: PlaneText = required, "m", Any, "[0, 0, 0.2, 0, 0, -1]";
        /// Length of the zone.
        length: OrAuto = absent("that of the stream"), "m", Positive, "0.01";
        /// Motion of grains in the zone.
        motion: Option<ZoneMotion> = absent("that of the stream"), "", Any, "\"ballistic\"";
        /// Which point of a grain triggers a crossing.
        test: Option<ZoneTest> = absent("that of the stream"), "", Any, "\"lowest\"";
        /// Mark of the plant; a record of another plant is refused.
        plant: Option<String> = absent("none"), "", Any, "\"1f3a\"";
        /// Inlet MCAP.
        source: Option<String> = absent("command line"), "", File, "\"inlet.mcap\"";
    }
}
