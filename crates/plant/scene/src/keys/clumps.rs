//! Rigid clumps: `[[clump]]` and `[[body]]`.

use super::table::{table, words};

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
        mesh: Option<String> = absent("–"), "", File, "\"stone.ply\"";
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
        quaternion: [f64; 4] = default([1.0, 0.0, 0.0, 0.0]), "", UnitLength, "[0, 0, 0, 1]";
        /// Velocity of the centre of mass.
        velocity: [f64; 3] = absent("0"), "m/s", Finite, "[0, 0, -1]";
        /// Angular velocity.
        spin: [f64; 3] = absent("0"), "rad/s", Finite, "[0, 0, \"30 rpm\"]";
        /// Factor on the size of the `[[clump]]`.
        scale: f64 = default(1.0), "", Positive, "0.5";
    }
}
