//! Turns the normals to the flow side.
//!
//! From the point whose normal agrees best with the direction of the flow side, neighbours take their side from each other, so that
//! the walls of a half pipe that lean past the vertical still face inwards. Every piece that hangs together starts anew.

use geom::Vec3;
use std::collections::VecDeque;

/// Normals turned to the side that `facing` points to.
pub fn oriented(normals: &[Vec3], pairs: &[(u32, u32)], facing: Vec3) -> Vec<Vec3> {
    let mut links = vec![Vec::new(); normals.len()];
    for &(i, j) in pairs {
        links[i as usize].push(j);
        links[j as usize].push(i);
    }
    let mut turned = normals.to_vec();
    let mut done = vec![false; normals.len()];
    let mut order: Vec<u32> = (0..normals.len() as u32).collect();
    let agreement = |i: u32| normals[i as usize].dot(&facing).abs();
    order.sort_by(|&a, &b| agreement(b).total_cmp(&agreement(a)).then(a.cmp(&b)));
    for start in order {
        if done[start as usize] {
            continue;
        }
        done[start as usize] = true;
        turn(&mut turned[start as usize], &facing);
        let mut queue = VecDeque::from([start]);
        while let Some(i) = queue.pop_front() {
            for &j in &links[i as usize] {
                if !done[j as usize] {
                    done[j as usize] = true;
                    let like = turned[i as usize];
                    turn(&mut turned[j as usize], &like);
                    queue.push_back(j);
                }
            }
        }
    }
    turned
}

/// A point on a line has no normal of its own and takes its neighbour's.
fn turn(normal: &mut Vec3, like: &Vec3) {
    if normal.norm_squared() == 0.0 {
        *normal = like.normalize();
    } else if normal.dot(like) < 0.0 {
        *normal = -*normal;
    }
}
