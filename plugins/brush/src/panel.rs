//! The panel: brushes, eraser, size, strength, blending, the volume shelf, the strokes.

use std::collections::HashMap;

use bevy::prelude::World;
use midair_field::{Canvas, HARD, Recipe, RecipeHash, Skeleton, Stroke};
use midair_studio::{
    command::Command,
    document::{Object, ObjectId},
    evaluate::Evaluations,
    hands::Hands,
    materials::MaterialShelf,
    panel::{
        MaterialRows, Panel, choose, egui,
        egui::{
            ColorImage, RichText, ScrollArea, Sense, Slider, TextureHandle, TextureOptions, Ui,
            Vec2, vec2,
        },
        icon,
        kit::{empty, field, icon_button, search, strong},
    },
    project::{Picture, Places, Project, Selection, Shelf, Thumbnails},
    settings::{BrushSettings, BrushSkeleton, Settings},
    units,
};

use crate::{
    ask::Ask,
    easel::{Easel, canvas},
    stroke,
};

/// The shelf of volume brushes in the library.
const SHELF: &str = "Brushes";
/// Strokes that the list shows at once; the latest first.
const LISTED: usize = 400;

/// What the panel holds between frames.
#[derive(Default)]
pub(crate) struct BrushPanel {
    textures: HashMap<RecipeHash, TextureHandle>,
    /// Where those pictures are: each host has its own.
    host: Option<egui::Context>,
    /// What is typed to find a brush.
    query: String,
    /// A weight while its slider is dragged.
    weight: Option<(usize, f32)>,
    material: MaterialRows,
}

impl Panel for BrushPanel {
    fn show(&mut self, ui: &mut Ui, world: &World, asks: &mut Vec<Command>) {
        let settings = world.resource::<Settings>();
        let brush = settings.brush.sound();
        let easel = world.resource::<Easel>();
        let document = world.resource::<Project>().document();
        let painting = easel.painting(document);
        ScrollArea::vertical()
            .auto_shrink([false, true])
            .show(ui, |ui| {
                skeletons(ui, &brush, asks);
                let scale = world.resource::<Hands>().metres_per_world;
                sizes(ui, &brush, settings, scale, asks);
                if brush.skeleton == BrushSkeleton::Volume {
                    self.shelf(ui, world, &brush, asks);
                }
                ui.separator();
                blending(ui, &brush, easel, painting.map(|(_, _, c)| c), asks);
                ui.separator();
                on(
                    ui,
                    world,
                    painting.map(|(id, o, _)| (id, o.name.as_str())),
                    asks,
                );
                ui.separator();
                self.material(ui, world, &brush, painting.map(|(id, o, _)| (id, o)), asks);
                if let Some((_, _, canvas)) = painting {
                    ui.separator();
                    let shelf = world.resource::<Shelf>();
                    self.strokes(ui, (easel, shelf), canvas, asks);
                }
            });
    }
}

fn skeletons(ui: &mut Ui, brush: &BrushSettings, asks: &mut Vec<Command>) {
    ui.horizontal(|ui| {
        for kind in BrushSkeleton::ALL {
            let (glyph, does) = match kind {
                BrushSkeleton::Point => (icon::CIRCLE, "Point: a ball, or the way it is led"),
                BrushSkeleton::Line => (icon::LINE_SEGMENT, "Line between two points"),
                BrushSkeleton::Polygon => (icon::POLYGON, "Area with four corners or more"),
                BrushSkeleton::Volume => (icon::HORSE, "Volume: a solid as a brush"),
            };
            if icon_button(ui, glyph, does, brush.skeleton == kind).clicked() {
                asks.push(Settings::command("brush.skeleton", kind));
            }
        }
        ui.add_space(8.0);
        if icon_button(ui, icon::ERASER, "Erase: strokes take away", brush.erase).clicked() {
            asks.push(Settings::command("brush.erase", !brush.erase));
        }
    });
}

/// `scale`: metres of the room a metre of the work is shown as. A brush keeps its size in the hand; what is told is
/// its size in the work.
fn sizes(
    ui: &mut Ui,
    brush: &BrushSettings,
    settings: &Settings,
    scale: f32,
    asks: &mut Vec<Command>,
) {
    let unit = settings.units.length;
    let (key, mut value, (least, most), what) = match brush.skeleton {
        BrushSkeleton::Volume => ("brush.size", brush.size, BrushSettings::SIZES, "Size"),
        _ => ("brush.radius", brush.radius, BrushSettings::RADII, "Radius"),
    };
    let slider = Slider::new(&mut value, least..=most)
        .logarithmic(true)
        .custom_formatter(move |v, _| units::length(v as f32 / scale, unit))
        .custom_parser(move |text| Some(f64::from(units::metres(text, unit)? * scale)));
    if field(ui, what, slider).changed() {
        asks.push(Settings::command(key, value));
    }
    let mut strength = brush.strength;
    let slider = Slider::new(&mut strength, 0.1..=10.0).logarithmic(true);
    let changed = field(ui, "Strength", slider)
        .on_hover_text("The weight of a stroke: above 1 it stands out and melts farther")
        .changed();
    if changed {
        asks.push(Settings::command("brush.strength", strength));
    }
}

fn blending(
    ui: &mut Ui,
    brush: &BrushSettings,
    easel: &Easel,
    painting: Option<&Canvas>,
    asks: &mut Vec<Command>,
) {
    let (mut blend, mut reach) = easel
        .mix
        .or(painting.map(|c| (c.blend, c.reach)))
        .unwrap_or((brush.blend, brush.reach));
    let slider = Slider::new(&mut blend, 1.0..=HARD)
        .logarithmic(true)
        .fixed_decimals(1);
    let first = field(ui, "Blend", slider)
        .on_hover_text("1: strokes melt into each other; 16: they are united as they are");
    let slider = Slider::new(&mut reach, 1.05..=3.0).fixed_decimals(2);
    let second = field(ui, "Reach", slider)
        .on_hover_text("How far strokes feel each other, as a multiple of their radius");
    let changed = first.changed() || second.changed();
    let dragged = first.dragged() || second.dragged();
    let ended = first.drag_stopped() || second.drag_stopped();
    if changed || ended {
        let done = ended || !dragged;
        asks.push(Ask::Mix { blend, reach, done }.command());
    }
}

/// What is painted on, and what else could be.
fn on(
    ui: &mut Ui,
    world: &World,
    painting: Option<(midair_document::ObjectId, &str)>,
    asks: &mut Vec<Command>,
) {
    let document = world.resource::<Project>().document();
    let selection = &world.resource::<Selection>().0;
    ui.horizontal_wrapped(|ui| {
        match painting {
            Some((_, name)) => ui.label(strong(name)),
            None => ui.weak("The next stroke begins a painting."),
        };
        if painting.is_some() && ui.button(format!("{}  New", icon::PLUS)).clicked() {
            asks.push(Ask::New.command());
        }
    });
    let links = painting.and_then(|(id, _)| Some(&document.object(id)?.links));
    if let Some(links) = links.filter(|l| !l.is_empty()) {
        let mut names: Vec<&str> = links
            .iter()
            .filter_map(|l| Some(&*document.object(l.source)?.name))
            .collect();
        names.sort_unstable();
        names.dedup();
        ui.horizontal_wrapped(|ui| {
            ui.label(format!("Follows {}", names.join(" and ")));
            if ui.button("Free it").clicked() {
                asks.push(Ask::Free.command());
            }
        });
    }
    if let [id] = selection[..]
        && painting.is_none_or(|(p, _)| p != id)
        && let Some(object) = document.object(id)
    {
        let does = if canvas(object).is_some() {
            format!("Go on with {}", object.name)
        } else {
            format!("Paint on {}", object.name)
        };
        if ui.button(does).clicked() {
            asks.push(Ask::PaintOn(id.0).command());
        }
    }
}

impl BrushPanel {
    fn shelf(
        &mut self,
        ui: &mut Ui,
        world: &World,
        brush: &BrushSettings,
        asks: &mut Vec<Command>,
    ) {
        let shelf = world.resource::<Shelf>();
        let easel = world.resource::<Easel>();
        let wide = ui.available_width();
        search(ui, &mut self.query, "Any solid of the library", wide);
        let found: Vec<_> = if self.query.trim().is_empty() {
            let own = shelf.library.categories().find(|(c, _)| *c == SHELF);
            own.map_or(Vec::new(), |(_, c)| c.iter().collect())
        } else {
            shelf.library.search(&self.query)
        };
        let gap = 4.0;
        let room = ui.available_width() - 4.0;
        let columns = ((room + gap) / (60.0 + gap)).floor().max(1.0);
        let side = (room + gap) / columns - gap;
        ScrollArea::vertical()
            .id_salt("volume brushes")
            .max_height(3.6 * (side + gap))
            .show(ui, |ui| {
                ui.spacing_mut().item_spacing = vec2(gap, gap);
                ui.horizontal_wrapped(|ui| {
                    if let Some((name, recipe)) = &easel.carried {
                        let on = brush.volume.is_empty();
                        if self.tile(ui, world, name, recipe, side, on) {
                            asks.push(Ask::Carried.command());
                        }
                    }
                    for component in found.iter().filter(|c| !c.missing).take(240) {
                        let on = brush.volume == component.id;
                        if self.tile(ui, world, &component.name, &component.recipe, side, on) {
                            asks.push(Ask::Volume(component.id.clone()).command());
                        }
                    }
                });
            });
        if world.resource::<Thumbnails>().is_busy() {
            ui.ctx().request_repaint();
        }
    }

    /// A picture to choose; whether it was.
    fn tile(
        &mut self,
        ui: &mut Ui,
        world: &World,
        name: &str,
        recipe: &Recipe,
        side: f32,
        on: bool,
    ) -> bool {
        let (rect, response) = ui.allocate_exact_size(Vec2::splat(side), Sense::click());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Button, true, name));
        if ui.is_rect_visible(rect) {
            let visuals = ui.style().interact_selectable(&response, on);
            let edge = if on || response.has_focus() {
                egui::Stroke::new(2.0, midair_studio::panel::ACCENT)
            } else {
                egui::Stroke::NONE
            };
            ui.painter().rect(
                rect,
                6.0,
                visuals.weak_bg_fill,
                edge,
                egui::StrokeKind::Inside,
            );
            if let Some(texture) = self.texture(ui, world, name, recipe) {
                let whole = egui::Rect::from_min_max(egui::pos2(0.0, 0.0), egui::pos2(1.0, 1.0));
                ui.painter()
                    .image(texture, rect.shrink(3.0), whole, egui::Color32::WHITE);
            }
        }
        response.on_hover_text(name).clicked()
    }

    fn texture(
        &mut self,
        ui: &Ui,
        world: &World,
        name: &str,
        recipe: &Recipe,
    ) -> Option<egui::TextureId> {
        if self.host.as_ref() != Some(ui.ctx()) {
            self.textures.clear();
            self.host = Some(ui.ctx().clone());
        }
        if let Some(texture) = self.textures.get(&recipe.hash()) {
            return Some(texture.id());
        }
        let volumes = &world.resource::<Evaluations>().volumes;
        let cache = world.resource::<Places>().library.thumbnails();
        let Picture::Here(picture) = world.resource::<Thumbnails>().get(recipe, volumes, &cache)
        else {
            return None;
        };
        let image = ColorImage::from_rgba_unmultiplied([picture.size; 2], &picture.rgba);
        let texture = ui
            .ctx()
            .load_texture(format!("brush {name}"), image, TextureOptions::LINEAR);
        Some(self.textures.entry(recipe.hash()).or_insert(texture).id())
    }

    /// What the painting is made of; of the next one where there is none.
    fn material(
        &mut self,
        ui: &mut Ui,
        world: &World,
        brush: &BrushSettings,
        painting: Option<(ObjectId, &Object)>,
        asks: &mut Vec<Command>,
    ) {
        let shelf = world.resource::<MaterialShelf>();
        match painting {
            Some((id, object)) => {
                let mut ask = Vec::new();
                self.material.show(ui, shelf, object, &[id], &mut ask);
                asks.extend(ask.into_iter().map(Command::Objects));
            }
            None => {
                let now = Some(brush.material.as_str());
                if let Some(info) = choose(ui, shelf, now) {
                    asks.push(Settings::command("brush.material", info.id.clone()));
                }
            }
        }
    }

    fn strokes(
        &mut self,
        ui: &mut Ui,
        (easel, shelf): (&Easel, &Shelf),
        canvas: &Canvas,
        asks: &mut Vec<Command>,
    ) {
        ui.horizontal(|ui| {
            ui.label(strong(format!("Strokes {}", canvas.strokes.len())));
            let does = "Pick: the next press in the view selects a stroke";
            if icon_button(ui, icon::CURSOR_CLICK, does, easel.picking).clicked() {
                asks.push(Ask::Pick.command());
            }
        });
        if canvas.strokes.is_empty() {
            empty(ui, "Every stroke is listed here.");
            return;
        }
        if let Some(at) = easel.selected
            && let Some(stroke) = canvas.strokes.get(at)
        {
            self.selected(ui, at, stroke, asks);
        }
        ScrollArea::vertical()
            .id_salt("strokes")
            .max_height(220.0)
            .auto_shrink([false, true])
            .show_rows(ui, 20.0, canvas.strokes.len().min(LISTED), |ui, rows| {
                for row in rows {
                    let at = canvas.strokes.len() - 1 - row;
                    let stroke = &canvas.strokes[at];
                    let called = stroke::called(stroke, shelf);
                    let text = format!("{}  {called} {}", glyph(stroke), at + 1);
                    let on = easel.selected == Some(at);
                    let text = if stroke.erase {
                        RichText::new(text).weak()
                    } else {
                        RichText::new(text)
                    };
                    if ui.selectable_label(on, text).clicked() {
                        let next = (!on).then_some(at);
                        asks.push(Ask::Select(next).command());
                    }
                }
            });
    }

    /// What can be done with the selected stroke.
    fn selected(&mut self, ui: &mut Ui, at: usize, stroke: &Stroke, asks: &mut Vec<Command>) {
        ui.horizontal(|ui| {
            let mut button = |ui: &mut Ui, glyph: &str, does: &str, ask: Ask| {
                if icon_button(ui, glyph, does, false).clicked() {
                    asks.push(ask.command());
                }
            };
            button(ui, icon::MINUS, "Smaller", Ask::Resize(at, 1.0 / 1.12));
            button(ui, icon::PLUS, "Larger", Ask::Resize(at, 1.12));
            let turned = if stroke.erase {
                "Let it paint"
            } else {
                "Let it erase"
            };
            button(ui, icon::ERASER, turned, Ask::Erase(at, !stroke.erase));
            button(ui, icon::TRASH, "Delete the stroke", Ask::Delete(at));
            button(ui, icon::X, "Back to painting", Ask::Select(None));
        });
        let mut weight = match self.weight {
            Some((of, weight)) if of == at => weight,
            _ => stroke.weight,
        };
        let slider = Slider::new(&mut weight, 0.1..=10.0).logarithmic(true);
        let response = field(ui, "Weight", slider);
        if response.changed() {
            self.weight = Some((at, weight));
        }
        if response.drag_stopped() || (response.changed() && !response.dragged()) {
            self.weight = None;
            asks.push(Ask::Weight(at, weight).command());
        }
        ui.weak("In the view: drag it, ↑ ↓ resize it.");
    }
}

fn glyph(stroke: &Stroke) -> &'static str {
    match &stroke.skeleton {
        _ if stroke.erase => icon::ERASER,
        Skeleton::Points(_) => icon::SCRIBBLE,
        Skeleton::Line(..) => icon::LINE_SEGMENT,
        Skeleton::Polygon(_) => icon::POLYGON,
        Skeleton::Volume(_) => icon::HORSE,
    }
}
