//! The brush before the trigger: position, size and angle (3DBrushVR §3).

use bevy::prelude::*;
use midair_studio::{
    evaluate::{Evaluations, Key},
    hands::{Hands, Side},
    hold::Held,
    panel::ACCENT,
    settings::BrushSkeleton,
    show::{Drawn, Readouts, transform},
};

use crate::{
    act,
    phase::{Draft, Phase},
    stroke,
    work::Studio,
};

/// What is seen at the hand.
#[derive(Resource, Default)]
pub struct Ghost {
    entity: Option<Entity>,
    ball: Option<Handle<Mesh>>,
    paints: Option<Handle<StandardMaterial>>,
    erases: Option<Handle<StandardMaterial>>,
}

impl Ghost {
    /// Whether there is one, and what shows it.
    pub fn entity(&self) -> Option<Entity> {
        self.entity
    }

    pub(crate) fn clear(&mut self, commands: &mut Commands) {
        if let Some(entity) = self.entity.take() {
            commands.entity(entity).try_despawn();
        }
    }
}

fn accent() -> Color {
    Color::srgb_u8(ACCENT.r(), ACCENT.g(), ACCENT.b())
}

fn look(colour: Color, alpha: f32) -> StandardMaterial {
    StandardMaterial {
        base_color: colour.with_alpha(alpha),
        alpha_mode: AlphaMode::Blend,
        perceptual_roughness: 0.8,
        emissive: colour.to_linear() * 0.1,
        ..default()
    }
}

pub(crate) fn show(
    mut studio: Studio,
    draft: Res<Draft>,
    hands: Res<Hands>,
    held: Res<Held>,
    mut evaluations: ResMut<Evaluations>,
    mut drawn: ResMut<Drawn>,
    mut ghost: ResMut<Ghost>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    mut commands: Commands,
) {
    let main = studio.settings.hands.main();
    let side = match draft.busy() {
        // Held where it went down, the other hand's trigger turns around what this one will do.
        Some(off) if off != main && act::rests(off, &hands, &draft, &studio) => main,
        busy => busy.or(draft.leading).unwrap_or(main),
    };
    let hand = hands.get(side);
    let editing = studio.easel.selected.is_some() || studio.easel.picking;
    let alt = *draft.phase(side.other()) == Phase::Alt
        || hands
            .get(side.other())
            .held(midair_studio::hands::Action::Act);
    let brush = studio.brush();
    let erase = if draft.busy() == Some(side) {
        draft.erase
    } else {
        brush.erase != alt
    };
    let radius = brush.radius / hands.metres_per_world;
    let seen = hand.tracked && held.get(side).is_none() && !editing;
    let (mut hollow, mut full) = (None, None);
    let skeleton = draft.skeleton(side).unwrap_or(brush.skeleton);
    let at = match skeleton {
        _ if !seen => None,
        BrushSkeleton::Volume => studio.volume().ok().and_then(|(_, recipe)| {
            let size = brush.size / hands.metres_per_world;
            // As fine as a thumbnail: it is only for the eye.
            let longest = recipe.bounds().size().max_element();
            let step = (longest / 72.0).clamp(1e-4, 1.0);
            let mut made = evaluations.want(&recipe, step)?;
            let mut key = Key::new(&recipe, step);
            if made.mesh.triangles.is_empty() {
                // Too thin for that, or without inside, as an open mesh can be.
                let fine = (longest / 320.0).clamp(1e-4, 1.0);
                made = evaluations.want(&recipe, fine)?;
                key = Key::new(&recipe, fine);
            }
            if made.mesh.triangles.is_empty() {
                hollow = Some(recipe.hash());
                return None;
            }
            full = Some(recipe.hash());
            let mesh = drawn.handle(key, &made, &mut meshes);
            let at = stroke::held(&recipe, &hand.pose, size);
            Some((mesh, transform(&at)))
        }),
        _ => {
            let ball = ghost
                .ball
                .get_or_insert_with(|| meshes.add(Sphere::new(1.0).mesh().uv(64, 32)));
            let at =
                Transform::from_translation(hand.pose.position).with_scale(Vec3::splat(radius));
            Some((ball.clone(), at))
        }
    };
    if hollow.is_some() {
        studio.easel.hollow = hollow;
    }
    if full.is_some() && studio.easel.full != full {
        studio.easel.full = full;
    }
    let Some((mesh, at)) = at else {
        ghost.clear(&mut commands);
        return;
    };
    let slot = if erase {
        ghost
            .erases
            .get_or_insert_with(|| materials.add(look(Color::srgb(0.06, 0.06, 0.07), 0.45)))
    } else {
        ghost
            .paints
            .get_or_insert_with(|| materials.add(look(accent(), 0.3)))
    };
    let material = MeshMaterial3d(slot.clone());
    match ghost.entity {
        Some(entity) => {
            commands
                .entity(entity)
                .try_insert((Mesh3d(mesh), material, at));
        }
        None => {
            let name = Name::new("Brush");
            let shadowless = bevy::light::NotShadowCaster;
            ghost.entity = Some(
                commands
                    .spawn((name, Mesh3d(mesh), material, at, shadowless))
                    .id(),
            );
        }
    }
}

/// As far upwards as it goes at a right angle to a way: what is said of a line stands over it.
fn beside(way: Vec3) -> Vec3 {
    let up = Vec3::Y.reject_from(way.normalize_or(Vec3::X));
    up.normalize_or(Vec3::X)
}

/// Ends, corners and the way of what is begun; the selected stroke.
pub(crate) fn lines(
    studio: Studio,
    draft: Res<Draft>,
    hands: Res<Hands>,
    gizmos: Option<Gizmos>,
    mut readouts: ResMut<Readouts>,
) {
    // Without a picture there is nothing to draw with.
    let Some(mut gizmos) = gizmos else { return };
    let colour = accent();
    for side in Side::BOTH {
        let now = hands.get(side).pose.position;
        match draft.phase(side) {
            Phase::Leading { way, now } => {
                // The last part, which the picture may not have yet.
                let last = way.iter().rev().take(24).map(|p| p.truncate());
                let trail: Vec<Vec3> = std::iter::once(now.truncate()).chain(last).collect();
                gizmos.linestrip(trail, colour);
            }
            Phase::Line { from } => {
                gizmos.line(*from, now, colour);
                let length = from.distance(now);
                let radius = studio.brush().radius / hands.metres_per_world;
                readouts.say(
                    from.midpoint(now) + beside(now - *from) * 1.3 * radius,
                    midair_studio::units::length(length, studio.settings.units.length),
                );
            }
            Phase::Polygon { corners } => {
                let all = corners.iter().copied().chain([now]);
                gizmos.linestrip(all, colour);
                if corners.len() > 2 {
                    gizmos.line(now, corners[0], colour.with_alpha(0.4));
                }
            }
            Phase::Idle | Phase::Alt | Phase::Stamping | Phase::Moving { .. } => {}
        }
    }
    let Some(selected) = studio.easel.selected else {
        return;
    };
    let Some((_, object, canvas)) = studio.easel.painting(studio.project.document()) else {
        return;
    };
    if let Some(stroke) = canvas.strokes.get(selected) {
        outline(stroke, &object.placement, &mut gizmos, colour);
        let middle = object
            .placement
            .affine()
            .transform_point3(stroke::middle(stroke));
        readouts.say(middle, format!("{} {}", stroke::name(stroke), selected + 1));
    }
}

fn outline(
    stroke: &midair_field::Stroke,
    painting: &midair_field::Placement,
    gizmos: &mut Gizmos,
    colour: Color,
) {
    use midair_field::Skeleton;
    let placed = painting.affine() * stroke.placement.affine();
    let at = |p: Vec3| placed.transform_point3(p);
    let scale = (painting.scale * stroke.placement.scale)
        .abs()
        .max_element();
    match &stroke.skeleton {
        Skeleton::Points(points) => {
            gizmos.linestrip(points.iter().map(|p| at(p.truncate())), colour);
            for p in points.first().into_iter().chain(points.last()) {
                gizmos.sphere(at(p.truncate()), p.w * stroke.radius * scale * 1.02, colour);
            }
        }
        Skeleton::Line(a, b) => {
            gizmos.line(at(*a), at(*b), colour);
            for p in [a, b] {
                gizmos.sphere(at(*p), stroke.radius * scale * 1.02, colour);
            }
        }
        Skeleton::Polygon(corners) => {
            let closed = corners.iter().chain(corners.first());
            gizmos.linestrip(closed.map(|&p| at(p)), colour);
        }
        Skeleton::Volume(recipe) => {
            let b = recipe.bounds();
            if b.is_empty() {
                return;
            }
            let cube = Transform::from_translation(b.centre()).with_scale(b.size());
            let placed = Mat4::from(placed) * cube.to_matrix();
            gizmos.cube(Transform::from_matrix(placed), colour);
        }
    }
}
