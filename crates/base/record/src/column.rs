//! Names of columns; vectors are three columns.

/// Three columns of a vector.
pub type Vector = [&'static str; 3];

/// Position [m]: particles, walls, contacts, bonds, crossings.
pub const POSITION: Vector = ["x", "y", "z"];
/// Velocity [m/s].
pub const VELOCITY: Vector = ["vx", "vy", "vz"];
/// Angular velocity [rad/s].
pub const SPIN: Vector = ["wx", "wy", "wz"];
/// Orientation: the real part, then [`ORIENTATION`].
pub const ORIENTATION_REAL: &str = "qw";
/// Orientation: the vector part.
pub const ORIENTATION: Vector = ["qx", "qy", "qz"];
/// Radius [m].
pub const RADIUS: &str = "radius";
/// Diameter [m], in files of particles.
pub const DIAMETER: &str = "diameter";
/// Unique number of a particle, or of the first member of a clump.
pub const ID: &str = "id";
/// Index of the material.
pub const MATERIAL: &str = "material";
/// Id of the clump of a particle; its own id where it has none.
pub const BODY: &str = "body";
/// Number of spheres of a clump.
pub const MEMBERS: &str = "members";
/// Index of a clump's shape.
pub const CLUMP: &str = "clump";
/// Size of a clump over that of its shape [–].
pub const SCALE: &str = "scale";
/// Cluster that a particle belongs to; 0: none.
pub const CLUSTER: &str = "cluster";
/// Mass [kg].
pub const MASS: &str = "mass";
/// Index of a wall.
pub const WALL: &str = "wall";
/// Number of a sphere or triangle of a wall.
pub const PART: &str = "part";
/// Length of the time that sums are of [s].
pub const INTERVAL: &str = "interval";
/// Time integral of a normal force, without its sign [N·s].
pub const NORMAL_IMPULSE: &str = "normal_impulse";
/// Largest normal force of a contact [N].
pub const LARGEST_NORMAL: &str = "largest_normal";
/// Grains that came to touch a part of a wall.
pub const IMPACTS: &str = "impacts";
/// Energy of their approach along the normal, and along the surface [J].
pub const IMPACT_ENERGY: [&str; 2] = ["impact_normal", "impact_tangential"];
/// Unit normal of a contact, from j to i [–].
pub const NORMAL: Vector = ["nx", "ny", "nz"];
/// Force on i [N].
pub const FORCE: Vector = ["fx", "fy", "fz"];
/// Overlap [m].
pub const OVERLAP: &str = "overlap";
/// First particle of a contact or bond.
pub const FIRST: &str = "id_i";
/// Second particle of a contact or bond, or the wall.
pub const SECOND: &str = "id_j";
/// 0: two particles; 1: a particle and a wall.
pub const KIND: &str = "kind";
/// Sliding work since the frame before [J].
pub const WORK: &str = "work";
/// Largest tension σ of a bond [Pa]; of a broken one, that at the break.
pub const TENSION: &str = "tension";
/// Shear τ of a bond [Pa]; of a broken one, that at the break.
pub const SHEAR: &str = "shear";
/// 1: the bond is broken.
pub const BROKEN: &str = "broken";
/// When the bond broke [s].
pub const BROKEN_AT: &str = "broken_at";
/// What broke a bond: 1 tension, 2 shear; 0: it is whole.
pub const MODE: &str = "mode";
/// σ_c of a bond [Pa].
pub const TENSILE_STRENGTH: &str = "tensile_strength";
/// τ_c of a bond at its present pressure [Pa].
pub const SHEAR_STRENGTH: &str = "shear_strength";
/// Elastic energy that a bond held when it broke [J].
pub const ENERGY: &str = "energy";
/// Clusters of the particles of a bond.
pub const CLUSTERS: [&str; 2] = ["cluster_i", "cluster_j"];
/// Time of a crossing, or of a crack [s].
pub const TIME: &str = "time";
/// Index of the outlet.
pub const OUTLET: &str = "outlet";
/// Number of contacts of a particle that crosses.
pub const CONTACTS: &str = "contacts";
/// The other particle of a contact or bond of a particle that crosses.
pub const PARTNER: &str = "partner";
/// 1: the particle has gone back upstream.
pub const GONE: &str = "gone";
