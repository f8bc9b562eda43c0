//! The light of the air: computed here, from a few soft lamps, as the cubes that surfaces reflect.

use bevy::asset::RenderAssetUsages;
use bevy::prelude::*;
use bevy::render::render_resource::{
    Extent3d, TextureDimension, TextureFormat, TextureViewDescriptor, TextureViewDimension,
};

/// One soft lamp of a photographer's room: a lobe on the sphere.
struct Lamp {
    towards: Vec3,
    /// Of the lobe `exp(sharpness (cos − 1))`.
    sharpness: f32,
    /// Its light, linear.
    light: Vec3,
}

/// Overhead, at the horizon and underfoot, and what hangs there.
struct Air {
    gradient: [Vec3; 3],
    lamps: [Lamp; 3],
}

fn studio() -> Air {
    Air {
        gradient: [
            Vec3::new(0.62, 0.65, 0.70),
            Vec3::new(0.50, 0.51, 0.53),
            Vec3::new(0.24, 0.235, 0.23),
        ],
        lamps: [
            // A wide soft box above and to the left, where the key light comes from.
            Lamp {
                towards: Vec3::new(-0.45, 0.80, 0.42).normalize(),
                sharpness: 9.0,
                light: Vec3::new(2.3, 2.2, 2.05),
            },
            // A cooler one on the right, so that the dark side has an edge.
            Lamp {
                towards: Vec3::new(0.93, 0.25, -0.20).normalize(),
                sharpness: 12.0,
                light: Vec3::new(0.70, 0.78, 0.92),
            },
            // And one behind.
            Lamp {
                towards: Vec3::new(-0.25, 0.35, -0.90).normalize(),
                sharpness: 14.0,
                light: Vec3::new(0.85, 0.85, 0.85),
            },
        ],
    }
}

impl Air {
    /// The light from a direction as a lobe of `sharpness` gathers it: lobes fold into lobes, so nothing has
    /// to be sampled.
    fn gathered(&self, from: Vec3, sharpness: f32) -> Vec3 {
        let [high, middle, low] = self.gradient;
        // A gathered gradient is one that turns more slowly.
        let steep = 1.6 * sharpness / (sharpness + 3.0);
        let up = (steep * from.y).clamp(-1.0, 1.0);
        let towards = if up < 0.0 { low } else { high };
        let mut light = middle.lerp(towards, up.abs() * (2.0 - up.abs()));
        for lamp in &self.lamps {
            let folded = lamp.sharpness * sharpness / (lamp.sharpness + sharpness);
            let lobe = (folded * (from.dot(lamp.towards) - 1.0)).exp();
            light += lamp.light * (folded / lamp.sharpness * lobe);
        }
        light
    }
}

/// The cosine of a matte surface as a lobe.
const MATTE: f32 = 2.1;

/// Texels along an edge of what a smooth surface reflects.
const SIDE: u32 = 64;

/// What matte surfaces gather, and what shining ones reflect: finest first, one level per roughness.
pub(super) fn cubes() -> [Image; 2] {
    let air = studio();
    let levels = SIDE.ilog2() + 1;
    [
        cube(8, 1, |from, _| air.gathered(from, MATTE)),
        cube(SIDE, levels, |from, level| {
            let rough = level as f32 / (levels - 1) as f32;
            // Half the width of the highlights of GGX, twice reflected.
            let sharpness = 0.5 / rough.max(0.05).powi(4);
            air.gathered(from, sharpness.max(MATTE))
        }),
    ]
}

/// A cube with `levels` levels, `light(direction, level)` in each texel.
pub(super) fn cube(side: u32, levels: u32, light: impl Fn(Vec3, u32) -> Vec3) -> Image {
    let mut texels = Vec::new();
    for face in 0..6 {
        for level in 0..levels {
            let side = side >> level;
            for row in 0..side {
                for column in 0..side {
                    let [u, v] = [column, row].map(|i| 2.0 * (i as f32 + 0.5) / side as f32 - 1.0);
                    let towards = match face {
                        0 => Vec3::new(1.0, -v, -u),
                        1 => Vec3::new(-1.0, -v, u),
                        2 => Vec3::new(u, 1.0, v),
                        3 => Vec3::new(u, -1.0, -v),
                        4 => Vec3::new(u, -v, 1.0),
                        _ => Vec3::new(-u, -v, -1.0),
                    };
                    // Cubes are left-handed.
                    let towards = (towards * Vec3::new(1.0, 1.0, -1.0)).normalize();
                    let [red, green, blue] = light(towards, level).to_array();
                    for channel in [red, green, blue, 1.0] {
                        texels.extend(half(channel).to_le_bytes());
                    }
                }
            }
        }
    }
    let mut image = Image::new_uninit(
        Extent3d {
            width: side,
            height: side,
            depth_or_array_layers: 6,
        },
        TextureDimension::D2,
        // Eight bits would show as bands in so dark a gradient.
        TextureFormat::Rgba16Float,
        RenderAssetUsages::default(),
    );
    image.texture_descriptor.mip_level_count = levels;
    image.data = Some(texels);
    image.texture_view_descriptor = Some(TextureViewDescriptor {
        dimension: Some(TextureViewDimension::Cube),
        ..default()
    });
    image
}

/// A number in [2⁻¹⁴, 2¹⁶) as a binary16; smaller ones become 0.
fn half(x: f32) -> u16 {
    let bits = x.to_bits();
    let exponent = (bits >> 23) as i32 - 127 + 15;
    if exponent <= 0 {
        return 0;
    }
    // Rounded: a carry into the exponent is right.
    ((((exponent as u32) << 23 | bits & 0x7f_ffff) + 0x1000) >> 13) as u16
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halves() {
        assert_eq!(half(1.0), 0x3c00);
        assert_eq!(half(0.5), 0x3800);
        assert_eq!(half(0.333_25), 0x3555);
        assert_eq!(half(4.0), 0x4400);
        assert_eq!(half(0.0), 0);
    }

    #[test]
    fn light_comes_from_above_and_nothing_of_it_is_lost_in_rough_reflections() {
        let air = studio();
        let up = air.gathered(Vec3::Y, MATTE).element_sum();
        assert!(up > 1.5 * air.gathered(Vec3::NEG_Y, MATTE).element_sum());
        // The mean over the sphere is about the same, however wide it is gathered.
        let mean = |sharpness: f32| {
            let n = 4000;
            let turn = std::f32::consts::PI * (3.0 - 5.0_f32.sqrt());
            let total: f32 = (0..n)
                .map(|i| {
                    let y = 1.0 - 2.0 * (i as f32 + 0.5) / n as f32;
                    let r = (1.0 - y * y).sqrt();
                    let (sin, cos) = (turn * i as f32).sin_cos();
                    air.gathered(Vec3::new(r * cos, y, r * sin), sharpness).x
                })
                .sum();
            total / n as f32
        };
        let sharp = mean(1e4);
        for sharpness in [100.0, 20.0, MATTE] {
            assert!((mean(sharpness) / sharp - 1.0).abs() < 0.1, "{sharpness}");
        }
    }

    #[test]
    fn a_cube_has_every_texel_of_every_level() {
        let [matte, shine] = cubes();
        assert_eq!(matte.data.unwrap().len(), 8 * 8 * 6 * 8);
        assert_eq!(shine.texture_descriptor.mip_level_count, 7);
        let texels: usize = (0..7).map(|l| (64usize >> l).pow(2)).sum();
        assert_eq!(shine.data.unwrap().len(), texels * 6 * 8);
    }
}
