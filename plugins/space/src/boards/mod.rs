//! Panels in the room: the same functions that a screen hosts, each on a sheet of its own.
//!
//! A [`Board`] is an egui context whose pointer is a wand. It is laid out again only when a wand is on it, when the
//! studio changed, when it asks for it, and now and then; it is drawn again only when what is on it changed.

mod bar;
mod content;
mod host;
mod keys;
mod picture;
mod place;
mod wrist;

use std::collections::BTreeMap;
use std::time::Duration;

use bevy::math::Affine3A;
use bevy::prelude::*;
use midair_studio::hands::{Pose, Side};
use midair_studio::panel::{Files, Keyboard, egui};
use midair_studio::settings::LookSettings;

pub use bar::BAR;
pub(crate) use bar::moves as bar_moves;
pub(crate) use host::{arrange, paint};
pub(crate) use picture::{Painted, plugin};
pub(crate) use place::{WRIST, place};
pub(crate) use wrist::Page;

use crate::DMM_PER_POINT;

/// Metres from the eyes at which a board has its size.
pub(crate) const AWAY: f32 = 0.6;

/// Which board.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum BoardId {
    /// The panel on the wrist of the hand that does not lead: modes, undo, files, the world.
    Wrist,
    /// A panel that a plugin registered.
    Panel(&'static str),
    /// The question for a file.
    Files,
    /// The keys that wands type with.
    Keyboard,
    /// The ring of modes.
    Ring,
}

/// Where a board belongs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Anchor {
    /// Where it was put in the room.
    Room,
    /// Beside this hand, turned to the eyes.
    Hand(Side),
    /// Below another board.
    Below(BoardId),
}

/// One panel in the room.
pub struct Board {
    /// Which.
    pub id: BoardId,
    /// Across and down, in points.
    pub size: egui::Vec2,
    /// Its middle, in metres of the room, its front towards +Z.
    pub pose: Pose,
    /// Metres per point.
    pub scale: f32,
    /// Whether it is to be seen and pointed at.
    pub shown: bool,
    pub(crate) anchor: Anchor,
    /// Whether it is open; closed ones keep what was set on them.
    pub(crate) open: bool,
    /// Whether it has no place yet.
    fresh: bool,
    /// What wands did on it since it was laid out last.
    pub(crate) events: Vec<egui::Event>,
    /// The hand whose wand is on it, and where, in points.
    pub(crate) pointer: Option<(Side, egui::Pos2)>,
    /// Whether it is to be laid out at once.
    pub(crate) stale: bool,
    /// Seconds since the start when it was opened.
    opened: f64,
    /// When it is laid out next if nothing happens.
    next: f64,
    ctx: egui::Context,
    /// The look it has.
    look: Option<LookSettings>,
    /// What is on it.
    shapes: Vec<egui::epaint::ClippedShape>,
    picture: picture::Sheet,
}

impl Board {
    fn new(id: BoardId, now: f64) -> Self {
        Self {
            id,
            size: content::size(id),
            pose: Pose::default(),
            scale: 1e-3 * DMM_PER_POINT * AWAY,
            shown: true,
            anchor: Anchor::Room,
            open: true,
            fresh: true,
            events: Vec::new(),
            pointer: None,
            stale: true,
            opened: now,
            next: 0.0,
            ctx: egui::Context::default(),
            look: None,
            shapes: Vec::new(),
            picture: picture::Sheet::default(),
        }
    }

    /// Across and down, in metres of the room.
    pub fn metres(&self) -> Vec2 {
        Vec2::new(self.size.x, self.size.y) * self.scale
    }

    /// Where a point of it is, in metres of the room.
    pub fn at(&self, point: egui::Pos2) -> Vec3 {
        let across = (point.x - 0.5 * self.size.x) * self.scale;
        let up = (0.5 * self.size.y - point.y) * self.scale;
        self.pose.position + self.pose.rotation * Vec3::new(across, up, 0.0)
    }

    /// Where a ray of the room meets its plane from the front: metres along the ray, and the point.
    pub fn meet(&self, origin: Vec3, direction: Vec3) -> Option<(f32, egui::Pos2)> {
        let board = Affine3A::from_rotation_translation(self.pose.rotation, self.pose.position);
        let inverse = board.inverse();
        let (from, along) = (
            inverse.transform_point3(origin),
            inverse.transform_vector3(direction),
        );
        // From behind there is nothing to click.
        if from.z <= 0.0 || along.z >= -1e-3 {
            return None;
        }
        let far = -from.z / along.z;
        let at = from + far * along;
        let point = egui::pos2(
            at.x / self.scale + 0.5 * self.size.x,
            0.5 * self.size.y - at.y / self.scale,
        );
        (far.is_finite() && point.x.is_finite() && point.y.is_finite()).then_some((far, point))
    }

    /// Whether it hangs on this hand, whose wand passes it.
    pub(crate) fn hangs_on(&self, side: Side) -> bool {
        self.anchor == Anchor::Hand(side)
    }

    /// Whether a point lies on it.
    pub fn covers(&self, point: egui::Pos2) -> bool {
        egui::Rect::from_min_size(egui::Pos2::ZERO, self.size).contains(point)
    }

    /// What is written on it where it can be seen, and the middle of each text in points: for tests and scenarios, which
    /// point at words.
    pub fn texts(&self) -> Vec<(String, egui::Pos2)> {
        let mut texts = Vec::new();
        for clipped in &self.shapes {
            written(&clipped.shape, clipped.clip_rect, &mut texts);
        }
        texts
    }

    /// The middle of the shortest text on it that has this one in it, in points: a button "Save" rather than
    /// a heading about saving.
    pub fn find(&self, text: &str) -> Option<egui::Pos2> {
        let texts = self.texts();
        let with = texts.iter().filter(|(t, _)| t.contains(text));
        with.min_by_key(|(t, _)| t.len()).map(|(_, at)| *at)
    }
}

fn written(shape: &egui::Shape, clip: egui::Rect, texts: &mut Vec<(String, egui::Pos2)>) {
    match shape {
        egui::Shape::Text(shown) => {
            let middle = shown.galley.rect.translate(shown.pos.to_vec2()).center();
            if clip.contains(middle) {
                texts.push((shown.galley.text().trim().to_owned(), middle));
            }
        }
        egui::Shape::Vec(shapes) => {
            for shape in shapes {
                written(shape, clip, texts);
            }
        }
        _ => {}
    }
}

/// The boards that are there, and what is typed and chosen on them.
#[derive(Resource)]
pub struct Boards {
    all: BTreeMap<BoardId, Board>,
    files: Files,
    /// The file dialog that was asked last.
    seen: u64,
    keyboard: Keyboard,
    /// The board that is typed into.
    typing: Option<BoardId>,
    page: Page,
    /// Whether the wrist's board was taken off and put somewhere.
    pinned: bool,
    /// How often boards were laid out, and for how long.
    laid_out: (u64, Duration),
}

impl Default for Boards {
    fn default() -> Self {
        Self {
            all: BTreeMap::new(),
            files: content::files(),
            seen: 0,
            keyboard: Keyboard::default(),
            typing: None,
            page: Page::default(),
            pinned: false,
            laid_out: (0, Duration::ZERO),
        }
    }
}

impl Boards {
    /// One of them, if it is open.
    pub fn get(&self, id: BoardId) -> Option<&Board> {
        self.all.get(&id).filter(|b| b.open)
    }

    /// How often boards were laid out so far and made ready to be drawn, and what that took.
    pub fn laid_out(&self) -> (u64, Duration) {
        self.laid_out
    }

    /// All that are open.
    pub fn all(&self) -> impl Iterator<Item = &Board> {
        self.all.values().filter(|b| b.open)
    }

    pub(crate) fn get_mut(&mut self, id: BoardId) -> Option<&mut Board> {
        self.all.get_mut(&id)
    }

    /// A press elsewhere ends the typing.
    pub(crate) fn pressed(&mut self, id: BoardId) {
        if id == BoardId::Keyboard || self.typing == Some(id) {
            return;
        }
        if let Some(field) = self.typing.take().and_then(|t| self.all.get_mut(&t)) {
            field.ctx.memory_mut(egui::Memory::stop_text_input);
            field.stale = true;
        }
    }

    /// A hand took it from where it belonged.
    pub(crate) fn take_off(&mut self, id: BoardId) {
        if let Some(board) = self.all.get_mut(&id) {
            board.anchor = Anchor::Room;
        }
        if id == BoardId::Wrist {
            self.pinned = true;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ray_meets_the_point_it_is_aimed_at_and_never_from_behind() {
        let mut board = Board::new(BoardId::Files, 0.0);
        board.pose = Pose {
            position: Vec3::new(0.2, 1.3, -0.5),
            rotation: Quat::from_rotation_y(0.4) * Quat::from_rotation_x(-0.2),
        };
        let from = Vec3::new(0.1, 1.0, 0.2);
        for point in [egui::pos2(10.0, 10.0), egui::pos2(300.0, 77.0)] {
            let at = board.at(point);
            let (far, met) = board.meet(from, (at - from).normalize()).unwrap();
            assert!((far - at.distance(from)).abs() < 1e-4);
            assert!(met.distance(point) < 0.1, "{met:?}");
        }
        let behind = board.pose.position - board.pose.rotation * Vec3::Z;
        assert_eq!(board.meet(behind, board.pose.rotation * Vec3::Z), None);
    }

    #[test]
    fn what_is_read_and_what_is_pressed_is_large_enough() {
        let ctx = egui::Context::default();
        content::style(&ctx, &default());
        let style = ctx.global_style();
        let dmm = |points: f32| points * DMM_PER_POINT;
        assert!(dmm(egui::TextStyle::Body.resolve(&style).size) >= 20.0);
        assert!(dmm(egui::TextStyle::Small.resolve(&style).size) >= 20.0);
        assert!(dmm(style.spacing.interact_size.y) >= 64.0);
        assert!(dmm(style.spacing.item_spacing.y) >= 16.0);
    }
}
