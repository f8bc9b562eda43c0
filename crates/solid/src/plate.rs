//! A loop that is drawn, filled: the plate that it outlines.

use glam::{DMat3, DVec2, DVec3, Mat3, Quat};
use midair_document::{Document, Kind, ObjectId, affine};
use midair_field::{MAX_CONTOUR_POINTS, Placement, Primitive, Recipe};

/// Why lines and strokes outline no plate; follows "… was not filled: ".
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum PlateFault {
    /// Nothing is drawn there.
    #[error("choose a closed stroke, or strokes and lines that meet end to end")]
    Nothing,
    /// Its ends do not meet.
    #[error(
        "it is not closed: its ends are {0:.3} m apart. Draw the piece that is missing, or end it where it begins"
    )]
    Open(f64),
    /// It does not lie in a plane.
    #[error(
        "it does not lie in a plane: it leaves the nearest one by {0:.3} m. Draw it on a plane or on lines that lie in one"
    )]
    Bent(f64),
    /// It has no area.
    #[error("it encloses nothing. Draw it wider")]
    Flat,
    /// More points than an outline may have.
    #[error("it has too many points. Correct it, or draw it shorter")]
    Points,
}

/// Ends nearer to each other than this, in metres, meet.
const MEETS: f64 = 2e-3;
/// How far a loop may leave its plane: as a share of its size, and in metres.
const LEAVES: (f64, f64) = (0.02, 1e-3);

/// The plate of `thickness` metres that lines and strokes outline together, and where it stands: its middle
/// plane is theirs.
///
/// # Errors
/// [`PlateFault`] where they outline none.
pub fn plate(
    document: &Document,
    ids: &[ObjectId],
    thickness: f32,
) -> Result<(Recipe, Placement), PlateFault> {
    let pieces = ids.iter().filter_map(|&id| {
        let object = document.object(id)?;
        let points = match &object.kind {
            Kind::Line(line) => line.ends().to_vec(),
            Kind::Stroke(stroke) => stroke.points(),
            _ => return None,
        };
        let there = affine(&object.placement);
        Some(points.iter().map(|&p| there.transform_point3(p)).collect())
    });
    filled(&ring(pieces.collect())?, thickness)
}

/// Pieces in any order and sense, joined end to end; without the last point, which is the first.
fn ring(mut pieces: Vec<Vec<DVec3>>) -> Result<Vec<DVec3>, PlateFault> {
    pieces.retain(|p| p.len() > 1);
    let mut ring = pieces.pop().ok_or(PlateFault::Nothing)?;
    while !pieces.is_empty() {
        let end = ring[ring.len() - 1];
        let far = |p: &Vec<DVec3>| p[0].distance(end).min(p[p.len() - 1].distance(end));
        let nearest = (0..pieces.len())
            .min_by(|&a, &b| far(&pieces[a]).total_cmp(&far(&pieces[b])))
            .filter(|&i| far(&pieces[i]) < MEETS);
        let Some(i) = nearest else {
            let gap = pieces.iter().map(far).fold(f64::INFINITY, f64::min);
            return Err(PlateFault::Open(gap));
        };
        let mut piece = pieces.swap_remove(i);
        if piece[0].distance(end) > piece[piece.len() - 1].distance(end) {
            piece.reverse();
        }
        ring.extend(piece.into_iter().skip(1));
    }
    let gap = ring[0].distance(ring[ring.len() - 1]);
    if gap > MEETS {
        return Err(PlateFault::Open(gap));
    }
    ring.pop();
    if ring.len() < 3 {
        return Err(PlateFault::Flat);
    }
    Ok(ring)
}

fn filled(ring: &[DVec3], thickness: f32) -> Result<(Recipe, Placement), PlateFault> {
    if ring.len() > MAX_CONTOUR_POINTS {
        return Err(PlateFault::Points);
    }
    let count = ring.len() as f64;
    let centre = ring.iter().sum::<DVec3>() / count;
    // Twice the area as a vector: the normal of the plane that the loop lies in.
    let area: DVec3 = (0..ring.len())
        .map(|i| (ring[i] - centre).cross(ring[(i + 1) % ring.len()] - centre))
        .sum();
    let size = ring.iter().map(|p| p.distance(centre)).fold(0.0, f64::max);
    let normal = area
        .try_normalize()
        .filter(|_| area.length() > 1e-3 * size * size)
        .ok_or(PlateFault::Flat)?;
    let off = ring
        .iter()
        .map(|p| (*p - centre).dot(normal).abs())
        .fold(0.0, f64::max);
    if off > (LEAVES.0 * size).max(LEAVES.1) {
        return Err(PlateFault::Bent(off));
    }
    let across = normal.any_orthonormal_vector();
    let frame = DMat3::from_cols(across, normal.cross(across), normal);
    let flat = |p: &DVec3| {
        let p = frame.transpose() * (*p - centre);
        DVec2::new(p.x, p.y).as_vec2()
    };
    let recipe = Primitive::Extrusion {
        contours: vec![ring.iter().map(flat).collect()],
        half_height: 0.5 * thickness,
        rounding: 0.0,
    };
    let columns = [frame.x_axis, frame.y_axis, frame.z_axis].map(|c| c.as_vec3());
    let rotation = Quat::from_mat3(&Mat3::from_cols(columns[0], columns[1], columns[2]));
    let placement = Placement {
        rotation: rotation.normalize(),
        ..Placement::at(centre.as_vec3())
    };
    Ok((recipe.into(), placement))
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::AtomicBool;

    use midair_document::{ConstructionLine, DrawnStroke, Edit, Object};

    use super::*;
    use crate::Solid;

    fn drawn(kinds: Vec<Kind>) -> (Document, Vec<ObjectId>) {
        let mut document = Document::new();
        let mut ids = Vec::new();
        for kind in kinds {
            let id = ObjectId(document.next_id());
            let object = Object::new("Stroke", kind).into();
            document.apply(&Edit::Add { id, object }).unwrap();
            ids.push(id);
        }
        (document, ids)
    }

    fn circle(bend: f64) -> Kind {
        let points = (0..=64).map(|i| {
            let t = std::f64::consts::TAU * f64::from(i % 64) / 64.0;
            DVec3::new(0.2 * t.cos(), 1.0 + bend * (2.0 * t).sin(), 0.2 * t.sin())
        });
        Kind::Stroke(DrawnStroke::raw(points.collect(), 0.008).into())
    }

    #[test]
    fn a_circle_becomes_a_disc() {
        let (document, ids) = drawn(vec![circle(0.0)]);
        let (recipe, placement) = plate(&document, &ids, 0.04).unwrap();
        let solid = Solid::make(&recipe, &placement, 0.005, &(), &AtomicBool::new(false)).unwrap();
        let exact = std::f64::consts::PI * 0.04 * 0.04;
        assert!(
            (solid.mesh().volume() / exact - 1.0).abs() < 0.02,
            "{}",
            solid.mesh().volume()
        );
        assert!((placement.translation.y - 1.0).abs() < 1e-6);
    }

    #[test]
    fn lines_in_any_order_and_sense_outline_a_square() {
        let c =
            [(0.0, 0.0), (0.3, 0.0), (0.3, 0.3), (0.0, 0.3)].map(|(x, y)| DVec3::new(x, y, 0.5));
        let lines = [(0, 1), (3, 2), (1, 2), (3, 0)]
            .map(|(a, b)| Kind::Line(ConstructionLine::raw(c[a], c[b])));
        let (document, ids) = drawn(lines.to_vec());
        let (recipe, placement) = plate(&document, &ids, 0.1).unwrap();
        let solid = Solid::make(&recipe, &placement, 0.005, &(), &AtomicBool::new(false)).unwrap();
        assert!((solid.mesh().volume() / 0.009 - 1.0).abs() < 0.02);
        assert!(matches!(
            plate(&document, &ids[..3], 0.1),
            Err(PlateFault::Open(_))
        ));
    }

    #[test]
    fn what_outlines_no_plate_says_why() {
        let (document, ids) = drawn(vec![circle(0.1)]);
        assert!(matches!(
            plate(&document, &ids, 0.01),
            Err(PlateFault::Bent(_))
        ));
        assert_eq!(plate(&document, &[], 0.01), Err(PlateFault::Nothing));
        let there_and_back = vec![DVec3::ZERO, DVec3::X, DVec3::ZERO];
        let kind = Kind::Stroke(DrawnStroke::raw(there_and_back, 0.01).into());
        let (document, ids) = drawn(vec![kind]);
        assert_eq!(plate(&document, &ids, 0.01), Err(PlateFault::Flat));
    }
}
