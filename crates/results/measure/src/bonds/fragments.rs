//! Fragments: grains that whole bonds join, directly or through others; a grain that no whole bond holds is one by itself.

use super::Bond;
use geom::Parts;
use std::collections::HashMap;

/// How many there are, and how large.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Fragments {
    /// Number of fragments; a grain without bonds, or whose bonds are all broken, is one, too.
    pub count: u64,
    /// Grains of the largest one.
    pub largest: u64,
}

impl Fragments {
    /// Of all grains, by id, and those that have bonds, whole or broken.
    pub fn of(grains: &[u64], bonds: &[Bond]) -> Fragments {
        let mut rows: HashMap<u64, u32> = HashMap::new();
        let mut row = |id: u64| {
            let next = rows.len() as u32;
            *rows.entry(id).or_insert(next)
        };
        grains.iter().for_each(|id| {
            row(*id);
        });
        let pairs: Vec<[u32; 2]> = bonds.iter().map(|b| b.grains.map(&mut row)).collect();
        let mut parts = Parts::new(rows.len());
        for (pair, _) in pairs.iter().zip(bonds).filter(|(_, b)| b.broken.is_none()) {
            parts.join(pair[0], pair[1]);
        }
        let mut size = vec![0; rows.len()];
        (0..rows.len() as u32).for_each(|grain| size[parts.root(grain) as usize] += 1);
        Fragments { count: parts.count() as u64, largest: size.into_iter().max().unwrap_or(0) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bonds::Break;

    #[test]
    fn a_chain_that_breaks_leaves_its_pieces() {
        let chain = |broken: &[u64]| -> Vec<Bond> {
            let at = |k: u64| broken.contains(&k).then_some(0.5);
            (0..9)
                .map(|k| Bond {
                    grains: [k, k + 1],
                    force: geom::Vec3::zeros(),
                    stress: [0.0; 2],
                    broken: at(k),
                    by: Break::Tension,
                })
                .collect()
        };
        let of = |broken: &[u64]| Fragments::of(&[], &chain(broken));
        assert_eq!(of(&[]), Fragments { count: 1, largest: 10 });
        assert_eq!(of(&[3]), Fragments { count: 2, largest: 6 });
        assert_eq!(of(&[3, 4]), Fragments { count: 3, largest: 5 });
        assert_eq!(Fragments::of(&[], &[]), Fragments::default());
        // Grains 3 and 20 are there; 20 has no bond.
        assert_eq!(Fragments::of(&[3, 20], &chain(&[3])), Fragments { count: 3, largest: 6 });
    }
}
