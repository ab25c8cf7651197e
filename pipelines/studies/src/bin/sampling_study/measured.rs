//! A sample and what is measured of it.

use geom::Vec3;
use sampling::nearest::NearestDistances;
use sampling::{Amount, Distance, Method, SampleSettings, Spectrum, sample};

/// All methods, the default first.
pub const METHODS: [Method; 5] =
    [Method::Poisson, Method::Eliminate, Method::Relax, Method::Tile, Method::Grid];
/// A sampling is timed so often; the least time counts.
const ROUNDS: usize = 2;

/// A sample and its measures.
pub struct Measured {
    pub method: Method,
    pub kept: usize,
    pub points: Vec<Vec3>,
    pub nearest: NearestDistances,
    pub spectrum: Option<Spectrum>,
    /// Processor time of one thread [s].
    pub seconds: f64,
}

impl Measured {
    /// As on the command line.
    pub fn name(&self) -> &'static str {
        match self.method {
            Method::Poisson => "poisson",
            Method::Eliminate => "eliminate",
            Method::Relax => "relax",
            Method::Tile => "tile",
            Method::Grid => "grid",
        }
    }
}

/// Samples on one thread, and measures.
///
/// # Errors
/// What cannot be sampled.
pub fn measured(
    points: &[Vec3],
    amount: Amount,
    method: Method,
    distance: Distance,
) -> Result<Measured, String> {
    let settings = SampleSettings { amount, method, distance, seed: 0 };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().map_err(|why| why.to_string())?;
    let timed = || {
        let start = busy();
        let made = sample(points, None, &settings).map_err(|why| why.to_string())?;
        Ok::<_, String>((made, busy() - start))
    };
    let rounds: Vec<_> = (0..ROUNDS).map(|_| pool.install(timed)).collect::<Result<_, _>>()?;
    let seconds = rounds.iter().map(|(_, seconds)| *seconds).fold(f64::INFINITY, f64::min);
    let kept: Vec<Vec3> = rounds[0].0.kept.iter().map(|&i| points[i as usize]).collect();
    let nearest = sampling::nearest_distances(&kept).ok_or("a single point is no sample")?;
    let spectrum = sampling::spectrum(&kept, nearest.median);
    Ok(Measured { method, kept: kept.len(), points: kept, nearest, spectrum, seconds })
}

/// Time that this thread was on a processor [s]; the time of day where the system does not tell.
fn busy() -> f64 {
    let told = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = told.and_then(|t| t.split_whitespace().next().and_then(|n| n.parse::<f64>().ok()));
    let now = || {
        std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).map_or(0.0, |t| t.as_secs_f64())
    };
    nanoseconds.map_or_else(now, |n| 1e-9 * n)
}
