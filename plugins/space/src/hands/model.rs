//! The shape of a wand, in metres from its tip; it points along −Z and its pad looks up.

use std::f32::consts::FRAC_PI_2;

use bevy::prelude::*;

/// What is pressed on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Part {
    Trigger,
    Grip,
    Pad,
    Menu,
    Up,
    Right,
    Down,
    Left,
}

/// The middle of the pad.
const PAD: Vec3 = Vec3::new(0.0, 0.016, 0.125);
/// From there to an arm.
const ARM: f32 = 0.012;

impl Part {
    /// Where it is.
    pub fn place(self) -> Vec3 {
        match self {
            Self::Trigger => Vec3::new(0.0, -0.022, 0.105),
            Self::Grip => Vec3::new(0.0, -0.030, 0.165),
            Self::Pad => PAD,
            Self::Menu => Vec3::new(0.0, 0.017, 0.153),
            Self::Up => PAD + ARM * Vec3::NEG_Z,
            Self::Right => PAD + ARM * Vec3::X,
            Self::Down => PAD + ARM * Vec3::Z,
            Self::Left => PAD + ARM * Vec3::NEG_X,
        }
    }

    /// Where its name stands: around the wand, none before another.
    pub fn label(self) -> Vec3 {
        match self {
            Self::Trigger => Vec3::new(0.075, -0.035, 0.085),
            Self::Grip => Vec3::new(-0.075, -0.035, 0.165),
            Self::Pad => Vec3::new(0.0, 0.075, 0.115),
            Self::Menu => Vec3::new(0.075, 0.012, 0.180),
            Self::Up => Vec3::new(0.0, 0.045, 0.050),
            Self::Right => Vec3::new(0.085, 0.040, 0.120),
            Self::Down => Vec3::new(-0.030, 0.020, 0.215),
            Self::Left => Vec3::new(-0.085, 0.040, 0.120),
        }
    }
}

/// What a piece looks like.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Look {
    Body,
    Button,
    Bright,
}

/// One piece of a wand.
pub(super) struct Made {
    pub mesh: Mesh,
    pub place: Transform,
    pub part: Option<Part>,
    pub look: Look,
}

/// All of them.
pub(super) fn pieces() -> Vec<Made> {
    let lying = Quat::from_rotation_x(FRAC_PI_2);
    let piece = |mesh: Mesh, place: Transform, part: Option<Part>, look: Look| Made {
        mesh,
        place,
        part,
        look,
    };
    let at = |part: Part| Transform::from_translation(part.place());
    // What works is the tip: a small ball, so that one sees what it touches.
    let mut all = vec![
        piece(
            Sphere::new(0.004).mesh().uv(16, 10),
            Transform::IDENTITY,
            None,
            Look::Bright,
        ),
        piece(
            ConicalFrustum {
                radius_top: 0.0022,
                radius_bottom: 0.0075,
                height: 0.085,
            }
            .mesh()
            .resolution(20)
            .build(),
            Transform::from_xyz(0.0, 0.0, 0.0445).with_rotation(Quat::from_rotation_x(-FRAC_PI_2)),
            None,
            Look::Bright,
        ),
        // The head that carries the pad, and the handle that lies in the hand.
        piece(
            Capsule3d::new(0.019, 0.050)
                .mesh()
                .latitudes(10)
                .longitudes(22)
                .build(),
            Transform::from_xyz(0.0, -0.002, 0.125)
                .with_rotation(lying)
                .with_scale(Vec3::new(1.15, 1.0, 0.85)),
            None,
            Look::Body,
        ),
        piece(
            Capsule3d::new(0.0155, 0.080)
                .mesh()
                .latitudes(10)
                .longitudes(20)
                .build(),
            Transform::from_xyz(0.0, -0.028, 0.190)
                .with_rotation(Quat::from_rotation_x(FRAC_PI_2 + 0.45)),
            None,
            Look::Body,
        ),
        piece(
            Cylinder::new(0.0155, 0.004).mesh().resolution(28).build(),
            at(Part::Pad),
            Some(Part::Pad),
            Look::Button,
        ),
        piece(
            Cylinder::new(0.0048, 0.005).mesh().resolution(18).build(),
            at(Part::Menu),
            Some(Part::Menu),
            Look::Bright,
        ),
        piece(
            Capsule3d::new(0.0065, 0.016)
                .mesh()
                .latitudes(8)
                .longitudes(14)
                .build(),
            at(Part::Trigger).with_rotation(Quat::from_rotation_x(0.5)),
            Some(Part::Trigger),
            Look::Button,
        ),
    ];
    for side in [-1.0, 1.0] {
        all.push(piece(
            Cuboid::new(0.004, 0.010, 0.032).into(),
            at(Part::Grip)
                .with_rotation(Quat::from_rotation_x(0.45))
                .mul_transform(Transform::from_xyz(0.0145 * side, 0.0, 0.0)),
            Some(Part::Grip),
            Look::Button,
        ));
    }
    for arm in [Part::Up, Part::Right, Part::Down, Part::Left] {
        all.push(piece(
            Sphere::new(0.0018).mesh().uv(10, 6),
            at(arm)
                .with_scale(Vec3::new(1.0, 0.6, 1.0))
                .mul_transform(Transform::from_xyz(0.0, 0.003, 0.0)),
            Some(arm),
            Look::Bright,
        ));
    }
    all
}
