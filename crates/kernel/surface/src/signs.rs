use glam::Vec4;
use midair_field::{BRICK, Brick};

/// Which nodes of a brick lie inside: one word for each z, bit x + 8·y.
pub(crate) type Signs = [u64; BRICK];

/// What is known of a brick as a whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum State {
    Outside,
    Inside,
    Mixed,
}

/// The sign of every node of a brick. A node is inside if its value is finite and at most −`eps`:
/// zeros, and all that is not a number, count as outside.
pub(crate) fn signs(brick: &Brick, eps: f32) -> (State, Signs) {
    let Brick::Values { values, min, max } = brick else {
        return (State::Inside, [!0; BRICK]);
    };
    // Whoever reads this brick gets its signs from here, so that the surface stays closed even if
    // the summary does not tell the truth.
    if *min > -eps {
        return (State::Outside, [0; BRICK]);
    }
    if *max <= -eps && *min >= f32::MIN {
        return (State::Inside, [!0; BRICK]);
    }
    let (level, lowest) = (Vec4::splat(-eps), Vec4::splat(f32::MIN));
    let planes: &[[[f32; 4]; 16]; BRICK] = bytemuck::cast_ref(&**values);
    let words = planes.map(|plane| {
        let mut word = 0;
        for (i, quad) in plane.into_iter().enumerate() {
            let v = Vec4::from_array(quad);
            let inside = v.cmple(level) & v.cmpge(lowest);
            word |= u64::from(inside.bitmask()) << (4 * i);
        }
        word
    });
    let state = match words {
        w if w == [0; BRICK] => State::Outside,
        w if w == [!0; BRICK] => State::Inside,
        _ => State::Mixed,
    };
    (state, words)
}

/// The signs of the four lattice columns at the corners of every cell: (0,0), (1,0), (0,1), (1,1)
/// in x and y, for nine planes of nodes.
pub(crate) struct Corners(pub [[u64; 4]; BRICK + 1]);

const LOW_X: u64 = 0x0101_0101_0101_0101;

impl Corners {
    /// From the signs of a brick and its seven neighbours, in the order of a cell's corners.
    pub fn new(s: [&Signs; 8]) -> Self {
        Self(std::array::from_fn(|z| {
            let (d, z) = (4 * (z / BRICK), z % BRICK);
            let along_x = |a: u64, b: u64| (a >> 1 & !(LOW_X << 7)) | (b & LOW_X) << 7;
            let (s00, s01) = (s[d][z], s[d + 2][z]);
            let s10 = along_x(s00, s[d + 1][z]);
            let next = along_x(s01, s[d + 3][z]);
            [s00, s10, s00 >> 8 | s01 << 56, s10 >> 8 | next << 56]
        }))
    }

    /// The crossed edges that start at the brick's nodes, by axis.
    pub fn crossed(&self) -> [Signs; 3] {
        let p = &self.0;
        [
            std::array::from_fn(|z| p[z][0] ^ p[z][1]),
            std::array::from_fn(|z| p[z][0] ^ p[z][2]),
            std::array::from_fn(|z| p[z][0] ^ p[z + 1][0]),
        ]
    }

    /// The cells of plane `z` that the surface passes through.
    #[inline]
    pub fn active(&self, z: usize) -> u64 {
        let ([a, b, c, d], [e, f, g, h]) = (self.0[z], self.0[z + 1]);
        (a | b | c | d | e | f | g | h) & !(a & b & c & d & e & f & g & h)
    }

    /// The case of cell `bit` in plane `z`.
    #[inline]
    pub fn case(&self, z: usize, bit: u32) -> usize {
        let (p, q) = (&self.0[z], &self.0[z + 1]);
        let four = |p: &[u64; 4]| {
            (p[0] >> bit & 1)
                | (p[1] >> bit & 1) << 1
                | (p[2] >> bit & 1) << 2
                | (p[3] >> bit & 1) << 3
        };
        (four(p) | four(q) << 4) as usize
    }
}
