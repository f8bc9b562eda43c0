use std::collections::HashSet;
use std::mem::size_of;

use midair_field::{Node, Skeleton, Stroke};

use super::Edit;
use crate::recipes::walk;
use crate::{Dials, Kind, Object};

impl Edit {
    /// Bytes of memory held, at most: parts shared with the document are counted here too.
    pub(crate) fn bytes(&self, seen: &mut HashSet<midair_field::RecipeHash>) -> usize {
        size_of::<Self>()
            + match self {
                Self::Add { object, .. }
                | Self::Restore { object, .. }
                | Self::Replace { object, .. } => {
                    size_of::<Object>()
                        + object.name.len()
                        + object.material.as_ref().map_or(0, String::len)
                        + dial_bytes(&object.dials)
                        + size_of_val(&object.links[..])
                        + kind_bytes(&object.kind, seen)
                }
                Self::SetLinks { links, .. } => size_of_val(&links[..]),
                Self::SetKind { kind, .. } => kind_bytes(kind, seen),
                Self::SetStrokes { strokes, .. } => {
                    let one = |stroke: &Stroke| {
                        let mut bytes = stroke_bytes(stroke);
                        if let Skeleton::Volume(recipe) = &stroke.skeleton {
                            walk(recipe, seen, &mut |r| bytes += node_bytes(r.node()));
                        }
                        bytes
                    };
                    strokes.iter().map(one).sum()
                }
                Self::Rename { name, .. } => name.len(),
                Self::SetMaterial {
                    material, dials, ..
                } => material.as_ref().map_or(0, String::len) + dial_bytes(dials),
                Self::SetPending { pending } => size_of_val(&pending[..]),
                Self::AddLayer { layer, .. }
                | Self::RestoreLayer { layer, .. }
                | Self::ReplaceLayer { layer, .. } => layer.name.len(),
                Self::AddGroup { group, .. }
                | Self::RestoreGroup { group, .. }
                | Self::ReplaceGroup { group, .. } => group.name.len(),
                Self::Composite { name, edits } => {
                    name.len() + edits.iter().map(|e| e.bytes(seen)).sum::<usize>()
                }
                _ => 0,
            }
    }
}

/// A name and a number each, and their share of the tree.
fn dial_bytes(dials: &Dials) -> usize {
    dials.keys().map(|name| 48 + name.len()).sum()
}

fn kind_bytes(kind: &Kind, seen: &mut HashSet<midair_field::RecipeHash>) -> usize {
    match kind {
        Kind::Foreign { tool, data, .. } => tool.len() + data.len(),
        // Its picture is the store's, once for the whole session.
        Kind::Reference(_) => 0,
        Kind::Line(line) => line.bytes(),
        Kind::Stroke(stroke) => stroke.bytes(),
        Kind::Solid(recipe) | Kind::Sheet(recipe) => {
            let mut bytes = 0;
            walk(recipe, seen, &mut |r| bytes += node_bytes(r.node()));
            bytes
        }
    }
}

fn node_bytes(node: &Node) -> usize {
    use midair_field::{Operand, Primitive};
    // The hash and the two counters of the shared pointer.
    let own = size_of::<Node>() + 48;
    own + match node {
        Node::Solid(operands) => operands.len() * size_of::<Operand>(),
        Node::Component { id, .. } => id.len(),
        Node::Foreign { tool, data, .. } => tool.len() + data.len(),
        Node::Primitive(Primitive::Extrusion { contours, .. })
        | Node::Primitive(Primitive::Revolution { contours, .. }) => {
            contours.iter().map(|c| 24 + 8 * c.len()).sum()
        }
        Node::Primitive(Primitive::Convex { points }) => 12 * points.len(),
        Node::Canvas(canvas) => canvas.strokes.iter().map(stroke_bytes).sum(),
        Node::Sweep(sweep) => size_of_val(&sweep.ribs[..]),
        Node::Clones { row, .. } => size_of_val(&row.ribs[..]),
        Node::Primitive(_) | Node::Mesh { .. } => 0,
    }
}

/// Points are shared with every other state of the canvas that has this stroke; they count once
/// more here, which errs on the safe side.
fn stroke_bytes(stroke: &Stroke) -> usize {
    size_of::<Stroke>()
        + match &stroke.skeleton {
            Skeleton::Points(points) => 16 * points.len(),
            Skeleton::Polygon(corners) => 12 * corners.len(),
            Skeleton::Line(..) | Skeleton::Volume(_) => 0,
        }
}
