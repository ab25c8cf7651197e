//! Names of metadata records.

/// The scene of a run; its key `toml` holds the text.
pub const SCENE: &str = "scene";
/// Materials by index, see [`crate::MaterialRecord`].
pub const MATERIALS: &str = "materials";
/// Time step, first and last time of a run [s].
pub const TIME: &str = "time";
/// How far along gravity, `down` [–], any wall of a run reaches, `depth` [m]; only where grains may fall past all of them.
pub const WALLS_END: &str = "walls_end";
/// By index of a wall of spheres that is put elsewhere than its file has it, or scaled: the 16 numbers that take the file's points there, row by row.
pub const PLACES: &str = "places";
/// Radii of all particles, see [`crate::Sizes`].
pub const SIZES: &str = "sizes";
/// Key of [`SIZES`] that is there when all particles are members of clumps.
pub const ONLY_CLUMPS: &str = "only_clumps";
/// Outlets of a run by index.
pub const OUTLETS: &str = "outlets";
/// Shapes of clumps by index, see [`crate::ClumpRecord`].
pub const CLUMPS: &str = "clumps";
/// Bonds that may cross, see [`crate::BondRange`].
pub const BONDS: &str = "bonds";
/// The zone of an inlet stream.
pub const INLET: &str = "inlet";
/// How a record was replayed.
pub const REPLAY: &str = "replay";
