//! From what a hand did in the world to a stroke in the frame of a painting.

use bevy::math::Affine3A;
use bevy::prelude::*;
use midair_field::{CANVAS_THRESHOLD, Node, Placement, Recipe, Skeleton, Stroke};
use midair_studio::{hands::Pose, project::Shelf, symmetry::Image};

/// Why there is no stroke: one line with the way out.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StrokeFault {
    /// A line without a length.
    #[error(
        "Both ends of the line are at one point: move the hand before the second, or take the point brush."
    )]
    ZeroLine,
    /// Too few corners.
    #[error(
        "A polygon has four corners or more, this one has {0}: press once at each corner, then finish."
    )]
    Corners(usize),
    /// Corners that enclose nothing.
    #[error("The corners of the polygon enclose nothing: set one of them aside from the others.")]
    NoArea,
    /// A corner where there is one.
    #[error("There is a corner at that place already: move the hand on, or finish.")]
    SameCorner,
    /// A solid that is none.
    #[error(
        "\"{0}\" has no volume and cannot be a brush: give it a thickness, or take another one."
    )]
    NoVolume(String),
    /// A mesh that was not made yet, so that nobody knows whether it encloses anything.
    #[error(
        "\"{0}\" is still being made ready as a brush: press again when it is seen at the hand."
    )]
    NotReady(String),
    /// A volume brush that is not there.
    #[error("The library has no brush \"{0}\": choose another one on the panel.")]
    NoBrush(String),
    /// Erasing where nothing is.
    #[error("There is nothing to erase yet: paint first, or touch what to paint on and finish.")]
    NothingToErase,
}

/// The frame of a painting that stands in the world.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    to_local: Affine3A,
    rotation: Quat,
    scale: f32,
}

impl Frame {
    /// Of a painting that stands there. Where it is scaled unevenly, lengths are scaled by the mean.
    pub fn of(placement: &Placement) -> Self {
        let s = placement.scale.abs();
        Self {
            to_local: placement.affine().inverse(),
            rotation: placement.rotation.inverse(),
            scale: (s.x * s.y * s.z).cbrt(),
        }
    }

    /// A point of the world.
    pub fn point(&self, p: Vec3) -> Vec3 {
        self.to_local.transform_point3(p)
    }

    /// A length of the world.
    pub fn length(&self, l: f32) -> f32 {
        l / self.scale
    }
}

/// Radii a hand moves before a led point gets another point: fine enough for the eye, since
/// between two points the stroke is straight.
const SPACING: f32 = 0.15;

/// Whether a led point that was at `last` (w its radius, metres) goes on to `at`.
pub fn goes_on(last: Vec4, at: Vec4) -> bool {
    let thinner = last.w.min(at.w);
    last.truncate().distance(at.truncate()) >= SPACING * thinner
        || (last.w - at.w).abs() >= 0.1 * thinner
}

/// A point, or the way it was led. `way` is in the world, w its radius there.
pub fn led(way: &[Vec4], frame: &Frame) -> Stroke {
    let first = way.first().map_or(1.0, |p| p.w);
    let points = way
        .iter()
        .map(|p| frame.point(p.truncate()).extend(p.w / first));
    Stroke::new(Skeleton::Points(points.collect()), frame.length(first))
}

/// A line between two points of the world.
///
/// # Errors
/// The two are one.
pub fn line(
    from: Vec3,
    to: Vec3,
    radius: f32,
    reach: f32,
    frame: &Frame,
) -> Result<Stroke, StrokeFault> {
    if from.distance(to) < 1e-3 * radius {
        return Err(StrokeFault::ZeroLine);
    }
    let skeleton = Skeleton::Line(frame.point(from), frame.point(to));
    Ok(fitted(Stroke::new(skeleton, frame.length(radius)), reach))
}

/// A flat area between corners of the world, four or more.
///
/// # Errors
/// Too few corners, or none that enclose something.
pub fn polygon(
    corners: &[Vec3],
    radius: f32,
    reach: f32,
    frame: &Frame,
) -> Result<Stroke, StrokeFault> {
    if corners.len() < 4 {
        return Err(StrokeFault::Corners(corners.len()));
    }
    let normal = newell(corners);
    let size = corners
        .iter()
        .map(|c| c.distance_squared(corners[0]))
        .fold(0.0, f32::max);
    if normal.length() <= 1e-4 * size {
        return Err(StrokeFault::NoArea);
    }
    let corners = corners.iter().map(|&c| frame.point(c)).collect();
    let stroke = Stroke::new(Skeleton::Polygon(corners), frame.length(radius));
    Ok(fitted(stroke, reach))
}

/// How far corners lie from the plane that fits them, metres: they are brought into it.
pub fn out_of_plane(corners: &[Vec3]) -> f32 {
    let middle = corners.iter().sum::<Vec3>() / corners.len().max(1) as f32;
    let normal = newell(corners).normalize_or_zero();
    corners
        .iter()
        .map(|c| (*c - middle).dot(normal).abs())
        .fold(0.0, f32::max)
}

fn newell(corners: &[Vec3]) -> Vec3 {
    let n = corners.len();
    let from = corners.first().copied().unwrap_or_default();
    (0..n)
        .map(|i| (corners[i] - from).cross(corners[(i + 1) % n] - from))
        .sum()
}

/// A solid held in a hand, its longest side `size` metres of the world.
///
/// # Errors
/// It encloses nothing.
pub fn volume(
    (name, recipe): (&str, &Recipe),
    held: &Placement,
    frame: &Frame,
) -> Result<Stroke, StrokeFault> {
    let bounds = recipe.bounds();
    let sides = bounds.size();
    if bounds.is_empty() || sides.min_element() <= 1e-5 * sides.max_element() {
        return Err(StrokeFault::NoVolume(name.to_owned()));
    }
    let stroke = Stroke::new(Skeleton::Volume(recipe.clone()), melt(recipe));
    Ok(Stroke {
        placement: Placement {
            translation: frame.point(held.translation),
            rotation: (frame.rotation * held.rotation).normalize(),
            scale: held.scale / frame.scale,
        },
        ..stroke
    })
}

/// Where a hand holds a volume brush: its middle at the tip.
pub fn held(recipe: &Recipe, pose: &Pose, size: f32) -> Placement {
    let bounds = recipe.bounds();
    let longest = if bounds.is_empty() {
        1.0
    } else {
        bounds.size().max_element().max(1e-6)
    };
    let scale = size / longest;
    let middle = if bounds.is_empty() {
        Vec3::ZERO
    } else {
        bounds.centre()
    };
    Placement {
        translation: pose.position - pose.rotation * (scale * middle),
        rotation: pose.rotation,
        scale: Vec3::splat(scale),
    }
}

/// The image of a stroke under live symmetry, in a painting that stands there.
pub fn mirrored(stroke: &Stroke, painting: &Placement, image: &Image) -> Stroke {
    let own = &stroke.placement;
    let stands = Placement {
        translation: painting.affine().transform_point3(own.translation),
        rotation: (painting.rotation * own.rotation).normalize(),
        scale: painting.scale * own.scale,
    };
    let there = image.placement(&stands);
    Stroke {
        placement: Placement {
            translation: painting
                .affine()
                .inverse()
                .transform_point3(there.translation),
            rotation: (painting.rotation.inverse() * there.rotation).normalize(),
            scale: there.scale / painting.scale,
        },
        ..stroke.clone()
    }
}

/// Whether a stroke and its image are one: a led point is with every image, since what is led twice over
/// one place does not swell. A line or an area is where it goes across to the other side or lies
/// between the two; one that ends there superposes, and two halves are the whole. Solids melt into each
/// other as ever.
pub fn meets_image(stroke: &Stroke, painting: &Placement, image: &Image) -> bool {
    let ends: &[Vec3] = match &stroke.skeleton {
        Skeleton::Points(_) => return true,
        Skeleton::Volume(_) => return false,
        Skeleton::Line(a, b) => &[*a, *b],
        Skeleton::Polygon(corners) => corners,
    };
    let stands = painting.affine() * stroke.placement.affine();
    let near = 0.2 * stroke.radius * painting.scale.abs().max_element();
    let ways: Vec<Vec3> = ends
        .iter()
        .map(|p| stands.transform_point3(*p))
        .map(|p| image.point(p) - p)
        .filter(|way| way.length() > near)
        .collect();
    ways.is_empty() || ways.iter().any(|a| ways.iter().any(|b| a.dot(*b) < 0.0))
}

/// How far a solid melts into what it meets, in its own metres: it follows the size of the brush.
pub fn melt(recipe: &Recipe) -> f32 {
    let bounds = recipe.bounds();
    let longest = if bounds.is_empty() {
        0.1
    } else {
        bounds.size().max_element()
    };
    (0.08 * longest).max(1e-5)
}

/// A line or an area that is short still has its surface at its radius.
fn fitted(stroke: Stroke, reach: f32) -> Stroke {
    Stroke {
        weight: stroke.fitted_weight(reach),
        ..stroke
    }
}

/// About how far a point of the painting lies from a stroke's surface, metres; negative inside.
pub fn distance(stroke: &Stroke, p: Vec3) -> f32 {
    let to_own = stroke.placement.affine().inverse();
    let q = to_own.transform_point3(p);
    let scale = stroke.placement.scale.abs().min_element();
    let own = match &stroke.skeleton {
        Skeleton::Points(points) => {
            let ends = points.windows(2).map(|w| {
                let (a, b) = (w[0], w[1]);
                let t = along(q, a.truncate(), b.truncate());
                let at = a.lerp(b, t);
                at.truncate().distance(q) - at.w * stroke.radius
            });
            let first = points
                .first()
                .map(|a| a.truncate().distance(q) - a.w * stroke.radius);
            ends.chain(first).fold(f32::INFINITY, f32::min)
        }
        Skeleton::Line(a, b) => a.lerp(*b, along(q, *a, *b)).distance(q) - stroke.radius,
        Skeleton::Polygon(corners) => from_polygon(corners, q) - stroke.radius,
        // A box lies around its solid: what is nearer than that comes first.
        Skeleton::Volume(recipe) => {
            let b = recipe.bounds();
            let out = (b.min - q).max(q - b.max);
            let away = out.max(Vec3::ZERO).length();
            away + out.max_element().min(0.0) * 0.25
        }
    };
    own * scale
}

fn along(q: Vec3, a: Vec3, b: Vec3) -> f32 {
    let way = b - a;
    ((q - a).dot(way) / way.length_squared().max(1e-20)).clamp(0.0, 1.0)
}

fn from_polygon(corners: &[Vec3], q: Vec3) -> f32 {
    let normal = newell(corners).normalize_or_zero();
    let n = corners.len();
    let mut nearest = f32::INFINITY;
    let mut turns = 0.0;
    let flat = q - normal * (q - corners[0]).dot(normal);
    for i in 0..n {
        let (a, b) = (corners[i], corners[(i + 1) % n]);
        nearest = nearest.min(a.lerp(b, along(q, a, b)).distance(q));
        let (u, v) = (a - flat, b - flat);
        turns += u.cross(v).dot(normal).atan2(u.dot(v));
    }
    if turns.abs() > std::f32::consts::PI {
        nearest.min((q - corners[0]).dot(normal).abs())
    } else {
        nearest
    }
}

/// What a stroke is called in a list.
pub fn name(stroke: &Stroke) -> &'static str {
    match (&stroke.skeleton, stroke.erase) {
        (Skeleton::Points(p), false) if p.len() == 1 => "Point",
        (Skeleton::Points(_), false) => "Drawn point",
        (Skeleton::Points(_), true) => "Erased",
        (Skeleton::Line(..), false) => "Line",
        (Skeleton::Line(..), true) => "Erased line",
        (Skeleton::Polygon(_), false) => "Polygon",
        (Skeleton::Polygon(_), true) => "Erased polygon",
        (Skeleton::Volume(recipe), false) if matches!(recipe.node(), Node::Canvas(_)) => {
            "Painted volume"
        }
        (Skeleton::Volume(_), false) => "Volume",
        (Skeleton::Volume(_), true) => "Erased volume",
    }
}

/// What a stroke is called where there is room for more: a volume of the library by its name there.
pub fn called(stroke: &Stroke, shelf: &Shelf) -> String {
    let Skeleton::Volume(recipe) = &stroke.skeleton else {
        return name(stroke).to_owned();
    };
    let mut all = shelf.library.components().iter();
    match all.find(|c| c.recipe == *recipe) {
        Some(found) if stroke.erase => format!("Erased {}", found.name.to_lowercase()),
        Some(found) => found.name.clone(),
        None => name(stroke).to_owned(),
    }
}

/// The middle of a stroke, in the painting's frame.
pub fn middle(stroke: &Stroke) -> Vec3 {
    let own = match &stroke.skeleton {
        Skeleton::Points(points) => {
            points.iter().map(|p| p.truncate()).sum::<Vec3>() / points.len().max(1) as f32
        }
        Skeleton::Line(a, b) => a.midpoint(*b),
        Skeleton::Polygon(corners) => corners.iter().sum::<Vec3>() / corners.len().max(1) as f32,
        Skeleton::Volume(recipe) if recipe.bounds().is_empty() => Vec3::ZERO,
        Skeleton::Volume(recipe) => recipe.bounds().centre(),
    };
    stroke.placement.affine().transform_point3(own)
}

/// The stroke `factor` times as large, about its own middle.
pub fn resized(stroke: &Stroke, factor: f32) -> Stroke {
    let about = middle(stroke);
    let mut next = stroke.clone();
    next.placement.scale *= factor;
    next.placement.translation = about + (stroke.placement.translation - about) * factor;
    next
}

/// The finest thing of a stroke, metres in the painting: what a step has to show.
pub fn finest(stroke: &Stroke) -> f32 {
    let scale = stroke.placement.scale.abs().min_element();
    let own = match &stroke.skeleton {
        Skeleton::Points(points) => {
            let thinnest = points.iter().map(|p| p.w).fold(f32::INFINITY, f32::min);
            thinnest * stroke.radius
        }
        Skeleton::Volume(recipe) if recipe.bounds().is_empty() => f32::INFINITY,
        Skeleton::Volume(recipe) => 0.5 * recipe.bounds().size().min_element(),
        _ => stroke.radius,
    };
    // A weight below 1 draws the surface in.
    own * scale
        * if stroke.weight < CANVAS_THRESHOLD {
            0.5
        } else {
            1.0
        }
}

#[cfg(test)]
mod tests {
    use super::*;
    use midair_field::Primitive;

    fn moved() -> Frame {
        Frame::of(&Placement {
            translation: Vec3::new(1.0, 2.0, 3.0),
            rotation: Quat::from_rotation_y(0.5),
            scale: Vec3::splat(2.0),
        })
    }

    #[test]
    fn a_way_is_brought_into_the_frame_of_the_painting() {
        let way = [
            Vec4::new(1.0, 2.0, 3.0, 0.04),
            Vec4::new(1.0, 2.2, 3.0, 0.02),
        ];
        let stroke = led(&way, &moved());
        assert!((stroke.radius - 0.02).abs() < 1e-6);
        let Skeleton::Points(points) = &stroke.skeleton else {
            panic!()
        };
        assert!(points[0].truncate().length() < 1e-6);
        assert!(points[1].abs_diff_eq(Vec4::new(0.0, 0.1, 0.0, 0.5), 1e-6));
    }

    #[test]
    fn what_cannot_be_painted_says_why() {
        let frame = Frame::of(&Placement::IDENTITY);
        assert_eq!(
            line(Vec3::ONE, Vec3::ONE, 0.1, 1.75, &frame),
            Err(StrokeFault::ZeroLine)
        );
        let corners = [Vec3::ZERO, Vec3::X, Vec3::X * 2.0, Vec3::X * 3.0];
        assert_eq!(
            polygon(&corners, 0.1, 1.75, &frame),
            Err(StrokeFault::NoArea)
        );
        assert_eq!(
            polygon(&corners[..3], 0.1, 1.75, &frame),
            Err(StrokeFault::Corners(3))
        );
        let sheet = Recipe::new(Node::Mesh {
            mesh: midair_mesh_hash(),
            bounds: midair_field_box(),
        });
        let stroke = volume(("Sheet", &sheet), &Placement::IDENTITY, &frame);
        assert_eq!(stroke, Err(StrokeFault::NoVolume("Sheet".into())));
    }

    fn midair_mesh_hash() -> midair_mesh::MeshHash {
        midair_mesh::MeshHash([0; 32])
    }

    fn midair_field_box() -> midair_mesh::Aabb {
        midair_mesh::Aabb::around(Vec3::ZERO, Vec3::new(1.0, 0.0, 1.0))
    }

    #[test]
    fn the_nearest_stroke_is_told_apart() {
        let frame = Frame::of(&Placement::IDENTITY);
        let a = led(&[Vec4::new(0.0, 0.0, 0.0, 0.1)], &frame);
        let b = line(Vec3::X, Vec3::X * 2.0, 0.1, 1.75, &frame).unwrap();
        let square = [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 0.0, 1.0), Vec3::Z];
        let c = polygon(&square, 0.05, 1.75, &frame).unwrap();
        let at = Vec3::new(0.0, 0.12, 0.0);
        assert!((distance(&a, at) - 0.02).abs() < 1e-5);
        assert!((distance(&b, Vec3::new(1.5, 0.3, 0.0)) - 0.2).abs() < 1e-5);
        assert!((distance(&c, Vec3::new(0.5, 0.2, 0.5)) - 0.15).abs() < 1e-5);
        assert!((distance(&c, Vec3::new(-0.3, 0.0, 0.5)) - 0.25).abs() < 1e-5);
    }

    #[test]
    fn a_larger_stroke_stays_where_it_is() {
        let frame = Frame::of(&Placement::IDENTITY);
        let stroke = line(Vec3::X, Vec3::X * 2.0, 0.1, 1.75, &frame).unwrap();
        let larger = resized(&stroke, 3.0);
        assert!(middle(&larger).distance(middle(&stroke)) < 1e-5);
        assert!((finest(&larger) - 0.3).abs() < 1e-5);
    }

    #[test]
    fn a_held_volume_has_its_middle_at_the_tip() {
        let ball = Recipe::from(Primitive::Cuboid {
            half: Vec3::new(0.1, 0.2, 0.1),
            rounding: 0.0,
        });
        let pose = Pose::at(Vec3::ONE);
        let at = held(&ball, &pose, 0.8);
        assert!((at.scale.x - 2.0).abs() < 1e-5);
        let stroke = volume(("Box", &ball), &at, &Frame::of(&Placement::IDENTITY)).unwrap();
        assert!(middle(&stroke).distance(Vec3::ONE) < 1e-5);
    }
}
