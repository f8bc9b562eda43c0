//! The line around what a material moves: the same shape, moved alike, a little wider and seen from inside. A line around
//! the shape as it was modelled would lie within it.

use bevy::camera::visibility::NoFrustumCulling;
use bevy::light::{NotShadowCaster, NotShadowReceiver};
use bevy::prelude::*;
use bevy::render::render_resource::Face;

use super::lines::line;
use crate::materials::{Living, MaterialShelf};
use crate::settings::Settings;
use crate::show::{Cues, ObjectEntity};

/// A line that a material draws: a child of what it is around.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
pub struct Hull {
    around: Entity,
    of: AssetId<Living>,
    colour: Color,
    width: f32,
}

/// Objects whose material moves them, each with its hull while it is touched or selected.
pub(super) fn hulls(
    (cues, settings, shelf): (Res<Cues>, Res<Settings>, Res<MaterialShelf>),
    objects: Query<(Entity, &ObjectEntity, &Mesh3d, &MeshMaterial3d<Living>)>,
    mut hulls: Query<
        (Entity, &mut Hull, &mut Mesh3d, &mut MeshMaterial3d<Living>),
        Without<ObjectEntity>,
    >,
    mut materials: ResMut<Assets<Living>>,
    mut commands: Commands,
) {
    if objects.is_empty() && hulls.is_empty() {
        return;
    }
    let wanted = |around: Entity, materials: &Assets<Living>| {
        let (_, object, mesh, look) = objects.get(around).ok()?;
        let moved = materials.get(&look.0)?.extension.place();
        if !shelf.shifts(moved) {
            return None;
        }
        let (colour, width) = line(settings.look.room, cues.0.get(&object.0)?)?;
        let of = look.0.id();
        let hull = Hull {
            around,
            of,
            colour,
            width,
        };
        Some((hull, mesh.0.clone()))
    };
    let mut there = Vec::new();
    for (entity, mut hull, mut mesh, mut look) in &mut hulls {
        let Some((wanted, shape)) = wanted(hull.around, &materials) else {
            commands.entity(entity).try_despawn();
            continue;
        };
        there.push(wanted.around);
        if *hull != wanted {
            let Some(drawn) = drawn(&wanted, &mut materials) else {
                continue;
            };
            look.0 = drawn;
            *hull = wanted;
        }
        mesh.set_if_neq(Mesh3d(shape));
    }
    for (entity, ..) in &objects {
        if there.contains(&entity) {
            continue;
        }
        let Some((hull, shape)) = wanted(entity, &materials) else {
            continue;
        };
        let Some(drawn) = drawn(&hull, &mut materials) else {
            continue;
        };
        commands.spawn((
            Name::new("Line around what moves"),
            hull,
            Mesh3d(shape),
            MeshMaterial3d(drawn),
            // It has no shadow, and reaches as far as the material does.
            (NotShadowCaster, NotShadowReceiver, NoFrustumCulling),
            ChildOf(entity),
        ));
    }
}

/// What a hull is drawn with.
fn drawn(hull: &Hull, materials: &mut Assets<Living>) -> Option<Handle<Living>> {
    let mut look = materials.get(hull.of)?.clone();
    look.extension = look.extension.line(hull.width);
    look.base = StandardMaterial {
        base_color: hull.colour,
        unlit: true,
        cull_mode: match look.base.cull_mode {
            Some(Face::Front) => Some(Face::Back),
            _ => Some(Face::Front),
        },
        ..default()
    };
    Some(materials.add(look))
}

#[cfg(test)]
mod tests {
    use bevy::ecs::system::RunSystemOnce;
    use bevy::shader::Shader;
    use midair_document::ObjectId;

    use super::*;
    use crate::materials::Written;

    fn lines(material: &str) -> World {
        let mut world = World::new();
        let mut cues = Cues::default();
        cues.entry(ObjectId(1)).selected = true;
        let mut shelf = MaterialShelf::default();
        let place = shelf.all().iter().position(|m| m.id == material).unwrap();
        shelf.ready(place, &mut Assets::<Shader>::default());
        let mut materials = Assets::<Living>::default();
        let look = materials.add(Living {
            base: StandardMaterial::default(),
            extension: Written::new(place, &[], true),
        });
        world.insert_resource(cues);
        world.insert_resource(shelf);
        world.insert_resource(materials);
        world.init_resource::<Settings>();
        world.spawn((
            ObjectEntity(ObjectId(1)),
            Mesh3d::default(),
            MeshMaterial3d(look),
        ));
        world.run_system_once(hulls).unwrap();
        world
    }

    fn count(world: &mut World) -> usize {
        world.query::<&Hull>().iter(world).count()
    }

    #[test]
    fn what_a_material_moves_has_a_line_that_moves_alike() {
        let mut world = lines("jelly");
        let (hull, parent, look) = world
            .query::<(&Hull, &ChildOf, &MeshMaterial3d<Living>)>()
            .single(&world)
            .map(|(h, p, l)| (*h, p.parent(), l.0.clone()))
            .unwrap();
        assert_eq!(parent, hull.around);
        let drawn = world.resource::<Assets<Living>>().get(&look).unwrap();
        assert_eq!(drawn.base.cull_mode, Some(Face::Front));
        assert_eq!(drawn.base.base_color, hull.colour);
        world.run_system_once(hulls).unwrap();
        assert_eq!(count(&mut world), 1);
        // Another line in its place, and none.
        world.resource_mut::<Cues>().entry(ObjectId(1)).touched = true;
        world.run_system_once(hulls).unwrap();
        let wider = world.query::<&Hull>().single(&world).unwrap();
        assert!(wider.width > hull.width);
        world.resource_mut::<Cues>().0.clear();
        world.run_system_once(hulls).unwrap();
        assert_eq!(count(&mut world), 0);
    }

    #[test]
    fn what_is_drawn_as_it_was_modelled_has_the_common_one() {
        assert_eq!(count(&mut lines("plush")), 0);
    }
}
