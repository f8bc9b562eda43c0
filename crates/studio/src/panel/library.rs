//! The library: pictures by category, searched as one types.

use bevy::prelude::World;
use bevy_egui::egui::{
    self, Align2, Color32, ColorImage, FontId, Rect, Response, RichText, Sense, TextStyle,
    TextureHandle, TextureOptions, Ui, Vec2, vec2,
};
use midair_field::RecipeHash;
use midair_library::{Component, OWN, Source};

use super::{ACCENT, Panel, icon, kit};
use crate::bounded::Bounded;
use crate::command::{Command, Dialog};
use crate::evaluate::Evaluations;
use crate::hands::Side;
use crate::project::{Picture, Places, Selection, Shelf, Thumbnails};
use crate::settings::Settings;
use crate::units;

/// The basic shapes: what one looks for first stands first.
const BASIC: [&str; 8] = [
    "solid/cube",
    "solid/sphere",
    "solid/cylinder",
    "solid/cone",
    "solid/torus",
    "solid/capsule",
    "solid/cuboid",
    "solid/pyramid",
];

/// The shelf as a panel.
pub(super) struct LibraryPanel {
    /// What is typed into the search field.
    query: String,
    /// Which category is shown.
    category: Category,
    textures: Bounded<RecipeHash, TextureHandle>,
    /// Where those pictures are: each host has its own.
    host: Option<egui::Context>,
    /// The rectangle the panel had in the last frame.
    shown: Option<Rect>,
    grid: Grid,
}

/// How the tiles lay in the last frame.
#[derive(Clone, Copy, Default)]
struct Grid {
    columns: usize,
    /// Height of a row with the gap after it, and of a heading.
    row: f32,
    heading: f32,
    scrolled: f32,
    /// Headings and rows of what was used before and of favourites, above all others.
    above: Option<(usize, usize)>,
}

impl Grid {
    /// Headings and rows of those sections that change as one works.
    fn above(&self, sections: &[Section]) -> Option<(usize, usize)> {
        let changing = sections
            .iter()
            .take_while(|s| [RECENT, FAVOURITES].contains(&s.title));
        // Where there is no heading there is one section, which is what was asked for.
        let all = sections.first().is_some_and(|s| !s.title.is_empty());
        all.then(|| {
            changing.fold((0, 0), |(headings, rows), s| {
                let own = s.components.len().div_ceil(self.columns.max(1));
                (headings + 1, rows + own)
            })
        })
    }
}

const RECENT: &str = "Recent";
const FAVOURITES: &str = "Favourites";

/// So many pictures are kept on the graphics card: more than fit on a screen.
const TEXTURES: usize = 512;

impl Default for LibraryPanel {
    fn default() -> Self {
        Self {
            query: String::new(),
            category: Category::default(),
            textures: Bounded::new(TEXTURES),
            host: None,
            shown: None,
            grid: Grid::default(),
        }
    }
}

#[derive(Clone, Debug, Default, PartialEq)]
enum Category {
    /// Recent and favourite ones, the basic shapes, then everything.
    #[default]
    All,
    Favourites,
    Named(String),
}

impl Panel for LibraryPanel {
    fn show(&mut self, ui: &mut Ui, world: &World, asks: &mut Vec<Command>) {
        let shelf = world.resource::<Shelf>();
        let settings = world.resource::<Settings>();
        self.shown = Some(ui.max_rect());
        if self.host.as_ref() != Some(ui.ctx()) {
            self.textures = Bounded::new(TEXTURES);
            self.host = Some(ui.ctx().clone());
        }
        ui.horizontal(|ui| {
            // In the headset buttons are larger, and a line that is too wide makes the tiles below it larger.
            let button = kit::width(ui, icon::STACK_PLUS, egui::TextStyle::Button)
                + 2.0 * ui.spacing().button_padding.x
                + ui.spacing().item_spacing.x;
            let width = ui.available_width() - 2.0 * button - 2.0;
            kit::search(ui, &mut self.query, "Search", width);
            let import = ui.button(icon::DOWNLOAD_SIMPLE);
            let named = |on, name| egui::WidgetInfo::labeled(egui::WidgetType::Button, on, name);
            import.widget_info(|| named(true, "Import"));
            if import
                .on_hover_text("Bring in meshes of your own: GLB, OBJ, STL, PLY")
                .clicked()
            {
                asks.push(Command::Dialog(Dialog::Import));
            }
            let chosen = !world.resource::<Selection>().0.is_empty();
            let keep = ui.add_enabled(chosen, egui::Button::new(icon::STACK_PLUS));
            keep.widget_info(|| named(chosen, "Keep"));
            if keep
                .on_hover_text("Keep what is selected in the library, as components of your own")
                .clicked()
            {
                asks.push(Command::Keep {
                    objects: Vec::new(),
                });
            }
        });
        let by = kit::turned(ui.ctx(), "library");
        if by != 0 {
            self.turn(by, shelf, settings);
        }
        if self.query.trim().is_empty() {
            self.categories(ui, shelf, settings);
        }
        let sections = self.sections(shelf, settings);
        let tile = settings.shelf.tile.clamp(48.0, 160.0);
        let waits = world.resource::<Thumbnails>().is_busy();
        self.tiles(ui, world, &sections, tile, asks);
        if waits {
            // What is being drawn appears without the pointer having to move.
            ui.ctx().request_repaint();
        }
    }
}

/// A heading and what stands under it.
struct Section<'a> {
    title: &'a str,
    components: Vec<&'a Component>,
}

impl LibraryPanel {
    /// The category so many further, around; a search ends.
    fn turn(&mut self, by: i32, shelf: &Shelf, settings: &Settings) {
        let mut all = vec![Category::All];
        if !settings.shelf.favourites.is_empty() {
            all.push(Category::Favourites);
        }
        let named = shelf.library.categories();
        all.extend(named.map(|(name, _)| Category::Named(name.to_owned())));
        let at = all.iter().position(|c| *c == self.category).unwrap_or(0);
        let to = (at as i32 + by).rem_euclid(all.len() as i32);
        self.category = all.swap_remove(to as usize);
        self.query.clear();
    }

    fn categories(&mut self, ui: &mut Ui, shelf: &Shelf, settings: &Settings) {
        ui.horizontal_wrapped(|ui| {
            ui.spacing_mut().item_spacing = vec2(4.0, 4.0);
            ui.spacing_mut().button_padding.x = 8.0;
            let mut choose = |ui: &mut Ui, text: String, category: Category, about: &str| {
                if ui
                    .selectable_label(self.category == category, text)
                    .on_hover_text(about)
                    .clicked()
                {
                    self.category = category;
                }
            };
            choose(ui, "All".into(), Category::All, "Everything");
            let stars = format!("{} favourites", settings.shelf.favourites.len());
            choose(ui, icon::STAR.into(), Category::Favourites, &stars);
            for (name, components) in shelf.library.categories() {
                let count = format!("{} of them", components.len());
                choose(
                    ui,
                    name.to_owned(),
                    Category::Named(name.to_owned()),
                    &count,
                );
            }
        });
    }

    fn sections<'a>(&self, shelf: &'a Shelf, settings: &Settings) -> Vec<Section<'a>> {
        let library = &shelf.library;
        let named = |ids: &[String]| -> Vec<&'a Component> {
            ids.iter().filter_map(|id| library.get(id)).collect()
        };
        if !self.query.trim().is_empty() {
            return vec![Section {
                title: "",
                components: library.search(&self.query),
            }];
        }
        match &self.category {
            Category::Favourites => vec![Section {
                title: "",
                components: named(&settings.shelf.favourites),
            }],
            Category::Named(name) => {
                let of = library.categories().find(|(c, _)| c == name);
                vec![Section {
                    title: "",
                    components: of.map_or(Vec::new(), |(_, c)| basic_first(c)),
                }]
            }
            Category::All => {
                let mut sections = vec![
                    Section {
                        title: RECENT,
                        components: named(&settings.shelf.recent),
                    },
                    Section {
                        title: FAVOURITES,
                        components: named(&settings.shelf.favourites),
                    },
                ];
                let all: Vec<_> = library.categories().collect();
                // What a person made is what is looked for.
                let (own, bundled): (Vec<_>, Vec<_>) =
                    all.into_iter().partition(|(c, _)| *c == OWN);
                for (title, components) in own.into_iter().chain(bundled) {
                    sections.push(Section {
                        title,
                        components: basic_first(components),
                    });
                }
                sections.retain(|s| !s.components.is_empty());
                sections
            }
        }
    }

    fn tiles(
        &mut self,
        ui: &mut Ui,
        world: &World,
        sections: &[Section],
        tile: f32,
        asks: &mut Vec<Command>,
    ) {
        if sections.iter().all(|s| s.components.is_empty()) {
            ui.add_space(12.0);
            ui.weak(match self.category {
                Category::Favourites => "No favourites yet. Right-click a shape to give it a star.",
                _ => "Nothing is called that. Try a shape: cube, leg, handle, star.",
            });
            return;
        }
        let mut first = true;
        let shown = match &self.category {
            Category::All => "all",
            Category::Favourites => "stars",
            Category::Named(name) => name,
        };
        // Each begins at its own top.
        let mut area = egui::ScrollArea::vertical()
            .id_salt(shown.to_owned())
            .auto_shrink([false, false]);
        let mut grid = self.grid;
        let above = grid.above(sections);
        // The tile under the pointer stays there when what was just used appears above it.
        if let (Some(now), Some(before)) = (above, grid.above)
            && now != before
            && ui.rect_contains_pointer(ui.max_rect())
        {
            let more = |now: usize, before: usize| now as f32 - before as f32;
            let by = more(now.0, before.0) * grid.heading + more(now.1, before.1) * grid.row;
            area = area.vertical_scroll_offset((grid.scrolled + by).max(0.0));
        }
        grid.above = above;
        let output = area.show(ui, |ui| {
            let gap = 6.0;
            let room = ui.available_width() - 4.0;
            let columns = ((room + gap) / (tile + gap)).floor().max(1.0);
            let side = ((room + gap) / columns - gap).min(2.0 * tile);
            ui.spacing_mut().item_spacing = vec2(gap, gap);
            grid.columns = columns as usize;
            grid.row = side + 18.0 + gap;
            for section in sections {
                let top = ui.cursor().top();
                if !section.title.is_empty() {
                    ui.add_space(6.0);
                    ui.label(RichText::new(section.title).strong());
                    grid.heading = ui.cursor().top() - top;
                }
                for row in section.components.chunks(columns as usize) {
                    let size = vec2(side, side + 18.0);
                    // Rows out of sight take their place and are not drawn.
                    let place = Rect::from_min_size(ui.cursor().min, vec2(room, size.y));
                    if !ui.is_rect_visible(place) {
                        ui.allocate_space(place.size());
                        continue;
                    }
                    ui.horizontal(|ui| {
                        for component in row {
                            let response = self.tile(ui, world, component, size);
                            if std::mem::take(&mut first) {
                                kit::begin_at(ui.ctx(), "library", response.id);
                            }
                            self.act(response, world, component, asks);
                        }
                    });
                }
            }
        });
        grid.scrolled = output.state.offset.y;
        self.grid = grid;
    }

    fn tile(&mut self, ui: &mut Ui, world: &World, component: &Component, size: Vec2) -> Response {
        let sense = if component.missing {
            Sense::hover()
        } else {
            Sense::click_and_drag()
        };
        let (rect, response) = ui.allocate_exact_size(size, sense);
        response.widget_info(|| {
            egui::WidgetInfo::labeled(
                egui::WidgetType::Button,
                !component.missing,
                &component.name,
            )
        });
        let visuals = ui.style().interact(&response);
        let painter = ui.painter();
        painter.rect(
            rect,
            6.0,
            visuals.weak_bg_fill,
            if response.has_focus() {
                egui::Stroke::new(2.0, ACCENT)
            } else {
                egui::Stroke::NONE
            },
            egui::StrokeKind::Inside,
        );
        let picture = Rect::from_min_size(rect.min, Vec2::splat(size.x)).shrink(4.0);
        let text = ui.visuals().text_color();
        if component.missing {
            sign(ui, picture, icon::WARNING, text);
        } else {
            match self.texture(ui, world, component) {
                Some(texture) => {
                    let whole = Rect::from_min_max(egui::pos2(0.0, 0.0), egui::pos2(1.0, 1.0));
                    painter.image(texture, picture, whole, Color32::WHITE);
                }
                None => sign(
                    ui,
                    picture,
                    icon::CUBE_TRANSPARENT,
                    text.gamma_multiply(0.4),
                ),
            }
        }
        let font = TextStyle::Small.resolve(ui.style());
        let mut job = egui::text::LayoutJob::simple_singleline(component.name.clone(), font, text);
        job.wrap = egui::text::TextWrapping::truncate_at_width(size.x - 6.0);
        let galley = ui.fonts_mut(|f| f.layout_job(job));
        let at = rect.center_bottom() - vec2(0.5 * galley.size().x, 4.0 + galley.size().y);
        painter.galley(at, galley, text);
        let starred = world
            .resource::<Settings>()
            .shelf
            .favourites
            .contains(&component.id);
        if starred {
            let corner = rect.right_top() + vec2(-4.0, 4.0);
            painter.text(
                corner,
                Align2::RIGHT_TOP,
                icon::STAR,
                FontId::proportional(12.0),
                ACCENT,
            );
        }
        response
    }

    /// The picture as the screen has it; asked for where it is not there yet.
    fn texture(
        &mut self,
        ui: &Ui,
        world: &World,
        component: &Component,
    ) -> Option<egui::TextureId> {
        let hash = component.recipe.hash();
        if let Some(texture) = self.textures.get(&hash) {
            return Some(texture.id());
        }
        let volumes = &world.resource::<Evaluations>().volumes;
        let cache = world.resource::<Places>().library.thumbnails();
        let Picture::Here(picture) =
            world
                .resource::<Thumbnails>()
                .get(&component.recipe, volumes, &cache)
        else {
            return None;
        };
        let image = ColorImage::from_rgba_unmultiplied([picture.size; 2], &picture.rgba);
        let texture = ui
            .ctx()
            .load_texture(&component.id, image, TextureOptions::LINEAR);
        let id = texture.id();
        self.textures.insert(hash, texture);
        Some(id)
    }

    fn act(
        &self,
        response: Response,
        world: &World,
        component: &Component,
        asks: &mut Vec<Command>,
    ) {
        if response.clicked() {
            // At which hand is the way in's to say.
            asks.push(Command::Place {
                component: component.id.clone(),
                side: Side::Right,
            });
        }
        self.drag(&response, component, asks);
        let settings = world.resource::<Settings>();
        let response = if component.missing {
            response.on_hover_text("Its mesh is gone. Import it again.")
        } else {
            let bounds = component.recipe.bounds();
            let size = units::size(bounds.size(), settings.units.length);
            response.on_hover_text(format!("{}\n{size}", component.name))
        };
        response.context_menu(|ui| {
            let starred = settings.shelf.favourites.contains(&component.id);
            let text = if starred {
                "Take the star away"
            } else {
                "Give it a star"
            };
            if ui.button(format!("{}  {text}", icon::STAR)).clicked() {
                asks.push(Settings::command(
                    "shelf.favourites",
                    settings.shelf.toggled(&component.id),
                ));
                ui.close();
            }
            let own = matches!(component.source, Source::User(_));
            let button =
                || egui::Button::new(format!("{}  Take it out of the library", icon::TRASH));
            if own && ui.add(button()).clicked() {
                asks.push(Command::TakeAway {
                    component: component.id.clone(),
                });
                ui.close();
            }
        });
    }
}

/// Points of the picture that hangs at the pointer.
const DRAGGED: f32 = 72.0;

impl LibraryPanel {
    /// A tile is dragged out: its picture goes with the pointer, and it is placed where it is let go.
    fn drag(&self, response: &Response, component: &Component, asks: &mut Vec<Command>) {
        let ctx = &response.ctx;
        let Some(at) = ctx.pointer_interact_pos() else {
            return;
        };
        // Let go over the panel it came from, it stays in the library.
        let outside = !self.shown.is_some_and(|r| r.contains(at));
        if response.drag_started() {
            // A click leaves the search field; so does a drag, or keys would go on typing into it.
            ctx.memory_mut(|m| m.stop_text_input());
        }
        if response.drag_stopped() && outside {
            asks.push(Command::Place {
                component: component.id.clone(),
                side: Side::Right,
            });
        }
        if !response.dragged() {
            return;
        }
        ctx.set_cursor_icon(egui::CursorIcon::Grabbing);
        let layer = egui::LayerId::new(egui::Order::Tooltip, egui::Id::new("dragged component"));
        let painter = ctx.layer_painter(layer);
        let place = Rect::from_center_size(at, Vec2::splat(DRAGGED));
        let shade = if outside { 230 } else { 120 };
        match self.textures.look(&component.recipe.hash()) {
            Some(texture) => {
                let whole = Rect::from_min_max(egui::pos2(0.0, 0.0), egui::pos2(1.0, 1.0));
                let tint = Color32::from_white_alpha(shade);
                painter.image(texture.id(), place, whole, tint);
            }
            None => {
                let font = FontId::proportional(0.4 * DRAGGED);
                painter.text(at, Align2::CENTER_CENTER, icon::CUBE, font, ACCENT);
            }
        }
    }
}

fn sign(ui: &Ui, at: Rect, sign: &str, colour: Color32) {
    let font = FontId::proportional(0.4 * at.height());
    ui.painter()
        .text(at.center(), Align2::CENTER_CENTER, sign, font, colour);
}

/// The basic shapes in their order, then the rest in theirs.
fn basic_first(components: &[Component]) -> Vec<&Component> {
    let rank = |c: &&Component| BASIC.iter().position(|b| *b == c.id).unwrap_or(BASIC.len());
    let mut sorted: Vec<_> = components.iter().collect();
    sorted.sort_by_key(rank);
    sorted
}
