//! The spheres and triangles of walls with what was done to them: as rows, and as geometry.

use super::life::{WearLife, Worn};
use crate::sheet::{Geometry, Head, Row};
use crate::{Run, WallSpheres};
use geom::Vec3;
use wear::{PartLoad, PartLoads, of_spheres, of_triangles};

/// What is known of the load of a part; NaN where it is not.
#[derive(Debug, Clone, Copy)]
pub(super) struct Borne {
    pub contacts: f64,
    /// Mean and largest normal force [N].
    pub mean: f64,
    pub largest: f64,
    /// Sliding work [J].
    pub work: f64,
    pub impacts: f64,
    /// Along the normal, and along the surface [J].
    pub impact_energy: [f64; 2],
}

impl Borne {
    /// From sums over every step of a time of this length [s].
    pub fn of(load: PartLoad, length: f64) -> Borne {
        Borne {
            // How many contacts frames show is not known here.
            contacts: f64::NAN,
            mean: if length > 0.0 { load.normal_impulse / length } else { 0.0 },
            largest: load.largest_normal,
            work: load.work,
            impacts: load.impacts as f64,
            impact_energy: load.impact_energy,
        }
    }

    /// The columns behind place and size, where the load is spread over an area [m²].
    pub fn columns(&self, area: f64) -> Row {
        let [normal, tangential] = self.impact_energy;
        let of_area = [self.work / area, self.mean / area];
        let first = [self.contacts, self.mean, self.largest, self.work];
        [&first[..], &of_area, &[self.impacts, normal + tangential]].concat()
    }
}

/// A sphere or a triangle of a wall.
#[derive(Debug, Clone)]
pub(super) struct WornPart {
    /// Index of the wall, and number in it.
    wall: usize,
    part: usize,
    shape: PartShape,
    /// Where its file has it, and its radius, or that of a disk as large, there.
    of_file: (Vec3, f64),
    /// What it stands for of the wall [m²].
    area: f64,
    borne: Borne,
}

/// Where it is at t = 0 [m].
#[derive(Debug, Clone, Copy)]
enum PartShape {
    Sphere(Vec3, f64),
    Triangle([Vec3; 3]),
}

/// The spheres of all walls, as they are in the first frame that is measured.
#[derive(Debug, Default)]
pub(super) struct SphereParts {
    pub wall: Vec<u64>,
    /// Number in its wall.
    part: Vec<usize>,
    /// At t = 0 [m].
    home: Vec<(Vec3, f64)>,
    pub of_file: Vec<(Vec3, f64)>,
    area: Vec<f64>,
}

impl SphereParts {
    /// Of a run.
    pub fn of(run: &Run) -> SphereParts {
        let WallSpheres { position, radius, wall, time } = &run.spheres;
        let count = position.len();
        let home: Vec<(Vec3, f64)> =
            (0..count).map(|k| (run.home(wall[k], *time, &position[k]), radius[k])).collect();
        let (mut part, mut area) = (Vec::with_capacity(count), Vec::with_capacity(count));
        // Spheres of one wall follow each other.
        for of_wall in wall.chunk_by(|a, b| a == b) {
            let first = part.len();
            let rows = first..first + of_wall.len();
            let centres: Vec<Vec3> = home[rows.clone()].iter().map(|(centre, _)| *centre).collect();
            part.extend(0..of_wall.len());
            area.extend(of_spheres(&centres, &radius[rows]));
        }
        SphereParts { wall: wall.clone(), part, home, of_file: run.spheres_of_files(), area }
    }

    /// One of them with what was done to it, by its row.
    pub fn part(&self, row: usize, borne: Borne) -> WornPart {
        let (centre, radius) = self.home[row];
        WornPart {
            wall: self.wall[row] as usize,
            part: self.part[row],
            shape: PartShape::Sphere(centre, radius),
            of_file: self.of_file[row],
            area: self.area[row],
            borne,
        }
    }
}

/// All spheres and triangles of the walls that are `wanted`, with sums over every step.
pub(super) fn of_sums(
    run: &Run,
    spheres: &SphereParts,
    loads: &PartLoads,
    wanted: impl Fn(u64) -> bool,
) -> Vec<WornPart> {
    let borne = |wall: usize, part: usize| Borne::of(loads.of((wall as u64, part as u64)), loads.length());
    let of_spheres = (0..spheres.wall.len()).filter(|row| wanted(spheres.wall[*row]));
    let mut all: Vec<WornPart> = of_spheres
        .map(|row| spheres.part(row, borne(spheres.wall[row] as usize, spheres.part[row])))
        .collect();
    for wall in (0..run.meshes.len()).filter(|wall| wanted(*wall as u64)) {
        let Some(mesh) = &run.meshes[wall] else { continue };
        let of_file = run.triangles_of_file(wall);
        let areas = of_triangles(mesh);
        for (part, (corners, (of_file, area))) in
            mesh.triangles().zip(of_file.into_iter().zip(areas)).enumerate()
        {
            let shape = PartShape::Triangle(corners);
            all.push(WornPart { wall, part, shape, of_file, area, borne: borne(wall, part) });
        }
    }
    all
}

impl WornPart {
    /// Depth, rate and life, where they are asked for.
    fn worn(&self, run: &Run, life: Option<&WearLife>, length: f64) -> Worn {
        let of =
            |life: &WearLife| life.worn(life.of(run, Some(self.wall)), self.borne.work / self.area, length);
        life.map_or([f64::NAN; 3], of)
    }

    /// Its row.
    pub fn row(&self, run: &Run, life: Option<&WearLife>, length: f64) -> Row {
        let (place, size) = self.of_file;
        let worn = self.worn(run, life, length);
        let columns = life.map_or(0, WearLife::columns);
        let first = [place.x, place.y, place.z, size];
        [&first[..], &self.borne.columns(self.area), &worn[..columns]].concat()
    }

    pub fn wall(&self) -> usize {
        self.wall
    }

    pub fn part_number(&self) -> usize {
        self.part
    }

    /// Its numbers in a geometry: [`geometry_heads`].
    fn numbers(&self, row: &Row) -> Row {
        let [normal, tangential] = self.borne.impact_energy;
        let first = [self.wall as f64, self.part as f64, self.area];
        // Behind x, y, z, size and contacts.
        [&first[..], &row[5..12], &[normal, tangential], &row[12..]].concat()
    }
}

/// Heads of the numbers of a geometry, where the rows have these `heads`.
fn geometry_heads(heads: &[Head]) -> Vec<Head> {
    let first = Head::list(&[("wall", "1"), ("part", "1"), ("area", "m²")]);
    let energies = Head::list(&[("impact_normal", "J"), ("impact_tangential", "J")]);
    [&first[..], &heads[5..12], &energies, &heads[12..]].concat()
}

/// Parts and their rows as a geometry: where they are at t = 0.
pub(super) fn geometry(parts: &[WornPart], rows: &[Row], heads: &[Head]) -> Geometry {
    let mut all = Geometry { heads: geometry_heads(heads), ..Geometry::default() };
    for (part, row) in parts.iter().zip(rows) {
        match part.shape {
            PartShape::Sphere(centre, radius) => all.spheres.push((centre, radius, part.numbers(row))),
            PartShape::Triangle(corners) => all.triangles.push((corners, part.numbers(row))),
        }
    }
    all
}
