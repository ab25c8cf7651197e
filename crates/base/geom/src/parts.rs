//! Parts of a set whose members are joined two by two: disjoint sets.

/// Parts of the numbers 0, 1, 2, …; the root of a part is its lowest member.
#[derive(Debug, Clone)]
pub struct Parts(Vec<u32>);

impl Parts {
    /// So many numbers, each a part by itself.
    pub fn new(count: usize) -> Parts {
        Parts((0..count as u32).collect())
    }

    /// One more number, a part by itself.
    pub fn push(&mut self) {
        self.0.push(self.0.len() as u32);
    }

    /// The root of the part of `i` (path halving).
    pub fn root(&mut self, mut i: u32) -> u32 {
        while self.0[i as usize] != i {
            let up = self.0[self.0[i as usize] as usize];
            self.0[i as usize] = up;
            i = up;
        }
        i
    }

    /// Joins the parts of two numbers.
    pub fn join(&mut self, i: u32, j: u32) {
        let (a, b) = (self.root(i), self.root(j));
        self.0[a.max(b) as usize] = a.min(b);
    }

    /// How many parts there are.
    pub fn count(&self) -> usize {
        (0u32..).zip(&self.0).filter(|(i, up)| i == *up).count()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_are_the_lowest_members() {
        let mut parts = Parts::new(6);
        parts.push();
        [(5, 3), (6, 5), (1, 2), (2, 1)].into_iter().for_each(|(i, j)| parts.join(i, j));
        assert_eq!((0..7).map(|i| parts.root(i)).collect::<Vec<_>>(), [0, 1, 1, 3, 4, 3, 3]);
        assert_eq!(parts.count(), 4);
    }
}
