//! Two ends with one hand: they are placed and their tangents pulled, then moved one after the other.

use bevy::prelude::*;
use midair_curve::End;

use crate::ends::aimed;

/// How far one is with one hand.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Solo {
    /// The next press places the left end.
    #[default]
    Left,
    /// Its tangent is pulled.
    LeftTangent {
        /// Where it stands.
        at: Vec3,
    },
    /// The next press places the right end.
    Right {
        /// The left one.
        left: End,
    },
    /// Its tangent is pulled.
    RightTangent {
        /// The left one.
        left: End,
        /// Where it stands.
        at: Vec3,
    },
    /// Both stand; the next press draws the way of the left one, grab carries both.
    Ready {
        /// Both.
        ends: [End; 2],
    },
    /// The way of the left end is drawn.
    LeftWay {
        /// Where they stood.
        ends: [End; 2],
        /// Where the pointer was pressed.
        from: Vec3,
        /// Seconds and how far the end had moved.
        way: Vec<(f32, Vec3)>,
    },
    /// The next press draws the way of the right end, and sweeps.
    LeftDrawn {
        /// Where they stood.
        ends: [End; 2],
        /// The way of the left one.
        way: Vec<(f32, Vec3)>,
    },
    /// The right end's way is drawn while the left one's plays back.
    RightWay {
        /// Where they stood.
        ends: [End; 2],
        /// Where the pointer was pressed.
        from: Vec3,
        /// The way of the left one.
        way: Vec<(f32, Vec3)>,
        /// Seconds since the press.
        time: f32,
        /// How far the right one has moved.
        moved: Vec3,
    },
    /// Both are carried.
    Carried {
        /// Where they stood.
        ends: [End; 2],
        /// Where the pointer was pressed.
        from: Vec3,
        /// How far they have moved.
        moved: Vec3,
    },
}

/// What the one hand does in this frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Doing {
    pub at: Vec3,
    pub dt: f32,
    /// Act went down, is down.
    pub pressed: bool,
    pub held: bool,
    /// Grab went down, is down.
    pub grabbed: bool,
    pub grabs: bool,
    /// It is at the curve, between its ends.
    pub middle: bool,
    /// Metres within which a press is one on one spot.
    pub spot: f32,
}

/// What follows for the sweep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Then {
    /// Nothing.
    Wait,
    /// It begins.
    Begin,
    /// It is let go.
    End,
    /// Where a way was to be drawn one spot was pressed: that chooses what is there.
    Choose,
}

/// A tangent pulled less far than this, physical metres, is not meant as one.
const PULL: f32 = 0.01;

impl Solo {
    /// Where both ends are, as far as they stand.
    pub fn ends(&self) -> [Option<End>; 2] {
        let moved = |e: &End, by: Vec3| End {
            position: e.position + by.as_dvec3(),
            ..*e
        };
        match self {
            Self::Left | Self::LeftTangent { .. } => [None, None],
            Self::Right { left } | Self::RightTangent { left, .. } => [Some(*left), None],
            Self::Ready { ends } => ends.map(Some),
            Self::LeftWay { ends, way, .. } => {
                let by = way.last().map_or(Vec3::ZERO, |w| w.1);
                [Some(moved(&ends[0], by)), Some(ends[1])]
            }
            // Back at the start, to be played.
            Self::LeftDrawn { ends, .. } => ends.map(Some),
            Self::RightWay {
                ends,
                way,
                time,
                moved: by,
                ..
            } => [
                Some(moved(&ends[0], along(way, *time))),
                Some(moved(&ends[1], *by)),
            ],
            Self::Carried {
                ends, moved: by, ..
            } => ends.map(|e| Some(moved(&e, *by))),
        }
    }

    /// The ends while one of their tangents is pulled.
    pub fn pulled(&self, at: Vec3) -> Option<(Vec3, Vec3)> {
        match self {
            Self::LeftTangent { at: from } | Self::RightTangent { at: from, .. } => {
                Some((*from, at))
            }
            _ => None,
        }
    }

    /// Whether the left end's way has more to play than the right one's took.
    pub fn rest(&self) -> Option<f32> {
        match self {
            Self::RightWay { way, time, .. } => {
                let left = way.last().map_or(0.0, |w| w.0) - time;
                (left > 0.0).then_some(left)
            }
            _ => None,
        }
    }

    /// Plays on by `dt` seconds with the right end at rest.
    pub fn play(&mut self, dt: f32) {
        if let Self::RightWay { time, .. } = self {
            *time += dt;
        }
    }

    /// One step back; whether there was one to go.
    pub fn back(&mut self) -> bool {
        let next = match &*self {
            Self::Left => return false,
            Self::LeftTangent { .. } | Self::Right { .. } => Self::Left,
            Self::RightTangent { left, .. } => Self::Right { left: *left },
            Self::Ready { ends } => Self::Right { left: ends[0] },
            Self::LeftWay { ends, .. }
            | Self::LeftDrawn { ends, .. }
            | Self::RightWay { ends, .. }
            | Self::Carried { ends, .. } => Self::Ready { ends: *ends },
        };
        *self = next;
        true
    }

    /// One frame. `unit` is metres of world in a physical one.
    pub(crate) fn advance(&mut self, doing: &Doing, unit: f32) -> Then {
        let at = doing.at;
        let mut then = Then::Wait;
        let next = match std::mem::take(self) {
            Self::Left if doing.pressed => Self::LeftTangent { at },
            Self::LeftTangent { at: from } if !doing.held => Self::Right {
                left: pulled(from, at, unit, Vec3::X),
            },
            Self::Right { left } if doing.pressed => Self::RightTangent { left, at },
            Self::RightTangent { left, at: from } if !doing.held => {
                let chord = from - left.position.as_vec3();
                let right = pulled(from, at, unit, chord);
                // A left end that was only clicked runs towards the right one.
                let aside = left.along().as_vec3() == Vec3::X;
                let left = if aside {
                    aimed(left.position.as_vec3(), chord)
                } else {
                    left
                };
                Self::Ready {
                    ends: [left, right],
                }
            }
            Self::Ready { ends } if doing.grabbed || (doing.pressed && doing.middle) => {
                then = Then::Begin;
                Self::Carried {
                    ends,
                    from: at,
                    moved: Vec3::ZERO,
                }
            }
            Self::Ready { ends } if doing.pressed => Self::LeftWay {
                ends,
                from: at,
                way: vec![(0.0, Vec3::ZERO)],
            },
            Self::LeftWay {
                ends,
                from,
                mut way,
            } => {
                let time = way.last().map_or(0.0, |w| w.0) + doing.dt;
                way.push((time, at - from));
                if doing.held {
                    Self::LeftWay { ends, from, way }
                } else if way.iter().all(|w| w.1.length() < doing.spot) {
                    then = Then::Choose;
                    Self::Ready { ends }
                } else {
                    Self::LeftDrawn { ends, way }
                }
            }
            Self::LeftDrawn { ends, way } if doing.pressed => {
                then = Then::Begin;
                Self::RightWay {
                    ends,
                    from: at,
                    way,
                    time: 0.0,
                    moved: Vec3::ZERO,
                }
            }
            Self::RightWay {
                ends,
                from,
                way,
                time,
                ..
            } => {
                if !doing.held {
                    then = Then::End;
                }
                Self::RightWay {
                    ends,
                    from,
                    way,
                    time: time + doing.dt,
                    moved: at - from,
                }
            }
            Self::Carried { ends, from, .. } => {
                if !doing.grabs && !doing.held {
                    then = Then::End;
                }
                Self::Carried {
                    ends,
                    from,
                    moved: at - from,
                }
            }
            stays => stays,
        };
        *self = next;
        then
    }

    /// The sweep is made: the ends stand where they came to.
    pub(crate) fn rests(&mut self) {
        if let [Some(left), Some(right)] = self.ends() {
            *self = Self::Ready {
                ends: [left, right],
            };
        }
    }
}

fn pulled(from: Vec3, to: Vec3, unit: f32, otherwise: Vec3) -> End {
    let pull = to - from;
    if pull.length() > PULL * unit {
        aimed(from, pull)
    } else {
        aimed(from, otherwise)
    }
}

/// How far along its way at a time; its end after that.
fn along(way: &[(f32, Vec3)], time: f32) -> Vec3 {
    let after = way.partition_point(|w| w.0 < time);
    match (
        after.checked_sub(1).and_then(|i| way.get(i)),
        way.get(after),
    ) {
        (Some(a), Some(b)) => a.1.lerp(b.1, (time - a.0) / (b.0 - a.0).max(1e-6)),
        (None, Some(b)) => b.1,
        (Some(a), None) => a.1,
        (None, None) => Vec3::ZERO,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn doing(at: Vec3, pressed: bool, held: bool) -> Doing {
        Doing {
            at,
            dt: 0.1,
            pressed,
            held,
            grabbed: false,
            grabs: false,
            middle: false,
            spot: 0.01,
        }
    }

    fn placed() -> Solo {
        let mut solo = Solo::default();
        for (at, to) in [
            (Vec3::ZERO, Vec3::Y * 0.1),
            (Vec3::X * 0.4, Vec3::new(0.4, -0.1, 0.0)),
        ] {
            assert_eq!(solo.advance(&doing(at, true, true), 1.0), Then::Wait);
            solo.advance(&doing(to, false, true), 1.0);
            solo.advance(&doing(to, false, false), 1.0);
        }
        solo
    }

    #[test]
    fn two_clicks_place_the_ends_and_drags_pull_their_tangents() {
        let [Some(left), Some(right)] = placed().ends() else {
            panic!("both stand");
        };
        assert!(left.along().as_vec3().distance(Vec3::Y) < 1e-5);
        assert!(right.along().as_vec3().distance(Vec3::NEG_Y) < 1e-5);
        assert!(right.position.as_vec3().distance(Vec3::X * 0.4) < 1e-6);
    }

    #[test]
    fn a_press_on_one_spot_is_no_way() {
        let mut solo = placed();
        let ready = solo.clone();
        solo.advance(&doing(Vec3::ONE, true, true), 1.0);
        solo.advance(&doing(Vec3::ONE + Vec3::X * 0.004, false, true), 1.0);
        let then = solo.advance(&doing(Vec3::ONE, false, false), 1.0);
        assert_eq!((then, solo), (Then::Choose, ready));
    }

    #[test]
    fn the_left_way_plays_back_while_the_right_one_is_drawn() {
        let mut solo = placed();
        solo.advance(&doing(Vec3::ONE, true, true), 1.0);
        for i in 1..=10 {
            let at = Vec3::ONE + Vec3::Z * 0.02 * i as f32;
            solo.advance(&doing(at, false, true), 1.0);
        }
        solo.advance(&doing(Vec3::ONE + Vec3::Z * 0.2, false, false), 1.0);
        assert!(matches!(solo, Solo::LeftDrawn { .. }));
        assert_eq!(
            solo.advance(&doing(Vec3::ZERO, true, true), 1.0),
            Then::Begin
        );
        for i in 1..=5 {
            solo.advance(&doing(Vec3::Z * 0.03 * i as f32, false, true), 1.0);
        }
        let [Some(left), Some(right)] = solo.ends() else {
            panic!("both stand");
        };
        assert!(
            (left.position.z - 0.1).abs() < 1e-4,
            "half of its way: {left:?}"
        );
        assert!((right.position.z - 0.15).abs() < 1e-4);
        assert!(solo.rest().is_some());
        assert_eq!(
            solo.advance(&doing(Vec3::Z * 0.15, false, false), 1.0),
            Then::End
        );
        solo.play(10.0);
        let left = solo.ends()[0].unwrap();
        assert!((left.position.z - 0.2).abs() < 1e-4, "played to its end");
        solo.rests();
        assert!(matches!(solo, Solo::Ready { .. }));
        assert!(solo.back() && matches!(solo, Solo::Right { .. }));
    }
}
