//! Walls across periodic faces: each acts with all its images, one period away along every periodic axis.
//!
//! A wall that moves far is counted back into the box by whole periods, those of the step of listing: a conveyor may run
//! for ever. A plane has images along the axes that cross it; it is the same in all others. Which image a contact belongs
//! to stands in its partner: number of the part + image × parts. When a particle comes back through the other face, or a wall is
//! counted back, the same contact has another image ([`WallImages::before`]).

use primitives::Vec3;

/// An image: a digit of base 3 for each axis, 0, 1 or 2 = −1 periods.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Image(pub u32);

/// Whole periods along x, y, z.
pub type Periods = [i32; 3];

impl Image {
    #[inline(always)]
    fn of(periods: Periods) -> Image {
        let [x, y, z] = periods.map(|n| n.rem_euclid(3) as u32);
        Image(x + 3 * y + 9 * z)
    }

    #[inline(always)]
    fn periods(self) -> Periods {
        let digit = |d: u32| [0, 1, -1][(d % 3) as usize];
        [digit(self.0), digit(self.0 / 3), digit(self.0 / 9)]
    }

    /// Where the image is, away from the wall [m].
    #[inline(always)]
    pub fn shift(self, period: &Vec3) -> Vec3 {
        if self.0 == 0 {
            return Vec3::zeros();
        }
        let n = self.periods();
        Vec3::new(n[0] as f64 * period.x, n[1] as f64 * period.y, n[2] as f64 * period.z)
    }
}

/// Which images of a wall particles may touch.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct WallImages {
    /// Lengths of the box [m]; 0 along an open axis.
    pub period: Vec3,
    /// Lowest corner of the wall [m]; NaN along an axis that lies in it.
    pub lo: Vec3,
    /// Highest corner [m].
    pub hi: Vec3,
}

impl WallImages {
    /// Whether images lie along axis `a`. Written so that NaN, a plane along this axis, has none.
    #[inline(always)]
    fn repeats(&self, a: usize) -> bool {
        self.period[a] > 0.0 && self.lo[a] < f64::INFINITY
    }

    /// Which image `now` was before a particle was moved, and the wall counted back, by so many periods more. Along an axis without images all periods are
    /// the same contact.
    #[inline(always)]
    pub fn before(&self, now: Image, particle: Periods, wall: Periods) -> Image {
        let now = now.periods();
        Image::of([0, 1, 2].map(|a| if self.repeats(a) { now[a] - particle[a] + wall[a] } else { 0 }))
    }

    /// Images near a particle at `p` that reaches so far [m]; the wall itself first.
    #[inline(always)]
    pub fn near(&self, p: &Vec3, reach: f64) -> impl Iterator<Item = (Image, Vec3)> {
        let mut digits = [(1, [0, 0, 0]); 3];
        for a in 0..3 {
            if self.repeats(a) {
                let (count, list) = &mut digits[a];
                if p[a] + reach > self.lo[a] + self.period[a] {
                    list[*count] = 1;
                    *count += 1;
                }
                if p[a] - reach < self.hi[a] - self.period[a] {
                    list[*count] = -1;
                    *count += 1;
                }
            }
        }
        let period = self.period;
        let [x, y, z] = digits;
        let all = (0..z.0).flat_map(move |k| (0..y.0).flat_map(move |j| (0..x.0).map(move |i| (i, j, k))));
        all.map(move |(i, j, k)| {
            let image = Image::of([x.1[i], y.1[j], z.1[k]]);
            (image, image.shift(&period))
        })
    }
}
