//! Painting through the hands: every skeleton, erasing, changing strokes later, bad input.

use bevy::prelude::*;
use midair_brush::{Ask, BRUSH, Easel, canvas};
use midair_document::ObjectId;
use midair_field::{Canvas, Node, Op, Skeleton};
use midair_studio::command::Command;
use midair_studio::hands::{Action, Pose, Side};
use midair_studio::settings::Settings;

use crate::studio::Studio;

const HERE: Vec3 = Vec3::new(0.2, 1.0, 0.1);

fn painter(skeleton: &str) -> Studio {
    let mut s = Studio::new();
    s.ask(Command::Mode(BRUSH));
    set(&mut s, "brush.skeleton", &format!("\"{skeleton}\""));
    set(&mut s, "brush.radius", "0.05");
    s.frames(2);
    s
}

fn set(s: &mut Studio, key: &str, value: &str) {
    s.ask(Command::Set {
        key: key.into(),
        value: value.into(),
    });
}

fn strokes(s: &Studio) -> Canvas {
    canvas(s.object(s.only())).expect("a painting").clone()
}

/// A trigger pressed at a place and let go at another.
fn drag(s: &mut Studio, from: Vec3, to: Vec3) {
    s.reach(Side::Right, from);
    s.press(Side::Right, Action::Act);
    s.carry_right(to);
    s.let_go(Side::Right, Action::Act);
}

fn dab(s: &mut Studio, at: Vec3) {
    s.reach(Side::Right, at);
    s.click(Side::Right, Action::Act);
}

#[test]
fn a_point_is_painted_undone_and_redone() {
    let mut s = painter("Point");
    let before = s.undo_len();
    dab(&mut s, HERE);
    s.settle();
    let id = s.only();
    assert_eq!(s.undo_len(), before + 1);
    let report = s.faultless(id, 0.005);
    let ball = 4.0 / 3.0 * std::f64::consts::PI * 0.05f64.powi(3);
    assert!(
        (report.volume / ball - 1.0).abs() < 0.02,
        "{}",
        report.volume
    );
    let painted = s.document().to_ron();
    s.ask(Command::Undo);
    assert!(s.document().is_empty());
    s.ask(Command::Redo);
    assert_eq!(s.document().to_ron(), painted);
    // The next stroke goes on with it.
    dab(&mut s, HERE + Vec3::X * 0.06);
    assert_eq!(strokes(&s).strokes.len(), 2);
    assert_eq!(s.warnings(), [] as [String; 0]);
}

#[test]
fn a_led_point_is_one_stroke_and_one_step() {
    let mut s = painter("Point");
    let before = s.undo_len();
    drag(&mut s, HERE, HERE + Vec3::X * 0.3);
    assert_eq!(s.undo_len(), before + 1);
    let painted = strokes(&s);
    let Skeleton::Points(points) = &painted.strokes[0].skeleton else {
        panic!("a led point")
    };
    assert!(points.len() > 5, "{}", points.len());
    let end = points.last().unwrap().truncate();
    assert!(end.distance(Vec3::X * 0.3) < 1e-4, "{end}");
    s.settle();
    s.faultless(s.only(), 0.01);
}

#[test]
fn a_line_is_dragged_or_set_by_two_presses() {
    let mut s = painter("Line");
    drag(&mut s, HERE, HERE + Vec3::X * 0.3);
    dab(&mut s, HERE + Vec3::Z * 0.2);
    assert_eq!(strokes(&s).strokes.len(), 1);
    dab(&mut s, HERE + Vec3::new(0.3, 0.0, 0.2));
    let painted = strokes(&s);
    assert_eq!(painted.strokes.len(), 2);
    assert!(
        painted
            .strokes
            .iter()
            .all(|s| matches!(s.skeleton, Skeleton::Line(..)))
    );
    s.settle();
    s.faultless(s.only(), 0.01);
}

#[test]
fn a_polygon_has_four_corners_and_is_finished() {
    let mut s = painter("Polygon");
    for (x, z) in [(0.0, 0.0), (0.3, 0.0), (0.3, 0.3)] {
        dab(&mut s, HERE + Vec3::new(x, 0.0, z));
    }
    s.click(Side::Right, Action::Finish);
    assert!(s.document().is_empty(), "three corners are too few");
    assert!(s.warnings().last().unwrap().contains("four corners"));
    dab(&mut s, HERE + Vec3::new(0.3, 0.0, 0.3));
    assert!(
        s.warnings()
            .last()
            .unwrap()
            .contains("corner at that place")
    );
    dab(&mut s, HERE + Vec3::new(0.0, 0.0, 0.3));
    s.reach(Side::Right, HERE + Vec3::Y * 0.4);
    s.click(Side::Right, Action::Finish);
    assert_eq!(strokes(&s).strokes.len(), 1);
    s.settle();
    s.faultless(s.only(), 0.01);
}

#[test]
fn a_volume_is_stamped_where_it_is_held_at_its_size() {
    let mut s = painter("Volume");
    s.ask(Ask::Volume("solid/cube".into()).command());
    set(&mut s, "brush.size", "0.4");
    let pose = Pose {
        position: HERE,
        rotation: Quat::from_rotation_y(0.7),
    };
    s.put(Side::Right, pose);
    s.frames(2);
    s.click(Side::Right, Action::Act);
    s.settle();
    let mesh = s.mesh(s.only(), 0.01);
    let bounds = mesh.bounds();
    assert!(bounds.centre().distance(HERE) < 0.02, "{bounds:?}");
    assert!((bounds.size().y - 0.4).abs() < 5e-3, "{bounds:?}");
    s.faultless(s.only(), 0.01);
}

#[test]
fn the_other_hands_trigger_erases() {
    let mut s = painter("Point");
    drag(&mut s, HERE, HERE + Vec3::X * 0.3);
    let before = s.undo_len();
    s.reach(Side::Right, HERE + Vec3::X * 0.15);
    s.press(Side::Left, Action::Act);
    s.press(Side::Right, Action::Act);
    s.frames(4);
    s.let_go(Side::Right, Action::Act);
    s.let_go(Side::Left, Action::Act);
    assert_eq!(s.undo_len(), before + 1);
    let painted = strokes(&s);
    assert!(painted.strokes[1].erase);
    // Cut in two.
    let report = s.faultless(s.only(), 0.01);
    assert_eq!(report.pieces, 2, "{report:?}");
}

#[test]
fn the_cross_sets_size_and_skeleton() {
    let mut s = painter("Point");
    let radius = |s: &Studio| s.world().resource::<Settings>().brush.radius;
    let before = radius(&s);
    s.click(Side::Right, Action::Up);
    assert!(radius(&s) > before * 1.05);
    s.click(Side::Right, Action::Down);
    assert!((radius(&s) / before - 1.0).abs() < 0.02);
    s.press(Side::Right, Action::Up);
    s.frames(90);
    s.let_go(Side::Right, Action::Up);
    assert!(radius(&s) > before * 1.4, "a held press goes on");
    s.click(Side::Right, Action::Right);
    let settings = s.world().resource::<Settings>();
    assert_eq!(settings.brush.skeleton.name(), "Line");
    s.click(Side::Right, Action::Left);
    s.click(Side::Right, Action::Left);
    let settings = s.world().resource::<Settings>();
    assert_eq!(settings.brush.skeleton.name(), "Volume");
}

#[test]
fn a_stroke_is_selected_moved_resized_and_deleted_later() {
    let mut s = painter("Point");
    for x in [0.0, 0.3, 0.6] {
        dab(&mut s, HERE + Vec3::X * x);
    }
    s.settle();
    // Finish on the painting selects the stroke there.
    s.reach(Side::Right, HERE + Vec3::X * 0.3);
    s.click(Side::Right, Action::Finish);
    assert_eq!(s.world().resource::<Easel>().selected, Some(1));
    let before = s.undo_len();
    drag(
        &mut s,
        HERE + Vec3::X * 0.3,
        HERE + Vec3::new(0.3, 0.2, 0.0),
    );
    assert_eq!(s.undo_len(), before + 1);
    let placed = strokes(&s).strokes[1].placement;
    assert!(placed.translation.distance(Vec3::Y * 0.2) < 1e-4);
    s.click(Side::Right, Action::Up);
    assert!(strokes(&s).strokes[1].placement.scale.x > 1.1);
    s.click(Side::Right, Action::Right);
    assert!(strokes(&s).strokes[1].weight > 1.1);
    s.click(Side::Right, Action::Delete);
    assert_eq!(strokes(&s).strokes.len(), 2);
    assert_eq!(s.document().len(), 1, "the painting itself stays");
    for _ in 0..4 {
        s.ask(Command::Undo);
    }
    let painted = strokes(&s);
    assert_eq!(painted.strokes[1].placement.translation, Vec3::ZERO);
    assert_eq!(painted.strokes.len(), 3);
}

#[test]
fn a_stroke_deleted_from_the_middle_leaves_what_was_made_without_it() {
    let paint = |with: bool| {
        let mut s = painter("Point");
        dab(&mut s, HERE);
        if with {
            dab(&mut s, HERE + Vec3::Y * 0.05);
        }
        dab(&mut s, HERE + Vec3::X * 0.06);
        if with {
            s.ask(Ask::Delete(1).command());
        }
        s.settle();
        s.mesh(s.only(), 0.01)
    };
    assert_eq!(paint(true), paint(false));
}

#[test]
fn what_cannot_be_painted_changes_nothing_and_says_why() {
    let mut s = painter("Line");
    dab(&mut s, HERE);
    dab(&mut s, HERE);
    assert!(s.document().is_empty());
    assert!(s.warnings().last().unwrap().contains("one point"));
    s.click(Side::Right, Action::Cancel);
    set(&mut s, "brush.skeleton", "\"Point\"");
    set(&mut s, "brush.erase", "true");
    dab(&mut s, HERE);
    assert!(s.warnings().last().unwrap().contains("nothing to erase"));
    set(&mut s, "brush.erase", "false");
    // A hand that is nowhere for a while.
    s.reach(Side::Right, HERE);
    s.press(Side::Right, Action::Act);
    s.put(Side::Right, Pose::at(Vec3::splat(f32::NAN)));
    s.frames(5);
    s.let_go(Side::Right, Action::Act);
    assert_eq!(strokes(&s).strokes.len(), 1);
    s.ask(Command::Tool {
        tool: BRUSH,
        ask: "Paint".into(),
    });
    assert!(s.warnings().last().unwrap().contains("docs/brush.md"));
    s.ask(Ask::Delete(7).command());
    assert!(s.warnings().last().unwrap().contains("no stroke 8"));
}

#[test]
fn any_solid_can_be_painted_on_and_a_cancelled_stroke_is_none() {
    let mut s = painter("Point");
    let cube = s.place("solid/cube", HERE);
    s.reach(Side::Right, HERE);
    s.click(Side::Right, Action::Finish);
    assert!(canvas(s.object(cube)).is_some(), "{:?}", s.warnings());
    let before = (s.undo_len(), s.document().to_ron());
    s.press(Side::Right, Action::Act);
    s.carry_right(HERE + Vec3::Y * 0.2);
    s.click(Side::Right, Action::Cancel);
    s.let_go(Side::Right, Action::Act);
    assert_eq!((s.undo_len(), s.document().to_ron()), before);
    dab(&mut s, HERE + Vec3::Y * 0.1);
    assert_eq!(strokes(&s).strokes.len(), 2);
    s.settle();
    s.faultless(cube, 0.01);
}

#[test]
fn a_blob_cuts_a_cube_in_assemble() {
    let mut s = painter("Point");
    dab(&mut s, HERE + Vec3::Y * 0.1);
    let blob = s.only();
    let cube = s.place("solid/cube", HERE);
    s.ask(Command::Mode(midair_csg::ASSEMBLE));
    s.settle();
    s.operate();
    s.mark(HERE - Vec3::Y * 0.02, Action::Up);
    s.mark(HERE + Vec3::Y * 0.13, Action::Down);
    assert_eq!(s.marks(), [(cube, Op::Union), (blob, Op::Subtract)]);
    s.finish();
    let report = s.faultless(s.only(), 0.01);
    assert!(report.volume > 0.0);
    let recipe = s.object(s.only()).recipe().unwrap();
    let Node::Solid(operands) = recipe.node() else {
        panic!("a fused solid")
    };
    assert!(matches!(operands[1].recipe.node(), Node::Canvas(_)));
}

#[test]
fn a_carried_solid_is_the_volume_brush() {
    let mut s = painter("Point");
    let cube = s.place("solid/cube", HERE);
    s.ask(Command::Mode(midair_csg::ASSEMBLE));
    s.ask(Command::Carry {
        objects: vec![ObjectId(cube.0)],
        to: BRUSH,
    });
    s.frames(2);
    set(&mut s, "brush.size", "0.2");
    dab(&mut s, HERE + Vec3::X * 0.8);
    assert_eq!(s.document().len(), 2);
    let painting = s.document().objects().next_back().unwrap().0;
    let painted = canvas(s.object(painting)).unwrap();
    assert!(matches!(painted.strokes[0].skeleton, Skeleton::Volume(_)));
}

#[test]
fn live_symmetry_paints_the_other_side_in_the_same_step() {
    let mut s = painter("Point");
    set(&mut s, "symmetry.mirror", "\"X\"");
    s.frames(2);
    let before = s.undo_len();
    dab(&mut s, Vec3::new(0.3, 1.0, 0.0));
    assert_eq!(s.undo_len(), before + 1);
    assert_eq!(strokes(&s).strokes.len(), 2);
    let bounds = s.mesh(s.only(), 0.01).bounds();
    assert!(bounds.centre().x.abs() < 1e-3, "{bounds:?}");
    assert!((bounds.size().x - 0.7).abs() < 0.01, "{bounds:?}");
}

/// How thick the painting is above and below a place, by a ray through its mesh.
fn thickness(s: &Studio, x: f32) -> f32 {
    let mesh = s.mesh(s.only(), 0.01);
    let near = mesh.positions.iter().filter(|p| (p.x - x).abs() < 0.012);
    let (low, high) = near.fold((f32::MAX, f32::MIN), |(low, high), p| {
        (low.min(p.y), high.max(p.y))
    });
    high - low
}

#[test]
fn a_stroke_led_across_the_mirror_plane_is_as_thick_there_as_elsewhere() {
    for skeleton in ["Point", "Line"] {
        let mut s = painter(skeleton);
        set(&mut s, "symmetry.mirror", "\"X\"");
        s.frames(2);
        drag(&mut s, Vec3::new(-0.1, 1.0, 0.0), Vec3::new(0.3, 1.0, 0.0));
        let painted = strokes(&s);
        assert_eq!(painted.strokes.len(), 2);
        let twin = painted.strokes[0].twin;
        assert!(twin != 0 && painted.strokes[1].twin == twin);
        let (middle, aside) = (thickness(&s, 0.0), thickness(&s, 0.2));
        assert!((aside - 0.1).abs() < 0.006, "{skeleton}: {aside}");
        assert!(
            (middle / aside - 1.0).abs() < 0.03,
            "{skeleton}: {middle} beside {aside}"
        );
        // Another stroke is one with its own image alone.
        drag(&mut s, Vec3::new(-0.05, 1.2, 0.0), Vec3::new(0.2, 1.2, 0.0));
        let painted = strokes(&s);
        assert_ne!(painted.strokes[2].twin, twin);
        assert_eq!(painted.strokes[2].twin, painted.strokes[3].twin);
    }
}

#[test]
fn a_line_that_ends_in_the_mirror_plane_is_half_of_one() {
    let mut s = painter("Line");
    set(&mut s, "symmetry.mirror", "\"X\"");
    s.frames(2);
    drag(&mut s, Vec3::new(0.0, 1.0, 0.0), Vec3::new(0.3, 1.0, 0.0));
    assert!(strokes(&s).strokes.iter().all(|s| s.twin == 0));
    assert!(
        (thickness(&s, 0.0) - 0.1).abs() < 0.006,
        "{}",
        thickness(&s, 0.0)
    );
}

/// A blob is painted, cuts a cube in Assemble, and what is left is taken out of the library again.
#[test]
fn a_blob_cuts_a_cube_and_becomes_a_component() {
    let mut s = Studio::new();
    let cube = s.place("solid/cube", HERE);
    s.click(Side::Right, Action::Library);
    let whole = s.faultless(cube, 0.01).volume;
    s.ask(Command::Mode(BRUSH));
    set(&mut s, "brush.skeleton", "\"Point\"");
    set(&mut s, "brush.radius", "0.08");
    s.frames(2);
    // Above the cube and into its top.
    let top = HERE + Vec3::Y * 0.2;
    drag(
        &mut s,
        top + Vec3::new(-0.1, 0.04, 0.0),
        top + Vec3::new(0.1, 0.04, 0.05),
    );
    s.settle();
    let blob = s.document().objects().next_back().unwrap().0;
    assert!(canvas(s.object(blob)).is_some());
    s.ask(Command::Mode(midair_csg::ASSEMBLE));
    s.settle();
    s.operate();
    s.mark(HERE - Vec3::Y * 0.15, Action::Up);
    s.mark(top + Vec3::Y * 0.09, Action::Down);
    assert_eq!(s.marks(), [(cube, Op::Union), (blob, Op::Subtract)]);
    s.finish();
    let cut = s.document().objects().next_back().unwrap().0;
    let left = s.faultless(cut, 0.01).volume;
    assert!(
        left < 0.99 * whole && left > 0.8 * whole,
        "{left} of {whole}"
    );
    s.ask(Command::Objects(midair_studio::objects::Ask::Select {
        ids: vec![cut],
        how: midair_studio::objects::How::Set,
    }));
    s.ask(Command::Keep {
        objects: Vec::new(),
    });
    s.settle();
    let shelf = s.world().resource::<midair_studio::project::Shelf>();
    let own = shelf.library.categories();
    let own: Vec<String> = own
        .filter(|(name, _)| *name == midair_library::OWN)
        .flat_map(|(_, all)| all)
        .map(|c| c.id.clone())
        .collect();
    assert_eq!(own.len(), 1, "{:?}", s.warnings());
    let again = s.place(&own[0], HERE + Vec3::X);
    let again = s.faultless(again, 0.01).volume;
    assert!((again / left - 1.0).abs() < 0.01, "{again}, not {left}");
    assert_eq!(s.warnings(), [] as [String; 0]);
}

/// Nobody presses both triggers at once: the other hand's is held first, for as long as it takes to aim.
#[test]
fn the_other_hands_trigger_erases_however_long_it_is_held() {
    for skeleton in ["Point", "Line", "Polygon", "Volume"] {
        let mut s = painter("Point");
        drag(&mut s, HERE, HERE + Vec3::X * 0.3);
        let before = s.undo_len();
        set(&mut s, "brush.skeleton", &format!("\"{skeleton}\""));
        s.press(Side::Left, Action::Act);
        s.frames(90);
        s.reach(Side::Right, HERE + Vec3::X * 0.15);
        s.frames(90);
        set(&mut s, "brush.skeleton", "\"Point\"");
        s.click(Side::Right, Action::Act);
        s.let_go(Side::Left, Action::Act);
        s.frames(2);
        let painted = strokes(&s);
        assert_eq!(s.undo_len(), before + 1, "{skeleton}");
        assert!(painted.strokes[1].erase, "{skeleton}");
        let at = painted.strokes[1].skeleton.clone();
        let Skeleton::Points(points) = at else {
            panic!("a point")
        };
        assert!(points[0].truncate().distance(Vec3::X * 0.15) < 1e-4);
    }
    // A hand that goes on paints, whichever it is.
    let mut s = painter("Point");
    s.press(Side::Left, Action::Act);
    let at = s.pose(Side::Left).position;
    s.put(Side::Left, Pose::at(at + Vec3::Y * 0.2));
    s.frames(40);
    s.click(Side::Right, Action::Act);
    s.let_go(Side::Left, Action::Act);
    assert_eq!(strokes(&s).strokes.len(), 1);
    assert!(!strokes(&s).strokes[0].erase);
}
