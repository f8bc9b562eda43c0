use glam::{IVec3, Vec3};
use midair_field::{Part, Program, TOGETHER};
use rustc_hash::FxHashMap;

/// In steps: the side of the cubes in which a program is thinned out.
const CUBE: f32 = 16.0;

/// A program, thinned out around some places.
pub(super) struct Near<'p> {
    program: &'p Program,
    side: f32,
    parts: FxHashMap<IVec3, Part<'p>>,
}

impl<'p> Near<'p> {
    pub fn new(program: &'p Program, places: impl Iterator<Item = Vec3>) -> Self {
        let side = CUBE * program.step();
        let half = 0.5 * side;
        let mut near = Self {
            program,
            side,
            parts: FxHashMap::default(),
        };
        let mut last = None;
        for p in places {
            let cube = near.cube(p);
            if last.replace(cube) != Some(cube) {
                let middle = cube.as_vec3() * side + half;
                let part = || program.part(middle, half);
                near.parts.entry(cube).or_insert_with(part);
            }
        }
        near
    }

    pub fn step(&self) -> f32 {
        self.program.step()
    }

    pub fn at(&self, p: Vec3) -> f32 {
        match self.parts.get(&self.cube(p)) {
            Some(part) => part.at(p),
            None => self.program.at(p),
        }
    }

    /// At points that lie less than a step from the first.
    pub fn at_all(&self, points: &[Vec3; TOGETHER]) -> [f32; TOGETHER] {
        match self.parts.get(&self.cube(points[0])) {
            Some(part) => part.at_all(points),
            None => self.program.at_all(points),
        }
    }

    fn cube(&self, p: Vec3) -> IVec3 {
        (p / self.side).floor().as_ivec3()
    }
}
