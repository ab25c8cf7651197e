//! Small scenes as a user writes them, and the folders that hold them.

use std::path::Path;
use tempfile::TempDir;

/// What every scene begins with: one material, and its law of contact for all pairs.
#[derive(Debug, Clone, Copy)]
pub struct Head {
    /// Lines of `[time]`.
    pub time: &'static str,
    /// Lines of `[output]`.
    pub output: &'static str,
    /// Name of the material.
    pub material: &'static str,
    /// Its density [kg/m³].
    pub density: f64,
    /// Its Young's modulus [Pa].
    pub young: f64,
    /// Lines of `[[contact]]` besides its materials.
    pub contact: &'static str,
}

impl Head {
    /// As text, gravity included; what there is to simulate comes behind it.
    pub fn toml(&self) -> String {
        let Head { time, output, material, density, young, contact } = self;
        format!(
            "gravity = [0, 0, -9.81]\n[time]\n{time}\n[output]\n{output}\n[[material]]\nname = \"{material}\"\n\
             density = {density}\nyoung = {young:e}\npoisson = 0.25\n[[contact]]\nbetween = [\"*\", \"*\"]\n{contact}\n"
        )
    }

    /// With grains poured into a cylinder over a floor, of so much mass [kg].
    pub fn poured(&self, mass: f64) -> String {
        let material = self.material;
        let fill = "shape = \"cylinder:0,0,0,0,0,0.1,0.04\"\ndiameter = [0.008, 0.012]";
        format!("{}[[fill]]\nmaterial = \"{material}\"\n{fill}\nmass = {mass}\n{}", self.toml(), self.floor())
    }

    /// A floor at z = 0.
    pub fn floor(&self) -> String {
        format!("[[wall]]\nplane = \"0,0,0,0,0,1\"\nmaterial = \"{}\"\n", self.material)
    }
}

/// What rubs and rolls.
pub const RUBS: &str = "restitution = 0.5\nsliding_friction = 0.5\nrolling_resistance = 0.1";

/// Sinter as plants have it that are cut in stages.
pub const SINTER: Head = Head {
    time: "until = 0.3",
    output: "every = 0.02\ncheckpoint = 0.1",
    material: "sinter",
    density: 3300.0,
    young: 5e7,
    contact: "restitution = 0.5\nsliding_friction = 0.5",
};

/// Glass beads, soft enough for few steps.
pub const GLASS: Head = Head {
    time: "until = 0.3",
    output: "every = 0.02",
    material: "glass",
    density: 2500.0,
    young: 1e6,
    contact: "law = \"hertz\"\nrestitution = 0.6\nsliding_friction = 0.4",
};

/// Grains of [`SINTER`] that fall through the plane z = 0.
pub const ABOVE: &str = "[[fill]]
material = \"sinter\"
shape = \"cylinder:0,0,0.02,0,0,0.12,0.04\"
diameter = [0.008, 0.012]
mass = 0.15
";

/// The plane that such a plant is cut at.
pub const AT: &str = "0,0,0,0,0,-1";

/// A folder of its own with these files; it goes when it is dropped.
///
/// # Panics
/// When it cannot be written.
pub fn folder<T: AsRef<[u8]>>(files: &[(&str, T)]) -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    files.iter().for_each(|(name, content)| write(folder.path(), name, content));
    folder
}

/// Writes a file into a folder.
///
/// # Panics
/// When it cannot be written.
pub fn write(folder: &Path, name: &str, content: impl AsRef<[u8]>) {
    let path = folder.join(name);
    path.parent().map(std::fs::create_dir_all).transpose().expect("a folder can be made");
    std::fs::write(path, content).expect("a file can be written");
}
