//! The grid against a search of all points.

use super::*;

/// Points of a small congruential generator, `spread` wide.
fn scatter(count: usize, spread: [f64; 3]) -> Vec<Vec3> {
    let mut state = 7u64;
    let mut next = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    (0..count).map(|_| Vec3::new(spread[0] * next(), spread[1] * next(), spread[2] * next())).collect()
}

/// A grid of rows, and grids of small and of large blocks.
fn kinds(points: &[Vec3], cell: f64) -> Vec<Grid> {
    let blocks = [1, 20, 10_000].map(|n| Grid::in_blocks(points, cell, n));
    [Grid::new(points, cell)].into_iter().chain(blocks).collect()
}

#[test]
fn within_finds_what_brute_force_finds_in_dense_and_sparse_grids() {
    for spread in [[1.0, 1.0, 1.0], [1.0, 1.0, 1e-9], [1.0, 0.0, 0.0], [400.0, 400.0, 400.0]] {
        let points = scatter(600, spread);
        for (cell, radius) in [(0.1, 0.1), (0.05, 0.13), (0.3, 0.1), (0.01, 0.02)] {
            for grid in kinds(&points, cell) {
                for &centre in points.iter().step_by(37).chain(&[Vec3::new(-5.0, 0.5, 0.5)]) {
                    let mut found: Vec<u32> = grid.within(&points, centre, radius).collect();
                    found.sort();
                    let near = |i: &u32| (points[*i as usize] - centre).norm() <= radius;
                    assert_eq!(found, (0..600).filter(near).collect::<Vec<u32>>());
                }
            }
        }
    }
}

#[test]
fn the_nearest_is_that_of_a_look_at_every_point() {
    let points = [scatter(300, [1.0, 1.0, 0.1]), vec![Vec3::repeat(0.5); 3]].concat();
    for grid in kinds(&points, 0.05) {
        for &p in points.iter().step_by(29).chain(&[Vec3::repeat(0.5), Vec3::new(900.0, -3.0, 0.0)]) {
            let p = p + Vec3::repeat(1e-3);
            let apart = |i: &u32| (points[*i as usize] - p).norm_squared();
            let all = (0..points.len() as u32).min_by(|a, b| apart(a).total_cmp(&apart(b)).then(a.cmp(b)));
            assert_eq!(grid.nearest(&points, p, 1e-3), all);
        }
    }
    assert_eq!(Grid::new(&points, 0.05).nearest(&points, Vec3::repeat(f64::NAN), 0.1), None);
}

/// Cells as for small grains, and a search as far as a large one reaches: rows longer than those that are searched cell by cell, and more rows than
/// points, of which one run of all is made.
#[test]
fn a_search_over_many_cells_costs_no_more_than_all_points() {
    let points = scatter(600, [400.0, 400.0, 0.02]);
    let grid = Grid::new(&points, 0.01);
    assert!(grid.dims()[0] > 10_000);
    for radius in [0.2, 1.0, 30.0, 1e3] {
        for &centre in points.iter().step_by(37) {
            let mut found: Vec<u32> = grid.within(&points, centre, radius).collect();
            found.sort();
            let near = |i: &u32| (points[*i as usize] - centre).norm() <= radius;
            assert_eq!(found, (0..600).filter(near).collect::<Vec<u32>>(), "{radius}");
        }
    }
    let all = std::iter::once(0..600);
    assert!(grid.runs_near(points[0], 30.0).eq(all));
    assert!(grid.runs_near(points[0], 0.2).count() <= 600);
}

#[test]
fn order_is_a_permutation_sorted_by_cell_then_index() {
    for spread in [[1.0; 3], [90.0; 3]] {
        let points = scatter(500, spread);
        for grid in kinds(&points, 0.2) {
            let keys: Vec<_> = grid
                .order()
                .iter()
                .map(|&i| (grid.lattice().key(grid.cell_of(&points[i as usize])), i))
                .collect();
            assert!(keys.is_sorted());
            assert_eq!(keys.len(), 500);
        }
    }
}

/// As many points as several threads sort: as one sort by cell and index, and the cells begin where they should.
#[test]
fn many_points_are_sorted_as_few() {
    let keys: Vec<u64> =
        scatter(200_000, [1000.0; 3]).iter().map(|p| (p.x as u64 / 7) * 7 + p.y as u64).collect();
    for cells in [2000, 1_500_000] {
        let (order, starts) = by_cell(&keys, cells);
        let mut expected: Vec<u32> = (0..keys.len() as u32).collect();
        expected.sort_by_key(|&i| (keys[i as usize], i));
        assert!(order == expected);
        let first = |cell: usize| expected.partition_point(|&i| keys[i as usize] < cell as u64) as u32;
        assert!(starts.len() == cells + 1 && (0..=cells).step_by(13).all(|cell| starts[cell] == first(cell)));
    }
}

/// Of a block's points, fewer have a neighbour elsewhere than of a slab's.
#[test]
fn blocks_are_cubes_that_fill_the_box() {
    assert_eq!(block_of([40, 40, 40], 1000.0), [10, 10, 10]);
    assert_eq!(block_of([2, 40, 40], 200.0), [2, 10, 10]);
    assert_eq!(block_of([40, 1, 3], 12.0), [4, 1, 3]);
    // 21 cells are three times seven, not twice ten and one.
    assert_eq!(block_of([21, 21, 21], 1000.0), [7, 11, 11]);
    assert_eq!(block_of([5, 5, 5], 0.01), [1, 1, 1]);
    assert_eq!(block_of([5, 6, 7], 1e9), [5, 6, 7]);
}

#[test]
fn no_point_and_one_point() {
    for none in kinds(&[], 1.0) {
        assert_eq!(none.within(&[], Vec3::zeros(), 1.0).count(), 0);
    }
    let one = [Vec3::new(1e9, 0.0, 0.0)];
    assert_eq!(Grid::new(&one, 1.0).within(&one, one[0], 0.0).count(), 1);
}

/// Blocks hold about as many evenly spread points as they are asked for, and together they cover all cells.
#[test]
fn blocks_hold_the_points_that_are_asked_for() {
    let extents = [[1.0, 1.0, 1.0], [4.0, 1.0, 0.5], [10.0, 0.3, 0.3], [0.2, 6.0, 3.0]];
    for (extent, points) in extents.into_iter().zip([200_000, 50_000, 1_000_000, 300_000]) {
        for wanted in [500, 4096, 20_000] {
            let low = Vec3::new(-3.0, 2.0, 7.0);
            let high = low + Vec3::from(extent);
            let lattice = lattice_over((low, high), 0.02, points, Some(wanted));
            let product = |of: [i64; 3]| of.iter().map(|&n| n as f64).product::<f64>();
            let share = product(lattice.block) / product(lattice.dims);
            let held = share * points as f64;
            assert!((0.4..2.5).contains(&(held / wanted as f64)), "{extent:?}, {wanted}: {held}");
            for axis in 0..3 {
                let beyond = lattice.dims[axis] as f64 * 0.02 - extent[axis];
                assert!((-1e-9..0.0201).contains(&beyond), "{extent:?}: {beyond} m beyond the box");
                let reach = lattice.block[axis] * lattice.blocks[axis];
                assert!(reach >= lattice.dims[axis], "{extent:?}, {wanted}: axis {axis}");
                assert!(
                    reach - lattice.dims[axis] < lattice.block[axis],
                    "{extent:?}, {wanted}: axis {axis}"
                );
            }
        }
    }
}
