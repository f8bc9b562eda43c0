//! Small pictures of solids, drawn without a graphics card: the same on every machine.

use std::sync::atomic::AtomicBool;

use glam::{Mat3, Vec2, Vec3};
use midair_field::{MeshSource, Placement, Recipe};
use midair_mesh::TriMesh;

use crate::{SolidError, surface_of};

/// Samples along each side of a pixel.
const SAMPLES: usize = 3;
/// How much of the picture's width the solid may take.
const FILL: f32 = 0.86;

/// A picture with a transparent ground: red, green, blue, alpha, not premultiplied, sRGB.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Thumbnail {
    /// Pixels along each side.
    pub size: usize,
    /// Rows from the top, four bytes a pixel.
    pub rgba: Vec<u8>,
}

impl Thumbnail {
    /// A solid from the front, a little from above and the right, lit from the upper left, as large
    /// as fits.
    ///
    /// # Errors
    ///
    /// The recipe cannot be evaluated, or `cancel` was set.
    pub fn of(
        recipe: &Recipe,
        size: usize,
        meshes: &dyn MeshSource,
        cancel: &AtomicBool,
    ) -> Result<Self, SolidError> {
        let bounds = recipe.bounds();
        let extent = if bounds.is_empty() {
            0.1
        } else {
            bounds.size().max_element()
        };
        // Finer than its pixels.
        let step = (extent / 72.0).clamp(1e-4, 1.0);
        let mesh = surface_of(recipe, &Placement::IDENTITY, step, meshes, cancel)?;
        Ok(Self::of_mesh(&mesh, size))
    }

    /// The same of a mesh. One without triangles gives an empty picture.
    pub fn of_mesh(mesh: &TriMesh, size: usize) -> Self {
        let side = size * SAMPLES;
        let view = view();
        let placed: Vec<Vec3> = mesh.positions.iter().map(|p| view * *p).collect();
        let (low, high) = placed
            .iter()
            .filter(|p| p.is_finite())
            .fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(l, h), p| {
                (l.min(*p), h.max(*p))
            });
        let middle = low.midpoint(high);
        let scale = FILL * side as f32 / (high - low).truncate().max_element().max(1e-9);
        let mut canvas = Canvas::new(side);
        for corners in &mesh.triangles {
            let at = corners.map(|c| {
                let p = (placed[c as usize] - middle) * scale;
                Vec3::new(p.x + 0.5 * side as f32, 0.5 * side as f32 - p.y, p.z)
            });
            let flat = (placed[corners[1] as usize] - placed[corners[0] as usize])
                .cross(placed[corners[2] as usize] - placed[corners[0] as usize]);
            let normals = corners.map(|c| {
                mesh.normals
                    .get(c as usize)
                    .map_or(flat, |n| view * *n)
                    .normalize_or(Vec3::Z)
            });
            canvas.triangle(at, normals);
        }
        canvas.reduced(size)
    }
}

/// From the world to the eye: x right, y up, z towards it.
fn view() -> Mat3 {
    let back = Vec3::new(0.62, 0.5, 1.0).normalize();
    let right = Vec3::Y.cross(back).normalize();
    Mat3::from_cols(right, back.cross(right), back).transpose()
}

struct Canvas {
    side: usize,
    depth: Vec<f32>,
    /// Linear light.
    light: Vec<f32>,
}

impl Canvas {
    fn new(side: usize) -> Self {
        Self {
            side,
            depth: vec![f32::NEG_INFINITY; side * side],
            light: vec![0.0; side * side],
        }
    }

    fn triangle(&mut self, at: [Vec3; 3], normals: [Vec3; 3]) {
        if !at.iter().all(|p| p.is_finite()) {
            return;
        }
        let flat = at.map(Vec3::truncate);
        let area = (flat[1] - flat[0]).perp_dot(flat[2] - flat[0]);
        // y runs down: what faces the eye turns the other way. Open meshes show their backs too.
        if area.abs() < 1e-9 {
            return;
        }
        let low = flat[0].min(flat[1]).min(flat[2]).floor().max(Vec2::ZERO);
        let high = flat[0]
            .max(flat[1])
            .max(flat[2])
            .ceil()
            .min(Vec2::splat(self.side as f32));
        for y in low.y as usize..high.y as usize {
            for x in low.x as usize..high.x as usize {
                let p = Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
                let weight = |a: Vec2, b: Vec2| (b - a).perp_dot(p - a) / area;
                let w = [
                    weight(flat[1], flat[2]),
                    weight(flat[2], flat[0]),
                    weight(flat[0], flat[1]),
                ];
                if w.iter().any(|w| *w < 0.0) {
                    continue;
                }
                let depth = w[0] * at[0].z + w[1] * at[1].z + w[2] * at[2].z;
                let i = y * self.side + x;
                if depth > self.depth[i] {
                    let n = normals[0] * w[0] + normals[1] * w[1] + normals[2] * w[2];
                    self.depth[i] = depth;
                    self.light[i] = shade(n.normalize_or(Vec3::Z));
                }
            }
        }
    }

    fn reduced(&self, size: usize) -> Thumbnail {
        let mut rgba = Vec::with_capacity(size * size * 4);
        for y in 0..size {
            for x in 0..size {
                let (mut light, mut hits) = (0.0, 0);
                for i in 0..SAMPLES * SAMPLES {
                    let at = (y * SAMPLES + i / SAMPLES) * self.side + x * SAMPLES + i % SAMPLES;
                    if self.depth[at] > f32::NEG_INFINITY {
                        light += self.light[at];
                        hits += 1;
                    }
                }
                let light = light / hits.max(1) as f32;
                // Chalk that reads on a dark panel and on a light one.
                let colour = Vec3::new(0.60, 0.57, 0.53) * light;
                rgba.extend(colour.to_array().map(|c| (srgb(c) * 255.0).round() as u8));
                rgba.push((255 * hits / (SAMPLES * SAMPLES)) as u8);
            }
        }
        Thumbnail { size, rgba }
    }
}

/// A key light from the upper left, the sky, what the ground gives back, and a rim.
fn shade(normal: Vec3) -> f32 {
    let normal = if normal.z < 0.0 { -normal } else { normal };
    let key = Vec3::new(-0.45, 0.7, 0.6).normalize();
    let lit = normal.dot(key).max(0.0);
    let sky = 0.5 + 0.5 * normal.y;
    let rim = (1.0 - normal.z).powi(3);
    0.16 + 0.92 * lit + 0.22 * sky + 0.12 * rim
}

fn srgb(linear: f32) -> f32 {
    let c = linear.clamp(0.0, 1.0);
    if c <= 0.003_130_8 {
        12.92 * c
    } else {
        1.055 * c.powf(1.0 / 2.4) - 0.055
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use midair_field::Primitive;

    fn ball() -> Thumbnail {
        let ball: Recipe = Primitive::Sphere { radius: 0.1 }.into();
        Thumbnail::of(&ball, 64, &(), &AtomicBool::new(false)).unwrap()
    }

    #[test]
    fn a_ball_is_a_disc_in_the_middle_lit_from_above() {
        let picture = ball();
        assert_eq!(picture.rgba.len(), 64 * 64 * 4);
        let pixel = |x: usize, y: usize| &picture.rgba[(y * 64 + x) * 4..][..4];
        assert_eq!(pixel(0, 0)[3], 0);
        assert_eq!(pixel(32, 32)[3], 255);
        assert!(pixel(24, 16)[0] > pixel(40, 52)[0] + 30);
        let covered = picture.rgba.chunks(4).filter(|p| p[3] > 127).count() as f32;
        let disc = std::f32::consts::PI * (0.43 * 64.0_f32).powi(2);
        assert!((covered / disc - 1.0).abs() < 0.05, "{covered} {disc}");
    }

    #[test]
    fn the_same_solid_gives_the_same_picture() {
        assert_eq!(ball(), ball());
    }

    #[test]
    fn nothing_is_an_empty_picture() {
        let empty = Thumbnail::of_mesh(&TriMesh::default(), 16);
        assert!(empty.rgba.chunks(4).all(|p| p[3] == 0));
    }
}
