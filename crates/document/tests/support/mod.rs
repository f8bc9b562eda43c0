//! Documents and edits for tests.
#![allow(dead_code, missing_docs)]

use glam::{DVec3, Quat, Vec3};
use midair_document::{
    Colour, ConstructionLine, Document, DrawnStroke, Edit, Group, GroupId, Kept, Kind, Layer,
    LayerId, Link, MeshStore, Object, ObjectId, Relation, Through,
};
use midair_field::{Node, Op, Operand, Placement, Primitive, Recipe};
use midair_mesh::TriMesh;

/// Three numbers decide an edit; most are possible, some must be refused.
pub type Dice = (u8, u16, u16);

pub fn tetrahedron(size: f32) -> TriMesh {
    TriMesh {
        positions: vec![Vec3::ZERO, Vec3::X * size, Vec3::Y * size, Vec3::Z * size],
        normals: Vec::new(),
        triangles: vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
    }
}

pub fn ball(radius: f32) -> Recipe {
    Primitive::Sphere { radius }.into()
}

pub fn mesh_recipe(meshes: &MeshStore, size: f32) -> Recipe {
    let mesh = tetrahedron(size);
    let bounds = mesh.bounds();
    let mesh = meshes.insert(mesh);
    Recipe::new(Node::Mesh { mesh, bounds })
}

pub fn foreign(meshes: &MeshStore, size: f32) -> Object {
    let mesh = tetrahedron(size);
    let bounds = mesh.bounds();
    let mesh = meshes.insert(mesh);
    let kind = Kind::Foreign {
        tool: "vase".into(),
        data: "(turns: 3, \"quoted\",\n\t\\ odd: '\u{1F3FA}')".into(),
        mesh,
        bounds,
    };
    Object::new("Vase", kind)
}

pub fn fuse(parts: impl IntoIterator<Item = (Op, Placement, Recipe)>) -> Recipe {
    let operand = |(op, placement, recipe)| Operand {
        op,
        placement,
        recipe,
        muted: false,
    };
    Recipe::new(Node::Solid(parts.into_iter().map(operand).collect()))
}

/// A construction line; one in eight is none.
pub fn line(size: f32, n: u16) -> Kind {
    let size = f64::from(size);
    let end = if n % 8 == 7 { f64::NAN } else { size };
    let mut line = ConstructionLine::raw(DVec3::ZERO, DVec3::new(end, 0.1 / 3.0, -size));
    line.ticks = (0..n % 3).map(|i| (f64::from(i) + 1.0) / 7.0).collect();
    line.kept.push(Kept {
        relation: [Relation::Square, Relation::Meets][usize::from(n % 2)],
        end: (n % 2 == 1).then_some(true),
        with: (n % 4 > 1).then_some(ObjectId(u64::from(n))),
    });
    Kind::Line(line)
}

/// A stroke; one in eight is none.
pub fn stroke(size: f32, n: u16) -> Kind {
    let size = f64::from(size);
    let end = if n % 8 == 7 { f64::INFINITY } else { size };
    let points = [0.0, 1.0, 2.0, end].map(|x| DVec3::new(x * size, 1.0 / (3.0 + x), size));
    let mut stroke = DrawnStroke::raw(points.to_vec(), 0.008);
    if n.is_multiple_of(2) {
        stroke.segments = vec![points];
        stroke.through.push(Through {
            point: points[1],
            of_scaffold: true,
            along_line: n.is_multiple_of(3),
        });
        stroke.reading.auto = true;
    }
    Kind::Stroke(stroke.into())
}

fn op(n: u16) -> Op {
    [Op::Union, Op::Intersect, Op::Subtract][n as usize % 3]
}

fn placement(n: u16) -> Placement {
    let x = f32::from(n) * 0.001;
    Placement {
        translation: Vec3::new(x, -x, 0.1),
        rotation: Quat::from_rotation_y(x).normalize(),
        scale: Vec3::splat(1.0 + x),
    }
}

/// The edit that the dice ask for in this document.
pub fn edit(document: &Document, meshes: &MeshStore, (kind, a, b): Dice) -> Edit {
    let pick = |ids: Vec<u64>, n: u16| match ids.len() {
        0 => 9_999,
        len => ids[n as usize % len],
    };
    let id = ObjectId(pick(document.objects().map(|(id, _)| id.0).collect(), a));
    let layer = LayerId(pick(document.layers().map(|(id, _)| id.0).collect(), b));
    let group = GroupId(pick(document.groups().map(|(id, _)| id.0).collect(), b));
    let other = GroupId(pick(document.groups().map(|(id, _)| id.0).collect(), a));
    let next = document.next_id();
    let number = f32::from(b % 50) * 0.01 + 0.01;
    match kind % 31 {
        0..=3 => Edit::Add {
            id: ObjectId(next),
            object: Object::solid(format!("Ball {b}"), ball(number))
                .placed(placement(b))
                .into(),
        },
        4 => Edit::Add {
            id: ObjectId(next),
            object: foreign(meshes, number).into(),
        },
        5 => Edit::Remove { id },
        6 | 7 => Edit::SetPlacement {
            id,
            placement: placement(b),
        },
        8 => Edit::Rename {
            id,
            name: format!("\"{b}\" ü\n"),
        },
        9 => Edit::SetVisible {
            id,
            visible: b % 2 == 0,
        },
        10 => Edit::SetLocked {
            id,
            locked: b % 2 == 0,
        },
        11 => Edit::SetColour {
            id,
            colour: (b % 3 > 0).then_some(Colour([b as u8, 7, 9])),
        },
        12 => Edit::SetMaterial {
            id,
            material: (b % 3 > 0).then(|| format!("glass-{b}")),
            dials: (0..b % 4)
                .map(|i| (format!("dial {i}"), b as f32))
                .collect(),
        },
        13 => Edit::AddLayer {
            id: LayerId(next),
            layer: Layer::new(format!("Layer {b}")),
        },
        14 => Edit::SetLayer { id, layer },
        15 => Edit::RemoveLayer { id: layer },
        16 => {
            let members: Vec<ObjectId> = document.objects().map(|(id, _)| id).collect();
            let from = a as usize % (members.len() + 1);
            document.group_edit("Group", &members[from..])
        }
        17 => document.ungroup_edit(group),
        18 => Edit::ReplaceGroup {
            id: other,
            group: Group {
                name: "Moved".into(),
                parent: Some(group),
            },
        },
        19 | 20 => Edit::SetMark {
            id,
            op: (b % 4 > 0).then(|| op(b)),
        },
        21 => Edit::SetStep {
            step: number * 0.05,
        },
        22 => Edit::set_recipe(id, mesh_recipe(meshes, number)),
        23 => Edit::SetFresh {
            id,
            fresh: b % 2 == 0,
        },
        25 => Edit::SetDimmed {
            id,
            dimmed: b % 2 == 0,
        },
        26 => Edit::Add {
            id: ObjectId(next),
            object: Object::new("Line", line(number, a)).into(),
        },
        27 => Edit::Add {
            id: ObjectId(next),
            object: Object::new("Stroke", stroke(number, b)).into(),
        },
        28 => Edit::SetKind {
            id,
            kind: if b % 2 == 0 {
                line(number, b)
            } else {
                stroke(number, a)
            },
        },
        24 => Edit::SetPlacement {
            id,
            placement: Placement::at(Vec3::new(f32::NAN, 0.0, 0.0)),
        },
        30 => Edit::SetLinks {
            id,
            links: (0..b % 3)
                .map(|part| Link {
                    source: id,
                    part: part.into(),
                })
                .collect(),
        },
        _ => fuse_pending(document, next),
    }
}

/// What fusing the marked operands does: one result instead of them.
fn fuse_pending(document: &Document, next: u64) -> Edit {
    let parts = document.pending().iter().filter_map(|&(id, op)| {
        let object = document.object(id)?;
        Some((op, object.placement, object.recipe()?.clone()))
    });
    let mut object = Object::solid("Result", fuse(parts));
    object.fresh = true;
    let mut edits = vec![Edit::Add {
        id: ObjectId(next),
        object: object.into(),
    }];
    let operands = document.pending().iter();
    edits.extend(operands.map(|&(id, _)| Edit::Remove { id }));
    Edit::Composite {
        name: "Fuse".into(),
        edits,
    }
}

/// An open sheet, the plate it is with a thickness, and a row of balls along its first curve.
pub fn swept() -> (Recipe, Recipe, Recipe) {
    use midair_field::{Node, Profile, Rib, Row, Sweep};
    let rib = |z: f32| Rib {
        points: [[-0.1, 0.0, z].into(), [0.1, 0.0, z].into()],
        tangents: [[0.1, 0.2, 0.0].into(), [0.1, -0.2, 0.0].into()],
        slopes: [0.5, 1.0],
        start: Default::default(),
        twist: 12.5,
    };
    let sheet = Sweep {
        ribs: (0..5).map(|i| rib(0.02 * i as f32)).collect(),
        count: 12,
        profile: Profile::Sheet,
        thickness: 0.0,
        caps: false,
    };
    let plate = Sweep {
        thickness: 0.01,
        ..sheet.clone()
    };
    let row = Row {
        ribs: sheet.ribs[..1].into(),
        count: 5,
        size: 1.0,
        paced: true,
    };
    let recipe = ball(0.02);
    (
        Recipe::new(Node::Sweep(sheet)),
        Recipe::new(Node::Sweep(plate)),
        Recipe::new(Node::Clones { row, recipe }),
    )
}
