//! What Monado's `remote` driver is told: 376 bytes, little endian, on TCP port 4242.
//!
//! On connect the server sends two packets; then each packet sent stays in force, also after the connection is closed.
//! Nothing is acknowledged: whoever sends looks at the app for what has arrived.

use std::io::{Read, Write};
use std::net::TcpStream;
use std::time::Duration;

use anyhow::{Context, Result};
use bevy::math::{Vec2, Vec3};
use midair_studio::hands::Pose;

const SIZE: usize = 376;

/// A controller of the kind of the Valve Index.
#[derive(Clone, Copy, Debug)]
pub struct Controller {
    pub pose: Pose,
    pub active: bool,
    pub trigger: f32,
    pub squeeze: f32,
    pub stick: Vec2,
    pub stick_click: bool,
    pub pad: Vec2,
    pub pad_force: f32,
    pub pad_touch: bool,
    pub a: bool,
    pub b: bool,
    pub system: bool,
}

impl Controller {
    fn at(x: f32) -> Self {
        Self {
            pose: Pose::at(Vec3::new(x, 1.3, -0.5)),
            active: true,
            trigger: 0.0,
            squeeze: 0.0,
            stick: Vec2::ZERO,
            stick_click: false,
            pad: Vec2::ZERO,
            pad_force: 0.0,
            pad_touch: false,
            a: false,
            b: false,
            system: false,
        }
    }

    fn put(&self, out: &mut Vec<u8>) {
        put_pose(&self.pose, out);
        let still = [0.0; 6];
        let curl = [0.0; 5];
        let axes = [self.trigger, self.squeeze, 0.0];
        for value in still.iter().chain(&curl).chain(&axes) {
            out.extend(value.to_le_bytes());
        }
        for value in [
            self.stick.x,
            self.stick.y,
            self.pad_force,
            self.pad.x,
            self.pad.y,
        ] {
            out.extend(value.to_le_bytes());
        }
        for flag in [
            // Hand tracking: the runtime follows it with the controller.
            self.active,
            self.active,
            self.system,
            false,
            self.a,
            false,
            self.b,
            false,
            self.trigger > 0.9,
            self.trigger > 0.0,
            self.stick_click,
            false,
            self.pad_touch,
            false,
            false,
            false,
        ] {
            out.push(u8::from(flag));
        }
    }
}

fn put_pose(pose: &Pose, out: &mut Vec<u8>) {
    let turn = pose.rotation.to_array();
    for value in turn.iter().chain(&pose.position.to_array()) {
        out.extend(value.to_le_bytes());
    }
}

/// Head and hands as they are told to the runtime.
pub struct Rig {
    stream: TcpStream,
    pub head: Pose,
    /// Left, right.
    pub hands: [Controller; 2],
}

impl Rig {
    /// Takes hold of the driver.
    pub fn connect() -> Result<Self> {
        let mut stream = TcpStream::connect(("127.0.0.1", 4242)).context("the remote driver")?;
        stream.set_nodelay(true)?;
        stream.set_read_timeout(Some(Duration::from_secs(5)))?;
        stream
            .read_exact(&mut [0; 2 * SIZE])
            .context("the remote driver's greeting")?;
        Ok(Self {
            stream,
            head: Pose::at(Vec3::new(0.0, 1.6, 0.6)),
            hands: [Controller::at(-0.2), Controller::at(0.2)],
        })
    }

    /// From now on they are so.
    pub fn send(&mut self) -> Result<()> {
        let mut out = Vec::with_capacity(SIZE);
        out.extend(b"mndrmt3\0");
        // Fields of view and eyes of their own: not given.
        out.extend([0; 96]);
        put_pose(&self.head, &mut out);
        out.extend([0; 4]);
        for hand in &self.hands {
            hand.put(&mut out);
        }
        debug_assert_eq!(out.len(), SIZE);
        self.stream.write_all(&out).context("the remote driver")
    }
}
