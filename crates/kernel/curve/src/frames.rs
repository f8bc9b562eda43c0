use std::f64::consts::{PI, TAU};

use glam::{DMat3, DQuat, DVec3};

use crate::Hermite;

/// A frame along a curve that turns about it as little as it can (Hermite motion controller
/// §3.1.5), and from which the angle to the right controller is then spread evenly (§3.1.6).
///
/// Its columns are the tangent, the normal and their product: at u = 0 a left controller whose x
/// axis the curve follows, at u = 1 the right one.
#[derive(Clone, Debug, PartialEq)]
pub struct Frames {
    curve: Hermite,
    /// Where the tangent vanishes the one before is kept, from here on.
    tangents: Vec<DVec3>,
    /// Unit normals of the frame without twist, at even steps of u.
    normals: Vec<DVec3>,
    /// Radians by which it is turned at u = 1: α + 2πk of §3.1.7.
    twist: f64,
}

impl Frames {
    /// The frame that begins as `start` is turned, by double reflection (Algorithm 1, as in
    /// errata.md), without twist, for a curve of `points` points: two reflections for each step
    /// from one to the next, which makes its error a sixteenth.
    ///
    /// Always finite: where two samples coincide or the tangent vanishes, the frame is carried
    /// over and made perpendicular again.
    pub fn new(curve: &Hermite, start: DQuat, points: usize) -> Self {
        let steps = 2 * (points.max(2) - 1);
        let mut tangents = Vec::with_capacity(steps + 1);
        let mut normals = Vec::with_capacity(steps + 1);
        let mut tangent = direction(curve.derivative(0.0), start * DVec3::X);
        let mut normal = upright(start * DVec3::Y, tangent);
        let mut point = curve.at(0.0);
        tangents.push(tangent);
        normals.push(normal);
        for i in 1..=steps {
            let u = i as f64 / steps as f64;
            let next = curve.at(u);
            let ahead = direction(curve.derivative(u), tangent);
            // The first reflection takes one point to the other, the second one tangent to the other.
            let v1 = next - point;
            let reflected = reflect(normal, v1);
            let v2 = ahead - reflect(tangent, v1);
            normal = upright(reflect(reflected, v2), ahead);
            (tangent, point) = (ahead, next);
            tangents.push(tangent);
            normals.push(normal);
        }
        Self {
            curve: *curve,
            tangents,
            normals,
            twist: 0.0,
        }
    }

    /// The angle α from the untwisted frame's end to `end`, in (−π, π].
    pub fn angle_to(&self, end: DQuat) -> f64 {
        let (tangent, normal) = self.last();
        let wanted = upright(end * DVec3::Y, tangent);
        let angle = wanted.dot(tangent.cross(normal)).atan2(wanted.dot(normal));
        if angle <= -PI { angle + TAU } else { angle }
    }

    /// The same, turned by `twist` radians in the end and in proportion on the way
    /// (α(u) = (α + 360° k)·u).
    #[must_use]
    pub fn twisted(self, twist: f64) -> Self {
        let twist = if twist.is_finite() { twist } else { 0.0 };
        Self { twist, ..self }
    }

    /// Radians by which it is turned in the end.
    pub fn twist(&self) -> f64 {
        self.twist
    }

    /// The frame at `u` in [0, 1]: interpolated between samples and made perpendicular again.
    pub fn at(&self, u: f64) -> DMat3 {
        let u = if u.is_finite() {
            u.clamp(0.0, 1.0)
        } else {
            0.0
        };
        let steps = self.normals.len() - 1;
        let along = u * steps as f64;
        let i = (along.floor() as usize).min(steps.saturating_sub(1));
        let t = along - i as f64;
        let j = (i + 1).min(steps);
        let tangent = direction(
            self.curve.derivative(u),
            self.tangents[if t > 0.5 { j } else { i }],
        );
        let normal = upright(self.normals[i].lerp(self.normals[j], t), tangent);
        let (sin, cos) = (self.twist * u).sin_cos();
        let normal = normal * cos + tangent.cross(normal) * sin;
        DMat3::from_cols(tangent, normal, tangent.cross(normal))
    }

    fn last(&self) -> (DVec3, DVec3) {
        let at = self.normals.len() - 1;
        (self.tangents[at], self.normals[at])
    }
}

/// The twist counted beyond a full turn: of all angles that look alike the one nearest to `before`
/// (§3.1.7's k).
pub fn unwound(angle: f64, before: f64) -> f64 {
    if !(angle.is_finite() && before.is_finite()) {
        return if before.is_finite() { before } else { 0.0 };
    }
    angle + TAU * ((before - angle) / TAU).round()
}

fn direction(v: DVec3, otherwise: DVec3) -> DVec3 {
    let length = v.length();
    if length > 1e-12 {
        v / length
    } else {
        otherwise
    }
}

/// `n` made a unit vector perpendicular to `tangent`; any such where `n` says nothing.
fn upright(n: DVec3, tangent: DVec3) -> DVec3 {
    let flat = n - tangent * n.dot(tangent);
    if flat.length_squared() > 1e-20 {
        flat.normalize()
    } else {
        tangent.any_orthonormal_vector()
    }
}

/// Reflected in the plane with normal `by`; unchanged where that is none.
fn reflect(v: DVec3, by: DVec3) -> DVec3 {
    let c = by.length_squared();
    if c > 1e-30 {
        v - by * (2.0 / c * by.dot(v))
    } else {
        v
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use proptest::strategy::ValueTree;

    use super::*;
    use crate::{End, Even, Lengths};

    fn end() -> impl Strategy<Value = End> {
        let position = [-0.6..0.6f64, -0.6..0.6f64, -0.6..0.6f64];
        let turn = [-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64, 0.05..1.0f64];
        (position, turn).prop_map(|(p, [x, y, z, w])| End {
            position: DVec3::from_array(p),
            rotation: DQuat::from_xyzw(x, y, z, w).normalize(),
        })
    }

    /// The rotation-minimising frame's equation N′ = −(N·T′)T, integrated by Runge and Kutta's rule.
    fn reference(curve: &Hermite, start: DVec3, steps: usize) -> DVec3 {
        let tangent = |u: f64| curve.derivative(u).normalize();
        let turn = |u: f64, n: DVec3| {
            let h = 1e-6;
            let (a, b) = ((u - h).max(0.0), (u + h).min(1.0));
            let bend = (tangent(b) - tangent(a)) / (b - a);
            -tangent(u) * n.dot(bend)
        };
        let mut n = start;
        let h = 1.0 / steps as f64;
        for i in 0..steps {
            let u = i as f64 * h;
            let k1 = turn(u, n);
            let k2 = turn(u + 0.5 * h, n + k1 * (0.5 * h));
            let k3 = turn(u + 0.5 * h, n + k2 * (0.5 * h));
            let k4 = turn(u + h, n + k3 * h);
            n += (k1 + k2 * 2.0 + k3 * 2.0 + k4) * (h / 6.0);
        }
        n.normalize()
    }

    #[test]
    fn double_reflection_is_the_frame_integrated_in_10000_steps() {
        let mut rng = proptest::test_runner::TestRunner::deterministic();
        let mut worst: f64 = 0.0;
        for _ in 0..40 {
            let (a, b) = (end(), end()).new_tree(&mut rng).unwrap().current();
            let mut lengths = Lengths::default();
            lengths.settle(&a, &b);
            let curve = Hermite::between(&a, &b, lengths.0);
            let frames = Frames::new(&curve, a.rotation, POINTS);
            let (_, normal) = frames.last();
            let wanted = reference(&curve, a.rotation * DVec3::Y, 10_000);
            worst = worst.max(normal.cross(wanted).length());
        }
        println!("worst of 40 curves at n = 48: {worst:e} rad");
        assert!(worst < 5e-5, "{worst:e}");
    }

    /// Points of a curve.
    const POINTS: usize = 48;

    proptest! {
        #[test]
        fn it_ends_as_the_right_hand_is_turned(a in end(), b in end(), k in -2..=2i32) {
            let mut lengths = Lengths::default();
            lengths.settle(&a, &b);
            let curve = Hermite::between(&a, &b, lengths.0);
            let frames = Frames::new(&curve, a.rotation, POINTS);
            let twist = frames.angle_to(b.rotation) + TAU * f64::from(k);
            let frames = frames.twisted(twist);
            for (u, q) in [(0.0, a.rotation), (1.0, b.rotation)] {
                let (is, wanted) = (frames.at(u), DMat3::from_quat(q));
                for (x, y) in [
                    (is.x_axis, wanted.x_axis),
                    (is.y_axis, wanted.y_axis),
                    (is.z_axis, wanted.z_axis),
                ] {
                    prop_assert!(x.distance(y) < 1e-6, "{} at {}", x.distance(y), u);
                }
            }
        }

        #[test]
        fn between_samples_it_is_a_frame_and_has_no_jump(a in end(), b in end()) {
            let mut lengths = Lengths::default();
            lengths.settle(&a, &b);
            // One whose tangent does not swing round within a hair.
            let curve = Hermite::between(&a, &b, lengths.0);
            let slowest = (0..100).map(|i| curve.derivative(f64::from(i) / 99.0).length());
            prop_assume!(slowest.fold(f64::MAX, f64::min) > 0.2 * curve.length());
            let frames = Frames::new(&curve, a.rotation, POINTS);
            let frames = frames.clone().twisted(frames.angle_to(b.rotation));
            let mut before = frames.at(0.0);
            for i in 1..=2000 {
                let m = frames.at(f64::from(i) / 2000.0);
                prop_assert!((m.determinant() - 1.0).abs() < 1e-9);
                prop_assert!(m.y_axis.distance(before.y_axis) < 0.05);
                before = m;
            }
        }
    }

    #[test]
    fn the_twist_goes_on_through_two_full_turns_either_way() {
        let left = End {
            position: DVec3::new(-0.3, 0.0, 0.0),
            rotation: DQuat::IDENTITY,
        };
        let mut lengths = Lengths::default();
        let (mut total, mut first) = (0.0, true);
        for degree in (-720..=720).chain((-720..=720).rev()) {
            let right = End {
                position: DVec3::new(0.3, 0.1, -0.05),
                rotation: DQuat::from_rotation_y(0.3)
                    * DQuat::from_rotation_x(f64::from(degree).to_radians()),
            };
            lengths.adapt(&left, &right);
            let curve = Hermite::between(&left, &right, lengths.0);
            let frames = Frames::new(&curve, left.rotation, POINTS);
            let angle = frames.angle_to(right.rotation);
            let next = if first {
                unwound(angle, f64::from(degree).to_radians())
            } else {
                unwound(angle, total)
            };
            if !first {
                assert!((next - total).abs() < 0.06, "{degree}: {total} to {next}");
            }
            let twisted = frames.twisted(next);
            assert!(twisted.at(1.0).y_axis.distance(right.rotation * DVec3::Y) < 1e-6);
            (total, first) = (next, false);
        }
        let there = f64::from(-720).to_radians();
        assert!((total - there).abs() < 0.3, "{total}");
    }

    #[test]
    fn straight_coincident_and_opposite_hands_have_a_frame() {
        let at = |x: f64, q: DQuat| End {
            position: DVec3::X * x,
            rotation: q,
        };
        let about = DQuat::from_rotation_y(PI);
        for (a, b) in [
            (at(-0.2, DQuat::IDENTITY), at(0.2, DQuat::IDENTITY)),
            (at(0.1, DQuat::IDENTITY), at(0.1, DQuat::IDENTITY)),
            (at(0.1, DQuat::IDENTITY), at(0.1, about)),
            (at(-0.2, DQuat::IDENTITY), at(0.2, about)),
            (at(-0.2, about), at(0.2, about)),
        ] {
            let mut lengths = Lengths::default();
            for _ in 0..60 {
                lengths.adapt(&a, &b);
                let curve = Hermite::between(&a, &b, lengths.0);
                let frames = Frames::new(&curve, a.rotation, POINTS);
                let frames = frames.clone().twisted(frames.angle_to(b.rotation));
                for i in 0..=100 {
                    let m = frames.at(f64::from(i) / 100.0);
                    assert!(m.is_finite() && (m.determinant() - 1.0).abs() < 1e-9);
                }
            }
        }
    }

    /// The longest step over the shortest one after 30 frames, in the median and at worst, for 100
    /// pairs of hands up to `turned` radians from facing along the line between them: by Eq. 10 alone,
    /// and with points counted along the curve's length.
    fn spacing(turned: f64) -> [(f64, f64); 2] {
        let mut rng = proptest::test_runner::TestRunner::deterministic();
        let apart = (-0.6..0.6f64, -0.6..0.6f64, -0.6..0.6f64);
        let turn = (-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64, 0.0..1.0f64);
        let mut ratios: [Vec<f64>; 2] = Default::default();
        while ratios[0].len() < 100 {
            let drawn = (apart.clone(), apart.clone(), turn.clone(), turn.clone());
            let (p, q, a, b) = drawn.new_tree(&mut rng).unwrap().current();
            let (p, q) = (DVec3::from(p), DVec3::from(q));
            if p.distance(q) < 0.15 {
                continue;
            }
            let facing = DQuat::from_rotation_arc(DVec3::X, (q - p).normalize());
            let end = |position, (x, y, z, by): (f64, f64, f64, f64)| End {
                position,
                rotation: DQuat::from_axis_angle(DVec3::new(x, y, z).normalize(), by * turned)
                    * facing,
            };
            let (a, b) = (end(p, a), end(q, b));
            let mut lengths = Lengths::default();
            for _ in 0..30 {
                lengths.adapt(&a, &b);
            }
            let curve = Hermite::between(&a, &b, lengths.0);
            let even = Even::new(&curve);
            let share = |i: usize| i as f64 / (POINTS - 1) as f64;
            let us: [&dyn Fn(usize) -> f64; 2] = [&share, &|i| even.at(share(i))];
            for (u, ratios) in us.iter().zip(&mut ratios) {
                let at = |i: usize| curve.at(u(i));
                let steps = (1..POINTS).map(|i| at(i - 1).distance(at(i)));
                let (low, high) = steps.fold((f64::MAX, 0.0f64), |(l, h), s| (l.min(s), h.max(s)));
                ratios.push(high / low);
            }
        }
        ratios.map(|mut r| {
            r.sort_by(f64::total_cmp);
            (r[50], r[99])
        })
    }

    #[test]
    fn steps_are_even_after_thirty_frames() {
        for degrees in [30.0f64, 60.0, 90.0, 120.0, 180.0] {
            let [ten, even] = spacing(degrees.to_radians());
            println!(
                "hands turned up to {degrees}°: longest over shortest step by Eq. 10 {:.3} in the median, {:.3} at worst; counted along the length {:.3}, {:.3}",
                ten.0, ten.1, even.0, even.1
            );
            assert!(even.0 <= 1.3, "{even:?}");
        }
        let [ten, _] = spacing(std::f64::consts::FRAC_PI_2);
        assert!(ten.0 <= 1.3, "{ten:?}");
    }
}
