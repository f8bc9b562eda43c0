//! Where in the window the pointer is, and how far into the view its hand reaches there.

use bevy::input::ButtonState;
use bevy::prelude::*;
use bevy::window::WindowEvent;
use midair_studio::{
    hands::{Pose, Side},
    plane::WorkPlane,
};

/// Where the pointer is in this frame, for all who ask: its hand and the handles have to agree on it.
#[derive(Resource, Clone, Copy, Debug, Default)]
pub(crate) struct Cursor {
    at: Option<Vec2>,
    /// Where it was when the last frame ended, in pixels.
    last: Option<Vec2>,
}

impl Cursor {
    /// In pixels of the window: where the left button went down or up in this frame, else where it is now.
    pub(crate) fn at(&self) -> Option<Vec2> {
        self.at
    }
}

/// In every frame, whoever leads: what was not followed while the gamepad led would be remembered wrongly.
pub(crate) fn follow(
    mut events: MessageReader<WindowEvent>,
    windows: Query<&Window>,
    mut cursor: ResMut<Cursor>,
) {
    let now = windows.iter().find_map(Window::cursor_position);
    let before = std::mem::replace(&mut cursor.last, now);
    let pressed = pressed_at(events.read(), before);
    let at = now.map(|now| pressed.unwrap_or(now));
    cursor.at = at.filter(|at| at.is_finite());
}

/// Where the left button went down or up within this frame, if the cursor went on after that: in a frame that takes
/// long a stroke would not begin where it was begun. `None`: where the cursor is now.
fn pressed_at<'a>(
    events: impl Iterator<Item = &'a WindowEvent>,
    before: Option<Vec2>,
) -> Option<Vec2> {
    let (mut at, mut down, mut up) = (before, None, None);
    for event in events {
        match event {
            WindowEvent::CursorMoved(moved) => {
                at = Some(moved.position);
                for (_, left) in [&mut down, &mut up].into_iter().flatten() {
                    *left = true;
                }
            }
            WindowEvent::MouseButtonInput(input) if input.button == MouseButton::Left => {
                let place = match input.state {
                    ButtonState::Pressed => &mut down,
                    ButtonState::Released => &mut up,
                };
                place.get_or_insert((at, false));
            }
            _ => {}
        }
    }
    let (place, left) = down.or(up)?;
    place.filter(|_| left)
}

/// An empty hand hangs behind the eyes, where it touches and hides nothing.
pub(crate) fn rest(eye: &Transform, side: Side) -> Pose {
    let right = match side {
        Side::Left => -0.2,
        Side::Right => 0.2,
    };
    Pose {
        position: eye.transform_point(Vec3::new(right, -0.25, 0.2)),
        rotation: eye.rotation,
    }
}

/// The ray through a place of the window.
pub(crate) fn ray(camera: &Camera, eye: &Transform, cursor: Vec2) -> Option<Ray3d> {
    camera
        .viewport_to_world(&GlobalTransform::from(*eye), cursor)
        .ok()
}

/// The ray through a point of the window; straight ahead where there is none yet.
pub(crate) fn ray_through(camera: &Camera, eye: &Transform, at: Option<Vec2>) -> Ray3d {
    at.and_then(|at| ray(camera, eye, at)).unwrap_or(Ray3d {
        origin: eye.translation,
        direction: eye.forward(),
    })
}

/// Where a ray is so deep in the view.
pub(crate) fn at_depth(ray: &Ray3d, eye: &Transform, far: f32) -> Option<Vec3> {
    let along = ray.direction.dot(*eye.forward());
    // The ray starts at the near plane, and without perspective even behind the eye.
    let ahead = (ray.origin - eye.translation).dot(*eye.forward());
    (along > 0.1).then(|| ray.get_point((far - ahead) / along))
}

/// Where nothing is hit: on the work plane if it is near (the ground, unless it is in use), else as far
/// away as the origin.
pub(crate) fn on_plane(ray: &Ray3d, eye: &Transform, plane: &WorkPlane) -> Vec3 {
    let plane = if plane.shown {
        *plane
    } else {
        WorkPlane::default()
    };
    let ahead = (ray.origin - eye.translation).dot(*ray.direction);
    let far = || ray.get_point(eye.translation.length().clamp(0.5, 10.0) - ahead);
    plane.meet(ray, 30.0).unwrap_or_else(far)
}

/// Which way is up from the plane that things are put on.
pub(crate) fn plane_up(plane: &WorkPlane) -> Vec3 {
    if plane.shown {
        *plane.normal()
    } else {
        Vec3::Y
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::input::mouse::MouseButtonInput;

    #[test]
    fn a_press_is_where_the_cursor_was_only_if_that_goes_on_in_the_same_frame() {
        let window = Entity::PLACEHOLDER;
        let to = |x: f32| {
            WindowEvent::CursorMoved(CursorMoved {
                window,
                position: Vec2::splat(x),
                delta: None,
            })
        };
        let button = |state| {
            WindowEvent::MouseButtonInput(MouseButtonInput {
                button: MouseButton::Left,
                state,
                window,
            })
        };
        let (down, up) = (
            || button(ButtonState::Pressed),
            || button(ButtonState::Released),
        );
        let at = |events: &[WindowEvent]| {
            pressed_at(events.iter(), Some(Vec2::ZERO)).map(|place| place.x)
        };
        assert_eq!(at(&[to(1.0), to(2.0)]), None);
        assert_eq!(at(&[down()]), None, "what is remembered may be stale");
        assert_eq!(at(&[to(1.0), down()]), None);
        assert_eq!(at(&[down(), to(1.0)]), Some(0.0));
        assert_eq!(at(&[to(1.0), down(), to(2.0), to(3.0)]), Some(1.0));
        assert_eq!(at(&[to(1.0), up(), to(2.0)]), Some(1.0));
        assert_eq!(at(&[down(), to(1.0), up(), to(2.0)]), Some(0.0));
    }
}
