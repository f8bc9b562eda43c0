//! How much room a solid takes: guessed before it is made, and asked for where that was too little.

use midair_field::Program;

use super::SolidOptions;
use super::run::bricks_touching;
use crate::error::GpuError;
use crate::flatten::Flat;
use crate::layout::{counter, overflow};
use crate::memory::Room;

/// The room that the counters asked for.
pub(super) fn asked(mut room: Room, c: &[u32; counter::COUNT]) -> Room {
    let missing = c[counter::OVERFLOW];
    // A quarter more than was asked for: what comes after what ran out may ask for more.
    let more = |now: u32, asked: u32| asked.max(now).saturating_add(asked.max(now) / 4 + 64);
    if missing & overflow::SLOTS != 0 {
        room.slots = more(room.slots, c[counter::SLOTS]);
    }
    if missing & overflow::CHUNKS != 0 {
        room.chunks = more(room.chunks, c[counter::CHUNKS]);
        room.tables = more(room.tables, c[counter::TABLES]);
    }
    if missing & overflow::BLOCKS != 0 {
        let levels = &c[counter::LEVELS..counter::VERTEX_HEADS];
        let most = levels.iter().copied().max().unwrap_or(0);
        room.blocks = more(room.blocks, most);
    }
    if missing & overflow::TAPE != 0 {
        room.tape = more(room.tape, c[counter::TAPE]);
    }
    if missing & overflow::VERTICES != 0 {
        room.vertices = more(room.vertices, c[counter::VERTICES]);
    }
    if missing & overflow::TRIANGLES != 0 {
        room.triangles = more(room.triangles, c[counter::TRIANGLES]);
    }
    room
}

/// Room for a solid whose surface is about that of its box.
pub(super) fn guess(
    program: &Program,
    flat: &Flat,
    options: SolidOptions,
) -> Result<Room, GpuError> {
    let step = program.step();
    let region = program.bounds().grown(step);
    let mut near = 0.0f64;
    if !region.is_empty() {
        let reach = region.min.abs().max(region.max.abs()).max_element();
        // Beyond this, single precision cannot tell neighbouring nodes apart.
        if reach / step > 4.0e6 || reach.is_nan() {
            return Err(GpuError::TooFine(step));
        }
        let (low, high) = bricks_touching(&region, step);
        let n = (high - low + 1).as_dvec3();
        near = (2.4 * (n.x * n.y + n.y * n.z + n.z * n.x)).min(n.x * n.y * n.z);
    }
    let slots = (near as u32).saturating_add(64);
    let len = flat.tape.len() as u32;
    Ok(Room {
        quantised: options.quantises(step, flat.flattest),
        slots,
        chunks: slots / 12 + 160,
        tables: slots / 16 + 128,
        blocks: slots + slots / 4 + 256,
        tape: (8 * slots)
            .saturating_mul(len.clamp(1, 6))
            .saturating_add(512u32.saturating_mul(len))
            .saturating_add(4096),
        vertices: 96 * slots,
        triangles: 192 * slots,
        program: flat.program.len() as u32,
        volumes: (flat.volume_bytes() / 4).min(u64::from(u32::MAX)) as u32,
    })
}

pub(super) fn holds(room: &Room, wanted: &Room) -> bool {
    room.quantised == wanted.quantised
        && room.program >= wanted.program
        && room.volumes >= wanted.volumes
        && room.tape >= wanted.tape / 4
}

pub(super) fn larger(a: &Room, b: &Room) -> Room {
    Room {
        quantised: b.quantised,
        slots: a.slots.max(b.slots),
        chunks: a.chunks.max(b.chunks),
        tables: a.tables.max(b.tables),
        blocks: a.blocks.max(b.blocks),
        tape: a.tape.max(b.tape),
        vertices: a.vertices.max(b.vertices),
        triangles: a.triangles.max(b.triangles),
        program: a.program.max(b.program) + a.program.max(b.program) / 2,
        volumes: a.volumes.max(b.volumes),
    }
}
