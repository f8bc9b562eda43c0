//! Letters as meshes: laid out as on a panel, printed from one page of glyphs.

use bevy::asset::RenderAssetUsages;
use bevy::mesh::{Indices, PrimitiveTopology};
use bevy::prelude::*;
use bevy::render::render_resource::{Extent3d, TextureDimension, TextureFormat};
use midair_studio::panel::egui::{
    self, Color32, ColorImage, FontId, ImageData, LayerId, Pos2, Rect, Stroke, StrokeKind,
    TextureId, epaint::Primitive,
};
use midair_studio::panel::{self, Palette};
use midair_studio::settings::{LookSettings, RoomKind};

use super::{Label, Weight};

/// Texels of a glyph per point.
const TEXELS: f32 = 2.5;
/// Points of a letter.
const SIZE: f32 = 14.0;
/// Points around the text.
const PAD: egui::Vec2 = egui::vec2(10.0, 5.0);

/// The page of glyphs and how text is laid out.
#[derive(Default)]
pub(super) struct Letters {
    ctx: egui::Context,
    page: ColorImage,
    image: Handle<Image>,
    /// How often all of the page was made anew: what was printed before has its letters elsewhere.
    print: u32,
    begun: bool,
}

impl Letters {
    /// The print that labels are of; those of an earlier one are printed again.
    pub fn print(&self) -> u32 {
        self.print
    }

    /// The page as the renderer takes it.
    pub fn page(&mut self, images: &mut Assets<Image>) -> Handle<Image> {
        let [width, height] = self.page.size;
        let texels = self
            .page
            .pixels
            .iter()
            .flat_map(Color32::to_array)
            .collect();
        let image = Image::new(
            Extent3d {
                width: width.max(1) as u32,
                height: height.max(1) as u32,
                depth_or_array_layers: 1,
            },
            TextureDimension::D2,
            if width * height == 0 {
                vec![0; 4]
            } else {
                texels
            },
            TextureFormat::Rgba8UnormSrgb,
            RenderAssetUsages::RENDER_WORLD,
        );
        self.image = images.add(image);
        self.image.clone()
    }

    /// A label about its middle, a unit for each point; says whether the page changed.
    pub fn print_label(&mut self, label: &Label, dark: bool) -> (Mesh, bool) {
        let mut changed = false;
        if !self.begun {
            self.begun = true;
            panel::install_fonts(&self.ctx);
            let output = self.ctx.run_ui(egui::RawInput::default(), |_| {});
            changed |= self.take(output.textures_delta);
            panel::apply_style(&self.ctx, &LookSettings::default());
            self.ctx.set_zoom_factor(1.0);
        }
        let palette = Palette::of_room(if dark { RoomKind::Dusk } else { RoomKind::Day });
        let colour = match label.weight {
            Weight::Plain => palette.text,
            Weight::Warning => palette.warn,
        };
        let mut input = egui::RawInput {
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, egui::Vec2::splat(2000.0))),
            ..Default::default()
        };
        input
            .viewports
            .entry(egui::ViewportId::ROOT)
            .or_default()
            .native_pixels_per_point = Some(TEXELS);
        let mut size = egui::Vec2::ZERO;
        let output = self.ctx.run_ui(input, |ui| {
            let painter = ui.ctx().layer_painter(LayerId::background());
            let font = FontId::proportional(SIZE);
            let galley = painter.layout(label.text.clone(), font, colour, label.wrap);
            size = galley.size() + 2.0 * PAD;
            let edge = Stroke::new(1.5, label.edge.unwrap_or(palette.line));
            let plate = Rect::from_min_size(Pos2::ZERO, size);
            painter.rect(
                plate,
                6.0,
                palette.panel.gamma_multiply(0.92),
                edge,
                StrokeKind::Inside,
            );
            painter.galley(Pos2::ZERO + PAD, galley, colour);
        });
        changed |= self.take(output.textures_delta);
        let jobs = self.ctx.tessellate(output.shapes, TEXELS);
        let mut positions = Vec::new();
        let mut uvs = Vec::new();
        let mut colours = Vec::new();
        let mut indices = Vec::new();
        for job in jobs {
            let Primitive::Mesh(mesh) = job.primitive else {
                continue;
            };
            let first = positions.len() as u32;
            for vertex in &mesh.vertices {
                let at = vertex.pos - 0.5 * size;
                positions.push([at.x, -at.y, 0.0]);
                uvs.push([vertex.uv.x, vertex.uv.y]);
                colours.push(vertex.color.to_array().map(|c| f32::from(c) / 255.0));
            }
            indices.extend(mesh.indices.iter().map(|i| first + i));
        }
        let normals = vec![[0.0, 0.0, 1.0]; positions.len()];
        let mesh = Mesh::new(
            PrimitiveTopology::TriangleList,
            RenderAssetUsages::RENDER_WORLD,
        )
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, normals)
        .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, uvs)
        .with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, colours)
        .with_inserted_indices(Indices::U32(indices));
        (mesh, changed)
    }

    /// Takes new glyphs onto the page.
    fn take(&mut self, mut delta: egui::TexturesDelta) -> bool {
        let mut changed = false;
        for (id, parts) in delta.set.drain() {
            if id != TextureId::Managed(0) {
                continue;
            }
            for part in parts {
                let ImageData::Color(image) = &part.image;
                changed = true;
                match part.pos {
                    None => {
                        self.page = (**image).clone();
                        self.print += 1;
                    }
                    Some([left, top]) => {
                        let [width, height] = image.size;
                        let stride = self.page.size[0];
                        for row in 0..height {
                            let to = (top + row) * stride + left;
                            let from = row * width;
                            if let (Some(to), Some(from)) = (
                                self.page.pixels.get_mut(to..to + width),
                                image.pixels.get(from..from + width),
                            ) {
                                to.copy_from_slice(from);
                            }
                        }
                    }
                }
            }
        }
        delta.clear();
        changed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_label_is_printed_about_its_middle_and_new_glyphs_keep_the_old_ones() {
        let mut letters = Letters::default();
        let label = |text: &str| Label {
            text: text.to_owned(),
            ..Label::default()
        };
        let (mesh, changed) = letters.print_label(&label("fuse 3"), true);
        assert!(changed);
        let positions = mesh.attribute(Mesh::ATTRIBUTE_POSITION).unwrap();
        let positions = positions.as_float3().unwrap();
        let (low, high) = positions.iter().fold((Vec3::MAX, Vec3::MIN), |(a, b), p| {
            (a.min((*p).into()), b.max((*p).into()))
        });
        assert!((low + high).abs().max_element() < 1.5, "{low} {high}");
        assert!(high.x - low.x > 40.0 && high.y - low.y > 20.0);
        let (_, again) = letters.print_label(&label("fuse 3"), true);
        assert!(!again, "the same letters are on the page");
        let ink = letters.page.pixels.iter().filter(|c| c.a() > 0).count();
        let (_, more) = letters.print_label(&label("Ω × ∪"), true);
        assert!(more);
        assert!(letters.page.pixels.iter().filter(|c| c.a() > 0).count() > ink);
    }
}
