use bevy::math::Vec3;
use midair_document::{Document, Object, ObjectId};

/// The corners of an object's box, in world metres; nothing where it is empty.
pub(super) fn corners(object: &Object) -> impl Iterator<Item = Vec3> {
    let bounds = object.bounds();
    let affine = object.placement.affine();
    let count = if bounds.is_empty() { 0 } else { 8 };
    (0..count).map(move |i| {
        let pick = |axis: usize| {
            if i >> axis & 1 == 0 {
                bounds.min[axis]
            } else {
                bounds.max[axis]
            }
        };
        affine.transform_point3(Vec3::new(pick(0), pick(1), pick(2)))
    })
}

/// The box around objects, lowest and highest corner in world metres; `None` around nothing.
pub fn extent(
    document: &Document,
    ids: impl IntoIterator<Item = ObjectId>,
) -> Option<(Vec3, Vec3)> {
    let objects = ids.into_iter().filter_map(|id| document.object(id));
    let (low, high) = objects
        .flat_map(corners)
        .fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), p| {
            (low.min(p), high.max(p))
        });
    low.cmple(high).all().then_some((low, high))
}
