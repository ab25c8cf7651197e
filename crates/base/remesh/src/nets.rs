//! The surface of samples: surface nets.
//!
//! A vertex in each cell with nodes inside and outside, at the mean of the places where the surface cuts the cell's edges; a quadrilateral
//! around each edge that is cut, as two triangles: Gibson (1998), doi:10.1007/BFb0056277. Samples are made well-composed first, so the surface
//! is closed and a manifold. In rare cells it crosses itself; towards the middles of the cells it does not ([`towards_middles`]).

use crate::composed::compose;
use crate::samples::Samples;
use geom::Vec3;
use geom::mesh::TriMesh;

/// The surface of samples, closed, faces outwards; none when nothing is inside. The nodes of the border count as outside.
pub fn surface(mut samples: Samples) -> Option<TriMesh> {
    // No vertex in a node: vertices of several cells would lie at one place.
    let least = 1e-3 * samples.step as f32;
    for index in 0..samples.values.len() {
        let border = samples.on_border(samples.node(index));
        let value = &mut samples.values[index];
        if border || value.abs() < least {
            *value = if border || *value <= 0.0 { value.min(-least) } else { least };
        }
    }
    compose(&mut samples);
    let mut vertex = vec![u32::MAX; samples.values.len()];
    let mut mesh = TriMesh::default();
    for (cell, vertex) in vertex.iter_mut().enumerate() {
        if let Some(place) = place(&samples, cell) {
            *vertex = mesh.vertices.len() as u32;
            mesh.vertices.push(place);
        }
    }
    for index in 0..samples.values.len() {
        for axis in 0..3 {
            quad(&samples, index, axis, &vertex, &mut mesh);
        }
    }
    (!mesh.faces.is_empty()).then_some(mesh)
}

/// Moves vertices of the surface half way to the middles of their cells: there the faces are those of cubes, which do not cross.
pub fn towards_middles(
    mesh: &mut TriMesh,
    origin: &Vec3,
    step: f64,
    vertices: impl IntoIterator<Item = u32>,
) {
    for v in vertices {
        let at = &mut mesh.vertices[v as usize];
        let middle = ((*at - origin) / step).map(|c| c.floor() + 0.5) * step + origin;
        *at = (*at + middle) / 2.0;
    }
}

/// The vertex of a cell (by its first node).
fn place(samples: &Samples, cell: usize) -> Option<Vec3> {
    let node = samples.node(cell);
    if (0..3).any(|a| node[a] + 1 >= samples.size[a]) {
        return None;
    }
    let value = |c: usize| {
        f64::from(
            samples.values[samples.index([node[0] + (c & 1), node[1] + (c >> 1 & 1), node[2] + (c >> 2)])],
        )
    };
    let values: [f64; 8] = std::array::from_fn(value);
    let (mut sum, mut count) = (Vec3::zeros(), 0.0);
    for c in 0..8usize {
        for a in (0..3).filter(|a| c >> a & 1 == 0) {
            let (v, w) = (values[c], values[c | 1 << a]);
            if (v > 0.0) != (w > 0.0) {
                let mut at = Vec3::new((c & 1) as f64, (c >> 1 & 1) as f64, (c >> 2) as f64);
                at[a] = v / (v - w);
                sum += at;
                count += 1.0;
            }
        }
    }
    (count > 0.0).then(|| samples.place(node) + sum / count * samples.step)
}

/// The two triangles around the edge from a node along an axis.
fn quad(samples: &Samples, index: usize, axis: usize, vertex: &[u32], mesh: &mut TriMesh) {
    let node = samples.node(index);
    let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
    if node[axis] + 1 >= samples.size[axis] || node[b] == 0 || node[c] == 0 {
        return;
    }
    let stride = [1, samples.size[0], samples.size[0] * samples.size[1]];
    let inside = samples.values[index] > 0.0;
    if inside == (samples.values[index + stride[axis]] > 0.0) {
        return;
    }
    // Anticlockwise as seen from the end of the axis.
    let cells = [index - stride[b] - stride[c], index - stride[c], index, index - stride[b]];
    let mut corners = cells.map(|cell| vertex[cell]);
    if corners.contains(&u32::MAX) {
        return;
    }
    if !inside {
        corners.reverse();
    }
    let at = corners.map(|v| mesh.vertices[v as usize]);
    let [p, q, r, s] = corners;
    // The shorter diagonal.
    if (at[0] - at[2]).norm_squared() <= (at[1] - at[3]).norm_squared() {
        mesh.faces.extend([[p, q, r], [p, r, s]]);
    } else {
        mesh.faces.extend([[q, r, s], [q, s, p]]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geom::Moments;

    fn sampled(cells: usize, distance: impl Fn(&Vec3) -> f64) -> Samples {
        let mut samples = Samples::over(&Vec3::repeat(-1.0), &Vec3::repeat(1.0), cells, 2, 0.0);
        for index in 0..samples.values.len() {
            samples.values[index] = distance(&samples.place(samples.node(index))) as f32;
        }
        samples
    }

    /// The volume of a ball comes out with the square of the step.
    #[test]
    fn a_ball_is_closed_and_has_its_volume() {
        let error = |cells: usize| {
            let mesh = surface(sampled(cells, |p| 0.81 - p.norm())).unwrap();
            let volume = Moments::of_mesh(&mesh).unwrap().volume;
            volume / (4.0 / 3.0 * std::f64::consts::PI * 0.81f64.powi(3)) - 1.0
        };
        let (coarse, fine) = (error(20), error(40));
        assert!(coarse.abs() < 0.02 && (coarse / fine - 4.0).abs() < 1.0, "{coarse} {fine}");
    }

    /// Random values have every critical pattern, and still give a manifold: each edge joins two faces and each vertex has one fan.
    #[test]
    fn noise_has_a_manifold_surface() {
        let mut random = geom::random::generator(1, 2, 3);
        let mut samples = sampled(12, |_| 0.0);
        for v in &mut samples.values {
            *v = (geom::random::unit(&mut random) - 0.6) as f32;
        }
        let mesh = surface(samples).unwrap();
        assert!(mesh.faces.len() > 1000);
        assert_eq!(mesh.open_edges(), 0);
        assert!(Moments::of_mesh(&mesh).is_ok() && mesh.volume() > 0.0);
        // Faces around a vertex, from one to the next across their common edges.
        let mut fans: Vec<Vec<[u32; 2]>> = vec![Vec::new(); mesh.vertices.len()];
        for f in &mesh.faces {
            (0..3).for_each(|k| fans[f[k] as usize].push([f[(k + 1) % 3], f[(k + 2) % 3]]));
        }
        for fan in fans {
            let (start, mut at, mut steps) = (fan[0][0], fan[0][1], 1);
            while at != start {
                at = fan.iter().find(|e| e[0] == at).unwrap()[1];
                steps += 1;
            }
            assert_eq!(steps, fan.len());
        }
    }

    #[test]
    fn nothing_inside_has_no_surface() {
        assert_eq!(surface(sampled(4, |_| -1.0)), None);
    }
}
