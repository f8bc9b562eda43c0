use glam::{Vec2, Vec3};
use midair_mesh::Aabb;
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// The most points the contours of one primitive may have together.
pub const MAX_CONTOUR_POINTS: usize = 65_536;

/// The most points a [`Primitive::Convex`] may have.
pub const MAX_HULL_POINTS: usize = 4_096;

/// No length of a primitive may exceed this, in metres.
pub const MAX_LENGTH: f32 = 1.0e5;

/// An exact primitive about the origin, +Y its axis where it has one. All lengths in metres.
///
/// Unless a variant says otherwise its field is the true Euclidean distance, inside and outside.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Primitive {
    /// A ball.
    Sphere {
        /// Radius.
        radius: f32,
    },
    /// A box: `half` extents, edges rounded by `rounding` (0 is sharp); the outer
    /// size is `half` whatever the rounding.
    Cuboid {
        /// Half extents along x, y, z.
        half: Vec3,
        /// Edge radius, at most the smallest half extent.
        #[serde(default)]
        rounding: f32,
    },
    /// A cylinder along y, its two rims rounded by `rounding`.
    Cylinder {
        /// Radius.
        radius: f32,
        /// Half height along y.
        half_height: f32,
        /// Edge radius.
        #[serde(default)]
        rounding: f32,
    },
    /// A cone or frustum along y: `bottom` radius at −half_height, `top` radius at +half_height.
    Frustum {
        /// Radius at the bottom.
        bottom: f32,
        /// Radius at the top (0 makes a cone).
        top: f32,
        /// Half height along y.
        half_height: f32,
    },
    /// A ring around y. A tube wider than the ring (`minor` > `major`) closes its middle; the
    /// distance is then a lower bound inside.
    Torus {
        /// From the axis to the middle of the tube.
        major: f32,
        /// The tube's radius.
        minor: f32,
    },
    /// A segment along y of half length `half_height`, `radius` around it.
    Capsule {
        /// Radius of the caps.
        radius: f32,
        /// Half the distance between the cap centres.
        half_height: f32,
    },
    /// Closed outlines in the xy plane, extruded along z by ±half_height. Contours combine by the
    /// even-odd rule, so inner ones are holes. Rounding rounds the rims and the convex corners;
    /// near a rounded rim with concave corners the distance is a lower bound.
    Extrusion {
        /// Closed polygons; the last point joins the first.
        contours: Vec<Vec<Vec2>>,
        /// Half thickness along z.
        half_height: f32,
        /// Edge radius; the outer size stays.
        #[serde(default)]
        rounding: f32,
    },
    /// A closed outline (radius, y) turned around y. Rounding rounds the convex corners of the
    /// outline, those on the axis excepted.
    Revolution {
        /// Closed polygons of (radius ≥ 0, y), even-odd.
        contours: Vec<Vec<Vec2>>,
        /// Edge radius; the outer size stays.
        #[serde(default)]
        rounding: f32,
    },
    /// The convex hull of points: pyramids, wedges, polyhedra.
    Convex {
        /// Corner points; the solid is their convex hull.
        points: Vec<Vec3>,
    },
    /// A round tube of radius `minor` wound around y, centred on the origin, with rounded ends.
    /// Where neighbouring turns melt into each other the distance inside is a lower bound.
    Helix {
        /// From the axis to the middle of the tube.
        major: f32,
        /// The tube's radius.
        minor: f32,
        /// Rise per turn along +y, turning from +x to +z; negative winds the other way.
        pitch: f32,
        /// Number of turns.
        turns: f32,
    },
    /// A ball stretched to half extents `half`.
    Ellipsoid {
        /// Half extents.
        half: Vec3,
    },
}

/// Why a primitive cannot be made; one line for the person who wrote it.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum PrimitiveError {
    /// A length is NaN, infinite, zero, negative or absurd.
    #[error("{what} is {value}; it must be more than 0 and at most 100000 metres")]
    Length {
        /// Which length, e.g. `sphere radius`.
        what: &'static str,
        /// The number given.
        value: String,
    },
    /// A coordinate is NaN, infinite or absurd.
    #[error("{what} has the point {value}; coordinates must be finite and within 100000 metres")]
    Coordinate {
        /// Which primitive.
        what: &'static str,
        /// The point given.
        value: String,
    },
    /// The rounding is negative, NaN, or larger than the shape.
    #[error("{what} rounding is {value}; it must lie between 0 and {limit}")]
    Rounding {
        /// Which primitive.
        what: &'static str,
        /// The number given.
        value: String,
        /// The largest possible.
        limit: String,
    },
    /// Too few or too many points.
    #[error("{what} has {count} points; between {least} and {most} are possible")]
    Count {
        /// Which primitive.
        what: &'static str,
        /// How many it has.
        count: usize,
        /// The fewest possible.
        least: usize,
        /// The most possible.
        most: usize,
    },
    /// The points enclose nothing.
    #[error("{0} encloses nothing: its points lie on one line or plane")]
    Flat(&'static str),
    /// A profile crosses the axis it turns about.
    #[error("revolution has a point at radius {0}; the outline must stay at radius 0 or more")]
    Axis(String),
    /// Too many or too few turns.
    #[error("helix turns is {0}; it must be more than 0 and at most 1000")]
    Turns(String),
    /// A rise per turn that is zero or not a number.
    #[error("helix pitch is {0}; it must be a finite number other than 0")]
    Pitch(String),
}

impl Primitive {
    /// The box around the solid, in metres; tight except for a helix's ends.
    pub fn bounds(&self) -> Aabb {
        let round = |r: f32, h: f32| Aabb::around(Vec3::ZERO, Vec3::new(r, h, r));
        match self {
            Self::Sphere { radius } => Aabb::around(Vec3::ZERO, Vec3::splat(*radius)),
            Self::Cuboid { half, .. } | Self::Ellipsoid { half } => Aabb::around(Vec3::ZERO, *half),
            Self::Cylinder {
                radius,
                half_height,
                ..
            } => round(*radius, *half_height),
            Self::Frustum {
                bottom,
                top,
                half_height,
            } => round(bottom.max(*top), *half_height),
            Self::Torus { major, minor } => round(major + minor, *minor),
            Self::Capsule {
                radius,
                half_height,
            } => round(*radius, half_height + radius),
            Self::Extrusion {
                contours,
                half_height,
                ..
            } => {
                let (lo, hi) = extent(contours);
                Aabb::new(lo.extend(-half_height), hi.extend(*half_height))
            }
            Self::Revolution { contours, .. } => {
                let (lo, hi) = extent(contours);
                Aabb::new(Vec3::new(-hi.x, lo.y, -hi.x), Vec3::new(hi.x, hi.y, hi.x))
            }
            Self::Convex { points } => points.iter().fold(Aabb::EMPTY, |b, &p| b.including(p)),
            Self::Helix {
                major,
                minor,
                pitch,
                turns,
            } => round(major + minor, 0.5 * (pitch * turns).abs() + minor),
        }
    }

    /// Whether the numbers describe a solid. Everything that passes can be evaluated.
    ///
    /// # Errors
    /// The first number that does not fit, in one line. Points on one plane are found when the
    /// shape is compiled.
    pub fn validate(&self) -> Result<(), PrimitiveError> {
        match self {
            Self::Sphere { radius } => length("sphere radius", *radius),
            Self::Cuboid { half, rounding } => {
                lengths("box half extent", *half)?;
                round("box", *rounding, half.min_element())
            }
            Self::Cylinder {
                radius,
                half_height,
                rounding,
            } => {
                length("cylinder radius", *radius)?;
                length("cylinder half height", *half_height)?;
                round("cylinder", *rounding, radius.min(*half_height))
            }
            Self::Frustum {
                bottom,
                top,
                half_height,
            } => {
                length("frustum half height", *half_height)?;
                // One of the two may be zero: a cone.
                length("frustum radius", bottom.max(*top))?;
                length("frustum radius", bottom.min(*top) + f32::MIN_POSITIVE)
            }
            Self::Torus { major, minor } => {
                length("torus major radius", *major)?;
                length("torus minor radius", *minor)
            }
            Self::Capsule {
                radius,
                half_height,
            } => {
                length("capsule radius", *radius)?;
                length("capsule half height", half_height + f32::MIN_POSITIVE)
            }
            Self::Extrusion {
                contours,
                half_height,
                rounding,
            } => {
                length("extrusion half height", *half_height)?;
                outline("extrusion", contours)?;
                round("extrusion", *rounding, *half_height)
            }
            Self::Revolution { contours, rounding } => {
                outline("revolution", contours)?;
                let (lo, hi) = extent(contours);
                if lo.x < 0.0 {
                    return Err(PrimitiveError::Axis(lo.x.to_string()));
                }
                round("revolution", *rounding, (hi - lo).min_element())
            }
            Self::Convex { points } => {
                let what = "convex hull";
                count(what, points.len(), 4, MAX_HULL_POINTS)?;
                points.iter().try_for_each(|p| coordinate(what, *p))
            }
            Self::Helix {
                major,
                minor,
                pitch,
                turns,
            } => {
                length("helix major radius", *major)?;
                length("helix minor radius", *minor)?;
                if !(*turns > 0.0 && *turns <= 1000.0) {
                    return Err(PrimitiveError::Turns(turns.to_string()));
                }
                if !(pitch.abs() >= 1.0e-6 && pitch.abs() <= MAX_LENGTH) {
                    return Err(PrimitiveError::Pitch(pitch.to_string()));
                }
                length("helix height", (pitch * turns).abs())
            }
            Self::Ellipsoid { half } => lengths("ellipsoid half extent", *half),
        }
    }
}

pub(crate) fn extent(contours: &[Vec<Vec2>]) -> (Vec2, Vec2) {
    contours
        .iter()
        .flatten()
        .fold((Vec2::INFINITY, Vec2::NEG_INFINITY), |(lo, hi), p| {
            (lo.min(*p), hi.max(*p))
        })
}

fn length(what: &'static str, value: f32) -> Result<(), PrimitiveError> {
    if value > 0.0 && value <= MAX_LENGTH {
        return Ok(());
    }
    Err(PrimitiveError::Length {
        what,
        value: value.to_string(),
    })
}

fn lengths(what: &'static str, v: Vec3) -> Result<(), PrimitiveError> {
    v.to_array().into_iter().try_for_each(|x| length(what, x))
}

fn round(what: &'static str, value: f32, limit: f32) -> Result<(), PrimitiveError> {
    // A millionth of slack: a half extent and its rounding are often the same decimal number.
    if value >= 0.0 && value <= limit * 1.000_001 {
        return Ok(());
    }
    Err(PrimitiveError::Rounding {
        what,
        value: value.to_string(),
        limit: limit.to_string(),
    })
}

fn count(
    what: &'static str,
    count: usize,
    least: usize,
    most: usize,
) -> Result<(), PrimitiveError> {
    if (least..=most).contains(&count) {
        return Ok(());
    }
    Err(PrimitiveError::Count {
        what,
        count,
        least,
        most,
    })
}

fn coordinate(what: &'static str, p: Vec3) -> Result<(), PrimitiveError> {
    if p.is_finite() && p.abs().max_element() <= MAX_LENGTH {
        return Ok(());
    }
    Err(PrimitiveError::Coordinate {
        what,
        value: p.to_string(),
    })
}

fn outline(what: &'static str, contours: &[Vec<Vec2>]) -> Result<(), PrimitiveError> {
    let total = contours.iter().map(Vec::len).sum();
    count(what, total, 3, MAX_CONTOUR_POINTS)?;
    for c in contours {
        count(what, c.len(), 3, MAX_CONTOUR_POINTS)?;
        c.iter().try_for_each(|p| coordinate(what, p.extend(0.0)))?;
    }
    let (lo, hi) = extent(contours);
    if (hi - lo).min_element() > 0.0 {
        Ok(())
    } else {
        Err(PrimitiveError::Flat(what))
    }
}
