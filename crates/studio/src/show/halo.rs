//! A gap around strokes: of two of one colour that cross, the one behind ends beside the one in front, as in a drawing by hand.
//! It is the inside of a slightly wider tube in the colour of the air. That hides nothing nearer than a stroke's own far side, so
//! nothing parts strokes where they meet.

use std::collections::VecDeque;

use bevy::light::{NotShadowCaster, NotShadowReceiver};
use bevy::pbr::wireframe::NoWireframe;
use bevy::prelude::*;
use bevy::render::render_resource::Face;
use midair_document::{DrawnStroke, Kind};
use midair_mesh::TriMesh;
use midair_solid::tube;

use super::ink::Inked;
use super::{Cues, ObjectEntity, to_bevy_mesh};
use crate::settings::{RoomKind, Settings};

/// How much wider than the stroke it is …
const WIDE: f64 = 1.5;
/// … and by how much at most to each side, in metres.
const MOST: f64 = 0.004;
/// Flat sides around it.
const SIDES: usize = 8;

/// The gap around a stroke: a child of what shows that.
#[derive(Component)]
pub(super) struct Halo;

/// What all of them are drawn with, made when first needed.
#[derive(Resource, Default)]
pub(super) struct HaloLook(Option<Handle<StandardMaterial>>);

/// So many are made in a frame, so that those of a drawing that is opened come over the next ones.
const A_FRAME: usize = 12;

/// Each stroke that was drawn anew has one anew.
pub(super) fn halos(
    changed: Query<Entity, Changed<Inked>>,
    strokes: Query<(&Inked, Option<&Children>)>,
    mut waiting: Local<VecDeque<Entity>>,
    halos: Query<(), With<Halo>>,
    settings: Res<Settings>,
    mut look: ResMut<HaloLook>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    mut commands: Commands,
) {
    waiting.extend(&changed);
    for _ in 0..A_FRAME {
        let Some(entity) = waiting.pop_front() else {
            return;
        };
        let Ok((inked, children)) = strokes.get(entity) else {
            continue;
        };
        for &child in children.into_iter().flatten() {
            if halos.contains(child) {
                commands.entity(child).try_despawn();
            }
        }
        let Some(Kind::Stroke(stroke)) = inked.kind() else {
            continue;
        };
        let look = look.0.get_or_insert_with(|| {
            materials.add(StandardMaterial {
                base_color: air(settings.look.room),
                unlit: true,
                // Its inside alone.
                cull_mode: Some(Face::Front),
                ..default()
            })
        });
        commands.spawn((
            Name::new("Gap around a stroke"),
            Halo,
            Mesh3d(meshes.add(to_bevy_mesh(&around(stroke)))),
            MeshMaterial3d(look.clone()),
            Visibility::Inherited,
            (NotShadowCaster, NotShadowReceiver, NoWireframe),
            ChildOf(entity),
        ));
    }
}

fn around(stroke: &DrawnStroke) -> TriMesh {
    let radius = 0.5 * stroke.width;
    let wide = (WIDE * radius).min(radius + MOST);
    tube(&stroke.points(), wide, stroke.closed, SIDES)
}

/// It has the colour of the room's air; where a stroke is seen through, or has a line around it, there is none.
pub(super) fn dress(
    (cues, settings): (Res<Cues>, Res<Settings>),
    look: Res<HaloLook>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    mut halos: Query<(&ChildOf, &mut Visibility), With<Halo>>,
    fresh: Query<(), Added<Halo>>,
    strokes: Query<&ObjectEntity>,
) {
    let Some(look) = &look.0 else { return };
    let wanted = air(settings.look.room);
    if materials.get(look).is_some_and(|m| m.base_color != wanted)
        && let Some(mut material) = materials.get_mut(look)
    {
        material.base_color = wanted;
    }
    if !cues.is_changed() && fresh.is_empty() {
        return;
    }
    for (child, mut visibility) in &mut halos {
        let stroke = strokes.get(child.parent()).ok();
        let cue = stroke.and_then(|id| cues.0.get(&id.0));
        let hidden = cue.is_some_and(|c| c.ghost || c.touched || c.selected);
        visibility.set_if_neq(if hidden {
            Visibility::Hidden
        } else {
            Visibility::Inherited
        });
    }
}

/// As it comes out on the screen it is what is behind a stroke at eye level, or nearly.
fn air(room: RoomKind) -> Color {
    match room {
        RoomKind::Dusk => Color::srgb_u8(0x34, 0x36, 0x3c),
        RoomKind::Day => Color::srgb_u8(0xec, 0xec, 0xee),
        RoomKind::Paper => Color::srgb_u8(0xff, 0xff, 0xff),
    }
}

#[cfg(test)]
mod tests {
    use bevy::ecs::system::RunSystemOnce;
    use bevy::math::DVec3;
    use midair_document::{ConstructionLine, ObjectId};

    use super::*;

    fn room(kind: Kind) -> World {
        let mut world = World::new();
        world.init_resource::<Cues>();
        world.init_resource::<Settings>();
        world.init_resource::<HaloLook>();
        world.init_resource::<Assets<Mesh>>();
        world.init_resource::<Assets<StandardMaterial>>();
        world.spawn((ObjectEntity(ObjectId(1)), Inked(Some((kind, 0)))));
        world.run_system_once(halos).unwrap();
        world
    }

    fn seen(world: &mut World) -> Vec<Visibility> {
        world.run_system_once(dress).unwrap();
        let mut halos = world.query_filtered::<&Visibility, With<Halo>>();
        halos.iter(world).copied().collect()
    }

    #[test]
    fn a_stroke_has_one_gap_unless_it_has_a_line_around_it() {
        let points = [DVec3::ZERO, DVec3::X, DVec3::ONE];
        let stroke = DrawnStroke::raw(points.to_vec(), 0.01);
        let mut world = room(Kind::Stroke(stroke.clone().into()));
        assert_eq!(seen(&mut world), [Visibility::Inherited]);
        // Drawn anew it has another in its place.
        let wide = Kind::Stroke(DrawnStroke::raw(points.to_vec(), 0.02).into());
        let mut inked = world.query::<&mut Inked>();
        *inked.single_mut(&mut world).unwrap() = Inked(Some((wide, 0)));
        world.run_system_once(halos).unwrap();
        assert_eq!(seen(&mut world).len(), 1);
        world.resource_mut::<Cues>().entry(ObjectId(1)).selected = true;
        assert_eq!(seen(&mut world), [Visibility::Hidden]);
        let tube = |s: &DrawnStroke| around(s).volume();
        let own = super::tube(&stroke.points(), 0.005, false, SIDES).volume();
        assert!(tube(&stroke) > 2.0 * own && tube(&stroke) < 2.5 * own);
    }

    #[test]
    fn a_construction_line_has_none_and_the_room_is_followed() {
        let line = ConstructionLine::raw(DVec3::ZERO, DVec3::X);
        assert!(seen(&mut room(Kind::Line(line))).is_empty());
        let stroke = DrawnStroke::raw(vec![DVec3::ZERO, DVec3::X], 0.01);
        let mut world = room(Kind::Stroke(stroke.into()));
        for room in [RoomKind::Dusk, RoomKind::Day, RoomKind::Paper] {
            world.resource_mut::<Settings>().look.room = room;
            seen(&mut world);
            let materials = world.resource::<Assets<StandardMaterial>>();
            let (_, look) = materials.iter().next().unwrap();
            assert_eq!(look.base_color, air(room));
            assert_eq!(look.cull_mode, Some(Face::Front));
        }
    }
}
