// Fuses the operands that were left for a brick at its 8³ nodes (EasyVRModeling §5.3 Eq. 7) and
// keeps it if the surface may be near. 8×8×4 invocations, two nodes each.

var<workgroup> brick_low: atomic<u32>;
var<workgroup> brick_high: atomic<u32>;
var<workgroup> brick_count: u32;
var<workgroup> brick_entry_now: u32;
// Which nodes lie inside.
var<workgroup> brick_signs: array<atomic<u32>, 16>;

// Keeps the order of floats.
fn ordered(v: f32) -> u32 {
    let u = bitcast<u32>(v);
    return select(u | 0x80000000u, ~u, (u >> 31u) == 1u);
}

fn unordered(u: u32) -> f32 {
    return bitcast<f32>(select(~u, u & 0x7fffffffu, (u >> 31u) == 1u));
}

fn take_slot() -> u32 {
    let free = bitcast<i32>(atomicSub(&counters[FREE], 1u));
    if free > 0 {
        return bricks[STRIDE * u32(free - 1) + FREE_SLOT];
    }
    let slot = atomicAdd(&counters[SLOTS], 1u);
    if slot >= g.slots {
        failed(NO_SLOTS);
        return NONE;
    }
    return slot;
}

fn fused(b: Block, node: u32) -> f32 {
    let l = vec3<i32>(vec3(node & 7u, (node >> 3u) & 7u, node >> 6u));
    let p = vec3<f32>(block_at(b) * 8 + l) * g.step;
    let v = evaluate(b.off, b.len, p);
    return select(v, g.eps, abs(v) < g.eps);
}

// The greatest |∇φ| on a brick and a little around it; HUGE where it is not known.
fn steepest(b: Block) -> f32 {
    let centre = (vec3<f32>(block_at(b)) * 8.0 + vec3(3.5)) * g.step;
    var most = 1.0;
    for (var i = b.off; i < b.off + b.len; i++) {
        if (tape[i] >> 29u) == LOAD {
            let leaf = tape[i] & 0x1fffffffu;
            if is_painting(leaf) {
                let to = inks(i + 1u, b.off + b.len);
                most = max(most, painting_slope(leaf, i + 1u, to, centre, 3.5 * g.step, g.around));
            } else {
                most = max(most, leaf_slope(leaf, centre, 3.5 * g.step, g.around));
            }
        }
    }
    return most;
}

fn quantum(v: f32) -> i32 {
    return i32(clamp(round(v / g.eps), -32767.0, 32767.0));
}

// As `value` reads it back.
fn is_inside(v: f32) -> bool {
    if QUANTISED {
        return quantum(v) < 0;
    }
    return v <= -g.eps;
}

@compute @workgroup_size(8, 8, 4)
fn fuse(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lid: u32) {
    if lid == 0u {
        brick_count = min(atomicLoad(&counters[stage.count_in]), g.blocks);
        atomicStore(&brick_low, NONE);
        atomicStore(&brick_high, 0u);
    }
    if lid < 16u {
        atomicStore(&brick_signs[lid], 0u);
    }
    let count = workgroupUniformLoad(&brick_count);
    let index = flat_group(group);
    if index >= count {
        return;
    }
    let b = blocks[stage.from_block + index];
    let pair = vec2(fused(b, 2u * lid), fused(b, 2u * lid + 1u));
    atomicMin(&brick_low, ordered(min(pair.x, pair.y)));
    atomicMax(&brick_high, ordered(max(pair.x, pair.y)));
    let signs = select(0u, 1u, is_inside(pair.x)) | select(0u, 2u, is_inside(pair.y));
    if signs != 0u {
        atomicOr(&brick_signs[lid >> 4u], signs << (2u * (lid & 15u)));
    }
    workgroupBarrier();
    if lid == 0u {
        let low = unordered(atomicLoad(&brick_low));
        let high = unordered(atomicLoad(&brick_high));
        let clear = max(low, -high) / (1.01 * g.around);
        var entry = select(OUTSIDE, INSIDE, high < 0.0);
        if clear <= 1.0 || clear <= steepest(b) {
            let slot = take_slot();
            entry = OUTSIDE;
            if slot != NONE {
                entry = NEAR + slot;
                let r = STRIDE * slot;
                bricks[r] = bitcast<u32>(b.x);
                bricks[r + 1u] = bitcast<u32>(b.y);
                bricks[r + 2u] = bitcast<u32>(b.z);
                bricks[r + ALIVE] = 1u;
                bricks[r + TABLE] = b.table;
                bricks[r + VERTEX_COUNT] = 0u;
                bricks[r + TRIANGLE_COUNT] = 0u;
            }
        }
        atomicStore(&pages[entry_at(b.table, block_at(b))], entry);
        brick_entry_now = entry;
    }
    let entry = workgroupUniformLoad(&brick_entry_now);
    if entry < NEAR {
        return;
    }
    let slot = entry - NEAR;
    if lid < 16u {
        bricks[STRIDE * slot + SIGNS + lid] = atomicLoad(&brick_signs[lid]);
    }
    if QUANTISED {
        let low = bitcast<u32>(quantum(pair.x)) & 0xffffu;
        values[256u * slot + lid] = low | (bitcast<u32>(quantum(pair.y)) << 16u);
    } else {
        values[512u * slot + 2u * lid] = bitcast<u32>(pair.x);
        values[512u * slot + 2u * lid + 1u] = bitcast<u32>(pair.y);
    }
}
