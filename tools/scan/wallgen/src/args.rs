//! The command line.

use anyhow::Context;
use geom::Vec3;
use geom::number::{finite, positive};
use record::MaterialRecord;
use std::path::{Path, PathBuf};
use wall::drawn::Drawing;
use wall::{Placement, Radius, Regions, Representative, WallSettings};

const EXAMPLES: &str = "Examples:\n\
    \x20 wallgen sampled.ply --roughness 0.0015 --radius uniform --material steel -o walls.mcap\n\
    \x20 wallgen --from-mesh hopper.ply --radius 0.03 --roughness 0.003 --material steel -o hopper.mcap\n\
    \x20 wallgen sampled.ply --from-mesh hopper.ply --roughness 0.0015 --radius uniform -o both.mcap";

/// Turn the points of a surface into wall spheres (MCAP; PLY with -o FILE.ply).
#[derive(clap::Parser)]
#[command(after_help = EXAMPLES)]
#[command(allow_negative_numbers = true)]
pub struct Args {
    #[command(flatten)]
    pub input: cloud_cli::Input,
    #[command(flatten)]
    pub output: cloud_cli::CloudOutput,
    /// Depth of the dents between neighbouring spheres [m], or a file of regions and wear (docs/reference/wall-input.md)
    #[arg(long, value_name = "M|FILE.toml", allow_hyphen_values = true)]
    roughness: Option<cli::MaybeFile>,
    /// Radii: solve (pair by pair), uniform, or a length [m]
    #[arg(long, value_name = "solve|uniform|M", default_value = "solve", value_parser = radius)]
    radius: Radius,
    /// Which average of the neighbour distances the radii follow from (default: mean)
    #[arg(long, value_enum)]
    representative: Option<Middle>,
    /// Which point of a sphere lies on the scanned point: its surface on the flow side, or its centre (default: surface where the flow side is known, by --facing, --flow-at, the viewpoints of the cloud or a drawing; else centre)
    #[arg(long, value_enum)]
    place: Option<Place>,
    /// Direction to the flow side: the surfaces of the spheres go through the points
    #[arg(long, value_name = "x,y,z", value_parser = vector, allow_hyphen_values = true)]
    facing: Option<Vec3>,
    /// A point in the flow [m], instead of --facing: for closed equipment, and to choose the side of a drawing
    #[arg(long, value_name = "x,y,z", value_parser = vector, allow_hyphen_values = true, conflicts_with = "facing")]
    flow_at: Option<Vec3>,
    /// Drawn equipment (PLY, STL, OBJ; in m, or see --units). Alone: spheres of --radius M inside it that touch its surface. With a cloud: its surface stands in where the cloud is sparse
    #[arg(long, value_name = "FILE")]
    pub from_mesh: Option<PathBuf>,
    /// Name of the material (default: wall)
    #[arg(long, value_name = "NAME")]
    material: Option<String>,
    /// Young's modulus [Pa]
    #[arg(long, value_name = "PA", value_parser = finite)]
    young: Option<f64>,
    /// Poisson's ratio
    #[arg(long, value_name = "X", value_parser = finite, allow_hyphen_values = true)]
    poisson: Option<f64>,
    /// Coefficient of sliding friction
    #[arg(long, value_name = "X", value_parser = finite)]
    friction: Option<f64>,
    /// Coefficient of restitution
    #[arg(long, value_name = "X", value_parser = finite)]
    restitution: Option<f64>,
    /// Velocity of the surface [m/s], as that of a belt: the spheres stay where they are
    #[arg(long, value_name = "x,y,z", default_value = "0,0,0", value_parser = vector, allow_hyphen_values = true)]
    velocity: Vec3,
    /// Diameter of the smallest particle [m]: checks the wall's gaps and the spheres' sizes
    #[arg(long, value_name = "M", value_parser = finite)]
    smallest_particle: Option<f64>,
    /// Diameter of the largest particle [m]: checks the spheres' sizes
    #[arg(long, value_name = "M", value_parser = finite)]
    largest_particle: Option<f64>,
    /// Report the largest sphere that passes through the wall, and where (also reported with --smallest-particle)
    #[arg(long)]
    pub gaps: bool,
    /// Write the pairs of neighbours without the requested roughness: point_i,point_j,x,y,z,distance,asked,made [m]
    #[arg(long, value_name = "FILE.csv")]
    pub changes: Option<cli::OutPath>,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum Middle {
    Mean,
    Median,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum Place {
    Centre,
    Surface,
}

impl Args {
    /// What the options ask for.
    pub fn settings(&self) -> anyhow::Result<WallSettings> {
        if !self.is_drawing() && self.roughness.is_none() && !matches!(self.radius, Radius::Given(_)) {
            return Err(cli::usage(
                "--roughness: is needed to find the radii; add --roughness M, or give --radius M",
            ));
        }
        if self.facing.is_some_and(|facing| facing.norm() == 0.0) {
            return Err(cli::usage("--facing 0,0,0: has no direction; give one, such as 0,0,1"));
        }
        for (option, diameter) in [("smallest", self.smallest_particle), ("largest", self.largest_particle)] {
            if let Some(diameter) = diameter.filter(|d| !(*d > 0.0 && d.is_finite())) {
                return Err(cli::usage(format!(
                    "--{option}-particle {diameter} m: must be a positive diameter"
                )));
            }
        }
        if let (Some(smallest), Some(largest)) = (self.smallest_particle, self.largest_particle)
            && smallest > largest
        {
            return Err(cli::usage(format!(
                "--smallest-particle {smallest} m: is larger than --largest-particle {largest} m: exchange them"
            )));
        }
        let has_flow = self.facing.or(self.flow_at).is_some();
        let placement = match self.place {
            // The spheres of a drawing are where they belong.
            _ if self.is_drawing() => Placement::Centre,
            Some(Place::Surface) => Placement::Surface,
            None if has_flow => Placement::Surface,
            Some(Place::Centre) | None => Placement::Centre,
        };
        let representative = match self.representative {
            Some(Middle::Median) => Representative::Median,
            Some(Middle::Mean) | None => Representative::Mean,
        };
        Ok(WallSettings {
            radius: self.radius,
            representative,
            placement,
            facing: self.facing,
            flow_at: self.flow_at,
            seen_from: Vec::new(),
            smallest_particle: self.smallest_particle,
            largest_particle: self.largest_particle,
            gaps: self.gaps,
            of_drawing: self.is_drawing(),
            list_changes: self.changes.is_some(),
        })
    }

    /// Takes the side of the flow from the viewpoints of the cloud [m] where no option gives it.
    ///
    /// # Errors
    /// Surfaces are to be on the points, and no side is known.
    pub fn look(
        &self,
        settings: &mut WallSettings,
        viewpoints: impl Iterator<Item = Vec3>,
    ) -> anyhow::Result<()> {
        let wants = !self.is_drawing() && !matches!(self.place, Some(Place::Centre));
        if !wants || self.facing.or(self.flow_at).is_some() {
            return Ok(());
        }
        settings.seen_from = viewpoints.collect();
        if !settings.seen_from.is_empty() {
            settings.placement = Placement::Surface;
        } else if matches!(self.place, Some(Place::Surface)) {
            return Err(cli::usage(
                "--place surface: the flow side is needed, and the cloud states no viewpoint; add --facing x,y,z, or --flow-at x,y,z",
            ));
        }
        Ok(())
    }

    /// Whether a drawing stands for the whole wall, and no cloud is read.
    pub fn is_drawing(&self) -> bool {
        self.from_mesh.is_some() && self.input.cloud.path().is_none()
    }

    /// How the spheres of a drawing are placed.
    pub fn drawing(&self, regions: &Regions) -> anyhow::Result<Drawing> {
        if self.facing.is_some() {
            return Err(cli::usage(
                "--facing: does not work with a drawing; give a point in the flow, --flow-at x,y,z",
            ));
        }
        let (Radius::Given(radius), Some(roughness)) = (self.radius, regions.least_roughness()) else {
            let missing = match (self.radius, regions.least_roughness()) {
                (Radius::Given(_), _) => "--roughness M",
                (_, Some(_)) => "--radius M",
                (_, None) => "--radius M and --roughness M",
            };
            return Err(cli::usage(format!(
                "--from-mesh: all spheres have one given radius, and the distance between them follows from the roughness; add {missing}"
            )));
        };
        let centred = matches!(self.place, Some(Place::Centre));
        Ok(Drawing { radius, roughness, flow_at: self.flow_at, centred })
    }

    /// Roughness, material and velocity, everywhere or by region.
    pub fn regions(&self) -> anyhow::Result<Regions> {
        let material = MaterialRecord {
            density: None,
            name: self.material.clone().unwrap_or_else(|| "wall".to_owned()),
            young: self.young,
            poisson: self.poisson,
            friction: self.friction,
            restitution: self.restitution,
        };
        self.check_length()?;
        let Some(path) = self.regions_file() else {
            let roughness = self.roughness.as_ref().map(|given| given.text().parse::<f64>()).transpose();
            let roughness =
                roughness.map_err(|_| cli::usage("--roughness: give a length in m, or FILE.toml"))?;
            return Regions::one(roughness, material, self.velocity)
                .map_err(|e| cli::usage(option(&e.to_string())));
        };
        let text = stream::whole::text(path).with_context(|| format!("{}: cannot read", path.display()))?;
        let folder = path.parent().unwrap_or(Path::new(""));
        let read = |name: &str| {
            let file = folder.join(name);
            stream::whole::text(&file).map_err(|e| format!("cannot read: {e}"))
        };
        let regions = Regions::parse(&text, material, self.velocity, &mesh::load, &read)
            .with_context(|| path.display().to_string())?;
        self.check_ply_regions(&regions, path)?;
        Ok(regions)
    }

    /// Refuses properties of the materials of regions where the output is PLY.
    fn check_ply_regions(&self, regions: &Regions, path: &Path) -> anyhow::Result<()> {
        let has_values =
            |m: &&MaterialRecord| m.young.or(m.poisson).or(m.friction).or(m.restitution).is_some();
        match regions.materials.iter().find(has_values).filter(|_| self.output.to.has_extension("ply")) {
            Some(material) => Err(cli::usage(format!(
                "{}: material '{}' has properties, and a PLY file has no place for them: leave them out, or write \
                 walls MCAP (-o FILE.mcap)",
                path.display(),
                material.name
            ))),
            None => Ok(()),
        }
    }

    /// Role and hash of the table of regions, for provenance.
    pub fn regions_hash(&self) -> anyhow::Result<Option<(String, String)>> {
        let Some(path) = self.regions_file() else { return Ok(None) };
        let bytes = stream::whole::file(path).with_context(|| format!("{}: cannot read", path.display()))?;
        Ok(Some(("roughness".to_owned(), stream::sha256(&bytes))))
    }

    /// Refuses a length with a unit behind it, which is not the name of a file either.
    fn check_length(&self) -> anyhow::Result<()> {
        let Some(path) = self.regions_file().filter(|path| !path.exists()) else { return Ok(()) };
        let text = path.to_string_lossy();
        let unit = text.trim_start_matches(|c: char| c.is_ascii_digit() || "+-.,".contains(c)).trim();
        if matches!(unit, "" | "m" | "mm" | "cm" | "um" | "µm" | "in") {
            return Err(cli::usage(format!("--roughness {text}: is neither a length in metres nor a file")));
        }
        Ok(())
    }

    /// Refuses options that would change nothing.
    pub fn check_used(&self) -> anyhow::Result<()> {
        self.check_ply()?;
        if self.is_drawing() {
            self.input.columns.none("--from-mesh alone reads no cloud")?;
        }
        if let (Radius::Given(radius), Some(_)) = (self.radius, self.representative) {
            return Err(cli::usage(format!(
                "--representative: the radius is given (--radius {radius}), and no average of distances is used: \
                 leave it out, or use --radius uniform"
            )));
        }
        let flow = self.facing.map(|_| "--facing").or(self.flow_at.map(|_| "--flow-at"));
        match flow.filter(|_| !self.is_drawing() && matches!(self.place, Some(Place::Centre))) {
            Some(option) => Err(cli::usage(format!(
                "{option}: the flow side changes nothing with the centres on the points: leave it out, or \
                 --place centre"
            ))),
            None => Ok(()),
        }
    }

    /// Refuses properties of the material where the output has no place for them: PLY is geometry alone.
    fn check_ply(&self) -> anyhow::Result<()> {
        let given = [
            (self.material.is_some(), "--material"),
            (self.young.is_some(), "--young"),
            (self.poisson.is_some(), "--poisson"),
            (self.friction.is_some(), "--friction"),
            (self.restitution.is_some(), "--restitution"),
        ];
        match given.iter().find(|g| g.0).filter(|_| self.output.to.has_extension("ply")) {
            Some((_, option)) => Err(cli::usage(format!(
                "{option}: a PLY file has no place for it: leave it out, or write walls MCAP (-o FILE.mcap)"
            ))),
            None => Ok(()),
        }
    }

    /// A roughness that is not a number is a file.
    fn regions_file(&self) -> Option<&Path> {
        self.roughness
            .as_ref()
            .map(cli::MaybeFile::text)
            .filter(|text| text.parse::<f64>().is_err())
            .map(Path::new)
    }
}

/// Puts the option in front of a message of the library.
fn option(message: &str) -> String {
    let detail = ["roughness: ", "material: "].iter().find_map(|place| message.strip_prefix(place));
    match detail {
        Some(detail) if detail.contains(" [Pa] ") => {
            format!("--{}", detail.replace(" [Pa]", "").replacen(": ", " Pa: ", 1))
        }
        Some(detail) if !detail.starts_with("the ") && !detail.starts_with("material ") => {
            format!("--{detail}")
        }
        _ => format!("--{message}"),
    }
}

fn radius(text: &str) -> Result<Radius, String> {
    match text {
        "solve" => Ok(Radius::Solve),
        "uniform" => Ok(Radius::Uniform),
        _ => match positive(text) {
            Ok(radius) => Ok(Radius::Given(radius)),
            Err(_) => Err(format!("'{text}' is neither solve, uniform, nor a positive length in m")),
        },
    }
}

fn vector(text: &str) -> Result<Vec3, String> {
    let wrong = || format!("'{text}' is not x,y,z: give three numbers");
    let numbers: Vec<f64> =
        text.split(',').map(|t| t.trim().parse().map_err(|_| wrong())).collect::<Result<_, _>>()?;
    match numbers[..] {
        [x, y, z] if numbers.iter().all(|n| n.is_finite()) => Ok(Vec3::new(x, y, z)),
        _ => Err(wrong()),
    }
}
