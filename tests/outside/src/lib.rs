//! Pebbles: a mode in under a hundred lines. The act button drops a pebble at that hand.

use std::sync::Arc;

use bevy::prelude::*;
use midair_document::{Edit, Kind, Object, ObjectId};
use midair_mesh::TriMesh;
use midair_studio::StudioSet;
use midair_studio::hands::{Action, Hands, Haptic, Side};
use midair_studio::notice::Notices;
use midair_studio::project::Project;
use midair_studio::tools::{AddTool, Hints, Tool, ToolId, tool_active};

/// The mode's name in files.
pub const PEBBLES: ToolId = ToolId::new("example/pebbles");

/// The mode.
pub struct PebblesPlugin;

impl Plugin for PebblesPlugin {
    fn build(&self, app: &mut App) {
        app.add_tool(Tool {
            id: PEBBLES,
            name: "Pebbles",
            about: "Drop pebbles",
            order: 90,
        })
        .add_systems(
            Update,
            (
                drop_pebble.in_set(StudioSet::Act),
                hint.in_set(StudioSet::Cue),
            )
                .run_if(tool_active(PEBBLES)),
        );
    }
}

fn drop_pebble(
    mut hands: ResMut<Hands>,
    mut project: ResMut<Project>,
    mut notices: ResMut<Notices>,
) {
    for side in Side::BOTH {
        if !hands.get(side).pressed(Action::Act) {
            continue;
        }
        let mesh = pebble(0.03);
        let kind = Kind::Foreign {
            tool: PEBBLES.to_string(),
            data: "(radius: 0.03)".to_owned(),
            bounds: mesh.bounds(),
            mesh: project.meshes().insert(Arc::new(mesh)),
        };
        let id = ObjectId(project.document().next_id());
        let mut object = Object::new("Pebble", kind);
        object.placement.translation = hands.get(side).pose.position;
        let object = object.into();
        project.commit("Drop pebble", [Edit::Add { id, object }], &mut notices);
        hands.pulse(side, Haptic::Done);
    }
}

fn hint(mut hints: ResMut<Hints>) {
    hints.begin("Pebbles").say(Action::Act, "drop one");
}

/// An octahedron of the given radius in metres.
fn pebble(radius: f32) -> TriMesh {
    let positions = [
        Vec3::X,
        Vec3::NEG_X,
        Vec3::Y,
        Vec3::NEG_Y,
        Vec3::Z,
        Vec3::NEG_Z,
    ];
    let mut mesh = TriMesh {
        positions: positions.map(|p| p * radius).to_vec(),
        normals: Vec::new(),
        triangles: vec![
            [0, 2, 4],
            [2, 1, 4],
            [1, 3, 4],
            [3, 0, 4],
            [2, 0, 5],
            [1, 2, 5],
            [3, 1, 5],
            [0, 3, 5],
        ],
    };
    mesh.compute_normals();
    mesh
}
