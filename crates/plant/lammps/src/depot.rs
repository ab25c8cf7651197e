//! Where grains that come in by one inlet wait: a block of places upstream of all atoms, the first of them in front.

use crate::error::Refusal;
use dem::setup::{Entry, Setup, WallShape, Zone};
use geom::Vec3;

/// Distance of two places over the largest diameter [–].
const APART: f64 = 1.25;

/// Places at which grains wait.
pub struct Depot {
    /// Middle of the front [m].
    front: Vec3,
    /// Away from the inlet, and across.
    axes: [Vec3; 3],
    /// Distance of two places [m].
    spacing: f64,
    /// Places across each way.
    across: usize,
    /// How fast grains come from there [m/s]: mean speed of those that arrive.
    pub speed: f64,
}

impl Depot {
    /// For all that comes in by an inlet.
    ///
    /// # Errors
    /// An inlet along a periodic axis: nothing is upstream of it.
    pub fn new(setup: &Setup, zone: &Zone, entries: &[&Entry]) -> Result<Depot, Refusal> {
        let mut flow = zone.plane.normal;
        for axis in 0..3 {
            if setup.periodic[axis].is_some() {
                flow[axis] = 0.0;
            }
        }
        let Some(flow) = flow.try_normalize(1e-9) else {
            return Err(Refusal::new(
                "inlet, insert",
                "grains that come in along a periodic axis have no place upstream in LAMMPS",
                "let them come across it, or use dem-run",
            ));
        };
        let largest = entries.iter().map(|e| e.particle.radius).fold(0.0, f64::max);
        let spacing = 2.0 * APART * largest;
        let count = entries.len().max(1) as f64;
        let mean = entries.iter().map(|e| e.particle.position).sum::<Vec3>() / count;
        let speed = entries.iter().map(|e| at_arrival(setup, zone, e).norm()).sum::<f64>() / count;
        let behind = upstream(setup, entries, &flow) - spacing;
        let side = if flow.x.abs() < 0.9 { Vec3::x() } else { Vec3::y() };
        let side = (side - flow * side.dot(&flow)).normalize();
        Ok(Depot {
            front: mean + flow * (behind - mean.dot(&flow)),
            axes: [-flow, side, flow.cross(&side)],
            spacing,
            across: count.cbrt().ceil() as usize,
            speed,
        })
    }

    /// The place of a grain, by its number from 0 [m].
    pub fn place(&self, number: usize) -> Vec3 {
        let n = self.across;
        let middle = (n - 1) as f64 / 2.0;
        let steps =
            [(number / (n * n)) as f64, (number % n) as f64 - middle, (number / n % n) as f64 - middle];
        self.axes.iter().zip(steps).fold(self.front, |place, (axis, k)| place + axis * (k * self.spacing))
    }
}

/// Velocity at the end of the zone [m/s].
fn at_arrival(setup: &Setup, zone: &Zone, entry: &Entry) -> Vec3 {
    let p = &entry.particle;
    let time = zone.arrives_after(zone.past(&p.position, p.radius), &p.velocity, &setup.gravity);
    p.velocity + zone.acceleration(&setup.gravity) * time.unwrap_or(0.0)
}

/// How far all atoms, and all that come in, reach against the flow [m].
fn upstream(setup: &Setup, entries: &[&Entry], flow: &Vec3) -> f64 {
    let spheres = setup.walls.iter().flat_map(|w| match &w.shape {
        WallShape::Spheres(all) => &all[..],
        _ => &[],
    });
    let grains = setup.particles.iter().map(|p| (p.position, p.radius));
    let coming = entries.iter().map(|e| (e.particle.position, e.particle.radius));
    let all = grains.chain(coming).chain(spheres.copied());
    let lowest = all.map(|(centre, radius)| centre.dot(flow) - radius).fold(f64::INFINITY, f64::min);
    if lowest.is_finite() { lowest } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use dem::setup::Particle;

    fn entry(z: f64) -> Entry {
        let (position, velocity) = (Vec3::new(0.3, 0.0, z), Vec3::new(0.0, 0.0, -2.0));
        let particle = Particle { id: 0, material: 0, radius: 0.01, position, velocity, spin: Vec3::zeros() };
        Entry { time: 1.0, inlet: 0, particle, clump: None, turn: None, cluster: 0 }
    }

    #[test]
    fn places_are_apart_and_upstream_of_everything() {
        let setup = Setup { particles: vec![entry(0.9).particle], ..Setup::default() };
        let zone = Zone::new("0,0,0.5,0,0,-1".parse().unwrap(), 0.05);
        let entries: Vec<Entry> = (0..30).map(|_| entry(0.55)).collect();
        let depot = Depot::new(&setup, &zone, &entries.iter().collect::<Vec<_>>()).unwrap();
        assert!((depot.speed - 2.0).abs() < 1e-12);
        let places: Vec<Vec3> = (0..30).map(|k| depot.place(k)).collect();
        for (i, a) in places.iter().enumerate() {
            assert!(a.z > 0.9 + 0.02, "{a}");
            assert!(places[..i].iter().all(|b| (a - b).norm() > 0.02));
        }
        assert!((places[0].z - places[8].z).abs() < 1e-12 && places[29].z > places[0].z + 0.02);
    }

    #[test]
    fn an_inlet_along_a_periodic_axis_is_refused() {
        let setup = Setup { periodic: [None, None, Some((0.0, 1.0))], ..Setup::default() };
        let zone = Zone::new("0,0,0.5,0,0,-1".parse().unwrap(), 0.05);
        let Err(refusal) = Depot::new(&setup, &zone, &[&entry(0.55)]) else { panic!() };
        assert!(refusal.to_string().contains("along a periodic axis"));
    }
}
