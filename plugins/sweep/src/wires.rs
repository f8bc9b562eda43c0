//! What is being swept, as a net of lines: only what is new is sent to the graphics card.
//!
//! The net is cut into pieces of [`PIECE`] curves. A full piece is sent once and never again; the last
//! one, with the curve that the hands hold now, is sent anew each frame. So the bytes of a frame do
//! not grow with the surface.

use bevy::asset::RenderAssetUsages;
use bevy::light::NotShadowCaster;
use bevy::mesh::{Indices, PrimitiveTopology};
use bevy::prelude::*;
use midair_document::ObjectId;
use midair_studio::settings::{Settings, SweepShape};
use midair_studio::{
    evaluate::Evaluations,
    project::Project,
    show::{ObjectMap, transform},
};
use midair_swept::{Net, Rib};

use crate::edit;
use crate::phase::{Draft, Phase};

/// Curves in one piece.
pub const PIECE: usize = 16;

/// Seconds for which the net stays after its surface is there: a picture or two later it is drawn.
const STAYS: f32 = 0.12;

/// The pieces of the net.
#[derive(Resource, Default)]
pub struct Wires {
    /// Full ones.
    pieces: Vec<Entity>,
    /// The last one, and the entity that shows it.
    tail: Option<(Entity, Handle<Mesh>)>,
    material: Option<Handle<StandardMaterial>>,
    /// How many curves full pieces hold.
    sent: usize,
    /// What the full pieces were made from: they are made anew where this changes.
    first: Option<(Rib, bool, u32)>,
    /// The curves the pieces were made from, to notice that they were smoothed.
    seam: Option<Rib>,
    bytes: usize,
    bent: bool,
    /// What was swept is not seen yet: the net stays until it has been for so many seconds.
    waits: Option<(ObjectId, f32)>,
    /// The curves of the last piece and their points: only the one that the hands hold is new in a frame.
    known: (Vec<Rib>, Vec<Vec3>),
}

impl Wires {
    /// Bytes handed over to be sent to the graphics card in the last frame.
    pub fn bytes(&self) -> usize {
        self.bytes
    }

    /// Full pieces so far.
    pub fn pieces(&self) -> usize {
        self.pieces.len()
    }

    /// Whether what was swept last is still shown as a net.
    pub fn waits(&self) -> bool {
        self.waits.is_some()
    }

    /// The net stays until the object it became is seen.
    pub(crate) fn wait_for(&mut self, object: ObjectId) {
        self.waits = Some((object, STAYS));
    }

    pub(crate) fn clear(&mut self, commands: &mut Commands) {
        self.waits = None;
        for entity in self.pieces.drain(..) {
            commands.entity(entity).try_despawn();
        }
        if let Some((entity, _)) = self.tail.take() {
            commands.entity(entity).try_despawn();
        }
        self.sent = 0;
        self.first = None;
        self.seam = None;
        self.bytes = 0;
        self.bent = false;
        self.known = (Vec::new(), Vec::new());
    }

    /// The net of the last piece's curves and the one that is held.
    fn last(&mut self, ribs: &[Rib], live: Option<&Rib>, closed: bool, count: usize) -> Net {
        let (known, points) = &mut self.known;
        if !ribs.starts_with(known) {
            known.clear();
            points.clear();
        }
        for rib in &ribs[known.len()..] {
            Net::row_into(rib, closed, count, points);
        }
        known.extend_from_slice(&ribs[known.len()..]);
        let mut points = points.clone();
        if let Some(live) = live {
            Net::row_into(live, closed, count, &mut points);
        }
        let rows = ribs.len() + usize::from(live.is_some());
        Net::through(points, rows, closed)
    }
}

pub(crate) fn draw(
    draft: Res<Draft>,
    settings: Res<Settings>,
    (project, evaluations, time): (Res<Project>, Res<Evaluations>, Res<Time>),
    (map, drawn_as): (
        Res<ObjectMap>,
        Query<(), Or<(With<Mesh3d>, With<Children>)>>,
    ),
    mut wires: ResMut<Wires>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    mut commands: Commands,
) {
    let wires = &mut *wires;
    if let Phase::Editing {
        object,
        grip: Some(grip),
        ..
    } = &draft.phase
    {
        // All of it moves at once: one mesh, of every curve that does.
        if let Some((sweep, placement)) = edit::curves(&project, *object) {
            let closed = sweep.profile == midair_swept::Profile::Tube;
            let net = Net::new(&grip.bent, closed, sweep.count.min(32) as usize);
            let (mesh, bytes) = drawn(net);
            wires.bytes = bytes;
            wires.bent = true;
            let at = transform(&placement);
            tail(wires, mesh, at, &mut meshes, &mut materials, &mut commands);
        }
        return;
    }
    if !draft.is_sweeping() || draft.ribs.is_empty() {
        if let Some((object, left)) = &mut wires.waits {
            let seen = map.get(*object).is_some_and(|e| drawn_as.contains(e));
            // Where it cannot be made, or what was swept is hidden, nothing will be seen either.
            if seen || evaluations.progress().next().is_none() {
                *left -= time.delta_secs();
            }
            // Taken back, or in the way of nothing any more.
            if project.document().object(*object).is_some() && *left > 0.0 {
                return;
            }
        }
        wires.waits = None;
        if !wires.pieces.is_empty() || wires.tail.is_some() {
            wires.clear(&mut commands);
        }
        return;
    }
    if settings.sweep.shape == SweepShape::Clones && !settings.sweep.spread {
        return;
    }
    let closed = settings.sweep.shape == SweepShape::Tube;
    let count = settings.sweep.count;
    let first = draft.ribs.first().map(|r| (*r, closed, count));
    let seam = wires.sent.checked_sub(1).and_then(|i| draft.ribs.get(i));
    if first != wires.first || seam != wires.seam.as_ref() || wires.bent {
        wires.clear(&mut commands);
        wires.first = first;
    }
    wires.bytes = 0;
    // A piece begins with the last curve of the one before, so that no gap is between them.
    while draft.ribs.len() > wires.sent + PIECE {
        let from = wires.sent.saturating_sub(1);
        wires.sent += PIECE;
        wires.seam = draft.ribs.get(wires.sent - 1).copied();
        let net = Net::new(&draft.ribs[from..wires.sent], closed, count as usize);
        let (mesh, bytes) = drawn(net);
        wires.bytes += bytes;
        let look = MeshMaterial3d(material(&mut wires.material, &mut materials));
        let mesh = Mesh3d(meshes.add(mesh));
        let piece = commands.spawn((
            Name::new("Wires"),
            mesh,
            look,
            Transform::IDENTITY,
            NotShadowCaster,
        ));
        wires.pieces.push(piece.id());
    }
    let ribs = &draft.ribs[wires.sent.saturating_sub(1)..];
    let net = wires.last(ribs, draft.live.as_ref(), closed, count as usize);
    let (mesh, bytes) = drawn(net);
    wires.bytes += bytes;
    tail(
        wires,
        mesh,
        Transform::IDENTITY,
        &mut meshes,
        &mut materials,
        &mut commands,
    );
}

fn tail(
    wires: &mut Wires,
    mesh: Mesh,
    at: Transform,
    meshes: &mut Assets<Mesh>,
    materials: &mut Assets<StandardMaterial>,
    commands: &mut Commands,
) {
    match &wires.tail {
        Some((_, handle)) => {
            // Only fails where the handle is gone, which this very table holds.
            let _ = meshes.insert(handle.id(), mesh);
        }
        None => {
            let handle = meshes.add(mesh);
            let look = MeshMaterial3d(material(&mut wires.material, materials));
            let drawn = (Mesh3d(handle.clone()), look, at, NotShadowCaster);
            let entity = commands.spawn((Name::new("Wires"), drawn)).id();
            wires.tail = Some((entity, handle));
        }
    }
}

fn material(
    kept: &mut Option<Handle<StandardMaterial>>,
    materials: &mut Assets<StandardMaterial>,
) -> Handle<StandardMaterial> {
    kept.get_or_insert_with(|| {
        materials.add(StandardMaterial {
            base_color: Color::srgb(0.78, 0.82, 0.92),
            unlit: true,
            ..default()
        })
    })
    .clone()
}

/// Handed over to be drawn.
fn drawn(mut net: Net) -> (Mesh, usize) {
    let bytes = net.bytes();
    if net.points.is_empty() {
        // The engine has no room for nothing.
        net.points.push(Vec3::ZERO);
        net.lines.extend([0, 0]);
    }
    let mesh = Mesh::new(
        PrimitiveTopology::LineList,
        RenderAssetUsages::RENDER_WORLD | RenderAssetUsages::MAIN_WORLD,
    )
    .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, net.points)
    .with_inserted_indices(Indices::U32(net.lines));
    (mesh, bytes)
}
