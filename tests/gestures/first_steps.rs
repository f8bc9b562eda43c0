//! What somebody meets who tries a mode for the first time, with mouse and keyboard.

use bevy::prelude::*;
use bevy_egui::{EguiContext, PrimaryEguiContext};
use midair_brush::BRUSH;
use midair_studio::command::Command;
use midair_studio::panel::egui::{Id, containers::panel::PanelState};
use midair_studio::settings::{BrushSkeleton, Settings};
use midair_studio::tools::Hints;
use midair_sweep::{Draft, SWEEP, Solo};

use crate::desk::Desk;

impl Desk {
    fn says(&mut self, command: Command) {
        self.app.world_mut().write_message(command);
        self.wait(3);
    }

    /// How wide the column of panels at the left is, in points.
    fn left_column(&mut self) -> f32 {
        let world = self.app.world_mut();
        let mut contexts = world.query_filtered::<&mut EguiContext, With<PrimaryEguiContext>>();
        let mut context = contexts.single_mut(world).unwrap();
        let state = PanelState::load(context.get_mut(), Id::new("left"));
        state.expect("a column at the left").outer_rect.width()
    }

    fn status(&self) -> &str {
        &self.world().resource::<Hints>().status
    }
}

#[test]
fn the_panel_of_brush_stays_as_wide_as_it_is() {
    let mut desk = Desk::new();
    desk.says(Command::Mode(BRUSH));
    desk.glide(Vec2::new(800.0, 400.0));
    desk.wait(30);
    let before = desk.left_column();
    for skeleton in BrushSkeleton::ALL {
        desk.says(Settings::command("brush.skeleton", skeleton));
        desk.wait(60);
        // A number that is wider than any before may take some points, once.
        let now = desk.left_column();
        assert!((now - before).abs() < 10.0, "{skeleton:?}: {before}, {now}");
        desk.wait(60);
        assert_eq!(desk.left_column(), now, "{skeleton:?}");
    }
}

#[test]
fn a_polygon_says_how_many_corners_it_needs() {
    let mut desk = Desk::new();
    desk.says(Command::Mode(BRUSH));
    desk.says(Settings::command("brush.skeleton", BrushSkeleton::Polygon));
    let needs = [
        "A polygon with 1 corner: 3 more at least",
        "A polygon with 2 corners: 2 more at least",
        "A polygon with 3 corners: 1 more at least",
        "A polygon with 4 corners",
    ];
    let corners = [(700, 300), (900, 300), (900, 420), (700, 420)];
    for ((x, y), needs) in corners.into_iter().zip(needs) {
        desk.glide(IVec2::new(x, y).as_vec2());
        desk.click();
        assert_eq!(desk.status(), needs);
    }
}

#[test]
fn in_sweep_a_click_selects_what_is_there_and_is_no_way() {
    let mut desk = Desk::new();
    desk.says(Command::Mode(SWEEP));
    let [left, right] = [Vec2::new(560.0, 400.0), Vec2::new(720.0, 400.0)];
    let down = Vec2::new(0.0, 60.0);
    desk.drag(MouseButton::Left, left, left + down);
    desk.drag(MouseButton::Left, right, right + down);
    let draft = |desk: &Desk| desk.world().resource::<Draft>().solo.clone();
    let ready = draft(&desk);
    assert!(matches!(ready, Solo::Ready { .. }), "{ready:?}");
    let around = desk.document().len();
    // Where nothing is.
    desk.glide(Vec2::new(300.0, 200.0));
    desk.click();
    assert_eq!(draft(&desk), ready);
    let up = Vec2::new(0.0, -120.0);
    desk.drag(MouseButton::Left, left, left + up);
    assert!(matches!(draft(&desk), Solo::LeftDrawn { .. }));
    desk.drag(MouseButton::Left, right, right + up);
    desk.settle();
    assert_eq!(desk.document().len(), around + 1, "{:?}", desk.warnings());
    let (sheet, _) = desk.document().objects().next_back().unwrap();
    desk.says(Command::Objects(midair_studio::objects::Ask::SelectNone));
    assert_eq!(desk.selected(), []);
    let ready = draft(&desk);
    let at = desk.hover(sheet);
    desk.glide(at);
    desk.click();
    assert_eq!(desk.selected(), [sheet]);
    assert_eq!(draft(&desk), ready, "and the ends stand where they stood");
}
