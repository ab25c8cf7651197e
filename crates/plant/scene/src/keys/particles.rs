//! Particles: where they are, come from, and leave.

use super::table::{table, words};
use super::{OrAuto, PlaneText};
use dem::setup::{ZoneMotion, ZoneTest};

/// One diameter or a range [m].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Diameter {
    /// Smallest [m].
    pub low: f64,
    /// Largest [m].
    pub high: f64,
}

words! {
    /// What shares of sizes are of.
    #[derive(Default)]
    ShareOf {
        /// Of mass, as sieves tell.
        #[default]
        Mass "mass",
        /// Of number.
        Number "number",
    }
}

table! {
    /// `[[clump]]`: `spheres`, or `mesh` with `vertex_radius`.
    Clump section {
        /// Name that other entries use.
        name: String = required, "", Name, "\"stone\"";
        /// Material of all members.
        material: String = required, "", Any, "\"glass\"";
        /// Members: x, y, z, radius of each; this or `mesh`.
        spheres: Option<Vec<[f64; 4]>> = absent("–"), "m", Finite, "[[0, 0, 0, 0.01], [0.01, 0, 0, 0.01]]";
        /// With `spheres`: "union" is exact to 1e-9; "sum" counts overlaps twice.
        mass: ClumpMass = absent("\"union\""), "", Any, "\"sum\"";
        /// With `spheres`, instead of `mass`: the true body, in the frame of the spheres and before `scale`, as `stone-clump` writes it.
        moments: Option<ClumpMoments> = absent("–"), "", Any, "";
        /// Closed surface of triangles (PLY, STL, OBJ, text); this or `spheres`.
        mesh: Option<String> = absent("–"), "file", Any, "\"stone.ply\"";
        /// With `mesh`: radius of the sphere on each vertex, before `scale`.
        vertex_radius: Option<f64> = absent("–"), "m", Positive, "0.001";
        /// With `mesh`: spheres sit on the vertices of the mesh thinned to so many faces.
        faces: Option<u32> = absent("all"), "", Any, "100";
        /// Factor on all lengths.
        scale: f64 = default(1.0), "", Positive, "0.5";
    }
}

table! {
    /// `[[clump]] moments`: a body of density 1.
    #[derive(Copy)]
    ClumpMoments inline {
        /// Volume.
        volume: f64 = required, "m³", Positive, "1e-6";
        /// Centre of mass.
        centre: [f64; 3] = required, "m", Finite, "[0, 0, 0]";
        /// Terms xx, yy, zz, xy, xz, yz of the inertia tensor of density 1 about the centre of mass.
        inertia: [f64; 6] = required, "m⁵", Finite, "[1e-11, 1e-11, 1e-11, 0, 0, 0]";
    }
}

impl ClumpMoments {
    /// The inertia tensor of density 1 [m⁵].
    pub fn tensor(&self) -> nalgebra::Matrix3<f64> {
        let [xx, yy, zz, xy, xz, yz] = self.inertia;
        nalgebra::Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
    }
}

words! {
    /// Mass, centre and inertia of a clump of spheres.
    #[derive(Default)]
    ClumpMass {
        /// Of the union.
        #[default]
        Union "union",
        /// Of the sum: where spheres overlap, twice.
        Sum "sum",
    }
}

table! {
    /// `[[body]]`: one rigid clump.
    Body section {
        /// Name of its `[[clump]]`.
        clump: String = required, "", Any, "\"stone\"";
        /// Centre of mass.
        position: [f64; 3] = required, "m", Finite, "[0, 0, 0.1]";
        /// Orientation w, x, y, z.
        quaternion: [f64; 4] = default([1.0, 0.0, 0.0, 0.0]), "", Any, "[0, 0, 0, 1]";
        /// Velocity of the centre of mass.
        velocity: [f64; 3] = absent("0"), "m/s", Finite, "[0, 0, -1]";
        /// Angular velocity.
        spin: [f64; 3] = absent("0"), "rad/s", Finite, "[0, 0, \"30 rpm\"]";
        /// Factor on the size of the `[[clump]]`.
        scale: f64 = default(1.0), "", Positive, "0.5";
    }
}

words! {
    /// Lattices of equal spheres that touch.
    Lattice {
        /// Six neighbours.
        Cubic "cubic",
        /// Twelve neighbours: layers of hexagons (hexagonal close packing).
        Hexagonal "hexagonal",
    }
}

table! {
    /// `[[particles]]`
    Particles section {
        /// CSV, PLY, or a run (its last frame).
        source: String = required, "file", Any, "\"grains.csv\"";
        /// Material of all grains; this or `materials`, unless the file is a run.
        material: Option<String> = absent("that of the run"), "", Any, "\"glass\"";
        /// Each row is a clump of this name.
        clump: Option<String> = absent("–"), "", Any, "\"stone\"";
        /// [Cluster](#clusters) of all grains.
        cluster: Option<u32> = absent("that of each row, or 0"), "", Any, "1";
        /// Instead of `material`: names for the numbers 0, 1, … in the column `material` of a CSV or PLY, as `stone-pack` writes it.
        materials: Option<Vec<String>> = absent("–"), "", Any, "[\"soil\", \"stone\"]";
        /// The grains stay where they are: they are spheres of a wall.
        fixed: bool = absent("false"), "", Any, "true";
        /// Unit of the lengths in the file (positions, radii, velocities): "mm", "cm", "in", "ft"; this or `scale`; not for a run, which is in
        /// metres.
        units: Option<String> = absent("\"m\""), "", Any, "\"mm\"";
        /// Factor on these lengths; this or `units`.
        scale: Option<f64> = absent("1"), "", Positive, "0.001";
    }
}

impl Particles {
    /// Factor on the lengths in its file [–].
    pub fn length_factor(&self) -> f64 {
        super::wall::length_factor(self.scale, self.units.as_deref())
    }
}

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
        source: Option<String> = absent("command line"), "file", Any, "\"inlet.mcap\"";
    }
}
