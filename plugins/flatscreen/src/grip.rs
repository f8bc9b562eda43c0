//! What the leading hand drags, and where to.

use bevy::prelude::*;

/// What the leading hand drags.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Grip {
    /// Metres from the camera, along its view.
    pub(crate) depth: f32,
    /// The plane it is dragged along, if one is in use.
    pub(crate) plane: Option<(Vec3, Dir3)>,
    /// Where the button went down, in pixels.
    pub(crate) from: Vec2,
    /// Whether it was dragged yet; a click that trembles moves nothing.
    pub(crate) moved: bool,
    /// Pixels that went into turning: the thing stays where it is meanwhile.
    pub(crate) spent: Vec2,
    /// It was let go over a panel, which is asked first whether it takes it.
    pub(crate) offered: bool,
}

impl Grip {
    /// The wheel: nearer or farther, or off the plane that it is dragged along.
    pub(crate) fn nearer(&mut self, lines: f32, eye: &Transform) {
        match &mut self.plane {
            Some((through, normal)) => {
                let away = through.distance(eye.translation);
                *through += **normal * (0.02 * away * lines);
            }
            None => self.depth = (self.depth * 1.05_f32.powf(lines)).clamp(0.05, 40.0),
        }
        self.moved = true;
    }

    /// Where it is dragged to; `None` where the plane is seen from its edge.
    pub(crate) fn at(&self, ray: &Ray3d, eye: &Transform) -> Option<Vec3> {
        let Some((through, normal)) = self.plane else {
            let along = ray.direction.dot(*eye.forward()).max(0.1);
            // The ray starts at the near plane, and without perspective even behind the eye.
            let ahead = (ray.origin - eye.translation).dot(*eye.forward());
            return Some(ray.get_point((self.depth - ahead) / along));
        };
        if ray.direction.dot(*normal).abs() < 0.03 {
            return None;
        }
        let far = ray.intersect_plane(through, InfinitePlane3d::new(*normal))?;
        (far > 0.0 && far < 40.0).then(|| ray.get_point(far))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_drag_along_a_plane_stays_on_it_and_the_wheel_lifts_it() {
        let eye = Transform::from_xyz(0.0, 1.0, 1.0).looking_at(Vec3::ZERO, Vec3::Y);
        let mut grip = Grip {
            depth: 1.0,
            plane: Some((Vec3::ZERO, Dir3::Y)),
            from: Vec2::ZERO,
            moved: true,
            spent: Vec2::ZERO,
            offered: false,
        };
        let towards = |x, y, z| Dir3::new(Vec3::new(x, y, z)).unwrap();
        let ray = |d| Ray3d {
            origin: eye.translation,
            direction: d,
        };
        let at = grip.at(&ray(towards(0.3, -1.0, -1.0)), &eye).unwrap();
        assert!(at.distance(Vec3::new(0.3, 0.0, 0.0)) < 1e-5, "{at}");
        // Seen from its edge, or beyond the horizon, it stays where it is.
        assert_eq!(grip.at(&ray(towards(0.0, 0.01, -1.0)), &eye), None);
        assert_eq!(grip.at(&ray(towards(0.0, 1.0, -1.0)), &eye), None);
        grip.nearer(2.0, &eye);
        let at = grip.at(&ray(towards(0.3, -1.0, -1.0)), &eye).unwrap();
        assert!(at.y > 0.01, "{at}");
    }
}
