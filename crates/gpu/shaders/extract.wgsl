// From bricks to indexed triangles by marching cubes, one vertex to a crossed edge
// (crates/kernel/surface has the same cases): classify, count and take room, emit.

var<workgroup> piece_now: u32;

// The group's piece of work, the same for all of it, or NONE: a slot in the low bits; the next to highest bit
// says that room in the mesh is taken anew. Without an edit all slots are.
fn piece(index: u32, lid: u32) -> u32 {
    if lid == 0u {
        piece_now = NONE;
        if g.update == 0u {
            if index < min(atomicLoad(&counters[SLOTS]), g.slots) {
                piece_now = index | 0x40000000u;
            }
        } else if index < atomicLoad(&counters[WORK]) {
            piece_now = work[index];
        }
    }
    return workgroupUniformLoad(&piece_now);
}

fn slot_of(p: u32) -> u32 {
    return p & 0x3fffffffu;
}

fn coordinate(slot: u32) -> vec3<i32> {
    let r = STRIDE * slot;
    return bitcast<vec3<i32>>(vec3(bricks[r], bricks[r + 1u], bricks[r + 2u]));
}

var<workgroup> sign_words: array<atomic<u32>, 16>;

// Which nodes lie inside.
@compute @workgroup_size(256)
fn classify(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lid: u32) {
    let p = piece(flat_group(group), lid);
    if p == NONE {
        return;
    }
    let slot = slot_of(p);
    if lid < 16u {
        atomicStore(&sign_words[lid], 0u);
    }
    workgroupBarrier();
    for (var k = 0u; k < 2u; k++) {
        let node = lid + 256u * k;
        if value(slot, node) <= -g.eps {
            atomicOr(&sign_words[node >> 5u], 1u << (node & 31u));
        }
    }
    workgroupBarrier();
    if lid < 16u {
        bricks[STRIDE * slot + SIGNS + lid] = atomicLoad(&sign_words[lid]);
    }
}

// Entries of the bricks around, −1 to 1 along each axis.
var<workgroup> near: array<u32, 27>;
var<workgroup> inside_nodes: array<u32, 729>;
var<workgroup> crossed_words: array<atomic<u32>, 48>;
var<workgroup> triangle_sum: atomic<u32>;

fn node_sign(l: vec3<i32>) -> u32 {
    let d = (l >> vec3(3u)) + 1;
    let entry = near[d.x + 3 * d.y + 9 * d.z];
    if entry < NEAR {
        return entry;
    }
    let node = within(l);
    return (bricks[STRIDE * (entry - NEAR) + SIGNS + (node >> 5u)] >> (node & 31u)) & 1u;
}

fn cell_case(node: u32) -> u32 {
    let base = (node & 7u) + 9u * ((node >> 3u) & 7u) + 81u * (node >> 6u);
    return inside_nodes[base] | (inside_nodes[base + 1u] << 1u)
        | (inside_nodes[base + 9u] << 2u) | (inside_nodes[base + 10u] << 3u)
        | (inside_nodes[base + 81u] << 4u) | (inside_nodes[base + 82u] << 5u)
        | (inside_nodes[base + 90u] << 6u) | (inside_nodes[base + 91u] << 7u);
}

fn fill_signs(lid: u32) {
    for (var i = lid; i < 729u; i += 256u) {
        inside_nodes[i] = node_sign(vec3<i32>(vec3(i % 9u, i / 9u % 9u, i / 81u)));
    }
}

// Crossed edges by axis, how many lie before each word, and room in the mesh for the brick's share:
// the vertices on edges that start at its nodes, the triangles of cells that do.
@compute @workgroup_size(256)
fn count(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lid: u32) {
    let p = piece(flat_group(group), lid);
    if p == NONE || (p & 0x40000000u) == 0u {
        return;
    }
    let slot = slot_of(p);
    let c = coordinate(slot);
    if lid < 8u {
        let d = vec3<i32>(vec3(lid & 1u, (lid >> 1u) & 1u, lid >> 2u));
        near[13 + d.x + 3 * d.y + 9 * d.z] = brick_entry(c + d);
    }
    if lid < 48u {
        atomicStore(&crossed_words[lid], 0u);
    }
    if lid == 0u {
        atomicStore(&triangle_sum, 0u);
    }
    workgroupBarrier();
    fill_signs(lid);
    workgroupBarrier();
    for (var k = 0u; k < 2u; k++) {
        let node = lid + 256u * k;
        let case_now = cell_case(node);
        if case_now != 0u && case_now != 255u {
            atomicAdd(&triangle_sum, cases[case_now].z);
            let bit = 1u << (node & 31u);
            let own = case_now & 1u;
            for (var axis = 0u; axis < 3u; axis++) {
                if ((case_now >> (1u << axis)) & 1u) != own {
                    atomicOr(&crossed_words[16u * axis + (node >> 5u)], bit);
                }
            }
        }
    }
    workgroupBarrier();
    let r = STRIDE * slot;
    if lid < 48u {
        bricks[r + CROSSED + lid] = atomicLoad(&crossed_words[lid]);
    }
    if lid == 0u {
        var sum = 0u;
        for (var w = 0u; w < 24u; w++) {
            let first = sum;
            sum += countOneBits(atomicLoad(&crossed_words[2u * w]));
            bricks[r + BEFORE + w] = first | (sum << 16u);
            sum += countOneBits(atomicLoad(&crossed_words[2u * w + 1u]));
        }
        let triangles = atomicLoad(&triangle_sum);
        var v = 0u;
        var t = 0u;
        if sum > 0u {
            v = take_vertices(sum);
        }
        if triangles > 0u {
            t = take_triangles(triangles);
        }
        if v != NONE && t != NONE {
            bricks[r + VERTEX_BASE] = v;
            bricks[r + VERTEX_COUNT] = sum;
            bricks[r + TRIANGLE_BASE] = t;
            bricks[r + TRIANGLE_COUNT] = triangles;
            atomicAdd(&counters[ALL_VERTICES], sum);
            atomicAdd(&counters[ALL_TRIANGLES], triangles);
        }
    }
}

// Values of the brick's nodes and of those around it, −1..=9 along each axis.
var<workgroup> padded: array<f32, 1331>;
// Bits 0 to 2 of each cell's number of triangles.
var<workgroup> planes: array<atomic<u32>, 48>;

fn padded_value(l: vec3<i32>) -> f32 {
    let d = (l >> vec3(3u)) + 1;
    let entry = near[d.x + 3 * d.y + 9 * d.z];
    let far = 8.0 * g.step;
    if entry < NEAR {
        return select(far, -far, entry == INSIDE);
    }
    return value(entry - NEAR, within(l));
}

fn vertex_of(axis: u32, l: vec3<i32>) -> u32 {
    let d = (l >> vec3(3u)) + 1;
    let entry = near[d.x + 3 * d.y + 9 * d.z];
    if entry < NEAR {
        return 0u;
    }
    return bricks[STRIDE * (entry - NEAR) + VERTEX_BASE] + rank(entry - NEAR, axis, within(l));
}

// How many crossed edges of a brick come before one.
fn rank(slot: u32, axis: u32, node: u32) -> u32 {
    let r = STRIDE * slot;
    let word = 16u * axis + (node >> 5u);
    let pair = bricks[r + BEFORE + (word >> 1u)];
    let before = select(pair & 0xffffu, pair >> 16u, (word & 1u) == 1u);
    let below = bricks[r + CROSSED + word] & ((1u << (node & 31u)) - 1u);
    return before + countOneBits(below);
}

fn magnitude(v: f32) -> f32 {
    return max(abs(v), g.eps);
}

fn put(at: u32, v: vec3<f32>) {
    vertices[at] = bitcast<u32>(v.x);
    vertices[at + 1u] = bitcast<u32>(v.y);
    vertices[at + 2u] = bitcast<u32>(v.z);
}

fn emit_vertex(slot: u32, c: vec3<i32>, axis: u32, node: u32) {
    let strides = array<u32, 3>(1u, 11u, 121u);
    let s = strides[axis];
    let u = strides[(axis + 1u) % 3u];
    let v = strides[(axis + 2u) % 3u];
    let l = vec3(node & 7u, (node >> 3u) & 7u, node >> 6u);
    let o = (l.x + 1u) + 11u * (l.y + 1u) + 121u * (l.z + 1u);
    let a = magnitude(padded[o]);
    let b = magnitude(padded[o + s]);
    // A thousandth of a step moves nothing visibly; far from the origin f32 needs more room.
    let low = vec3<f32>(c) * 8.0;
    let reach = max(abs(low.x), max(abs(low.y), abs(low.z))) + 8.0;
    let margin = clamp(reach * 8.0 * 1.1920929e-7, 1.0e-3, 0.25);
    let t = clamp(a / (a + b), margin, 1.0 - margin);
    var p = low + vec3<f32>(l);
    p[axis] += t;
    let along = mix(padded[o + s] - padded[o - s], padded[o + 2u * s] - padded[o], t);
    let across = mix(padded[o + u] - padded[o - u], padded[o + s + u] - padded[o + s - u], t);
    let beside = mix(padded[o + v] - padded[o - v], padded[o + s + v] - padded[o + s - v], t);
    var n = vec3(0.0);
    n[axis] = along;
    n[(axis + 1u) % 3u] = across;
    n[(axis + 2u) % 3u] = beside;
    let square = dot(n, n);
    if square > g.eps * g.eps && square < HUGEST {
        n = n / sqrt(square);
    } else {
        // No gradient to speak of: across the surface along the edge.
        n = vec3(0.0);
        n[axis] = select(-1.0, 1.0, padded[o] <= -g.eps);
    }
    let at = 6u * (bricks[STRIDE * slot + VERTEX_BASE] + rank(slot, axis, node));
    put(at, p * g.step);
    put(at + 3u, n);
}

const HUGEST: f32 = 3.0e38;

fn emit_cell(base: u32, node: u32) {
    let case_now = cell_case(node);
    let row = cases[case_now];
    if row.z == 0u {
        return;
    }
    var first = 0u;
    let word = node >> 5u;
    let below = (1u << (node & 31u)) - 1u;
    for (var k = 0u; k < 3u; k++) {
        var sum = countOneBits(atomicLoad(&planes[16u * k + word]) & below);
        for (var w = 0u; w < word; w++) {
            sum += countOneBits(atomicLoad(&planes[16u * k + w]));
        }
        first += sum << k;
    }
    let l = vec3<i32>(vec3(node & 7u, (node >> 3u) & 7u, node >> 6u));
    for (var k = 0u; k < 3u * row.z; k++) {
        let edge = (select(row.x, row.y, k >= 8u) >> (4u * (k & 7u))) & 15u;
        let axis = edge >> 2u;
        var at = l;
        at[(axis + 1u) % 3u] += i32(edge & 1u);
        at[(axis + 2u) % 3u] += i32((edge >> 1u) & 1u);
        indices[3u * (base + first) + k] = vertex_of(axis, at);
    }
}

@compute @workgroup_size(256)
fn emit(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lid: u32) {
    let p = piece(flat_group(group), lid);
    if p == NONE {
        return;
    }
    let slot = slot_of(p);
    let r = STRIDE * slot;
    if lid == 0u {
        piece_now = bricks[r + VERTEX_COUNT] + bricks[r + TRIANGLE_COUNT];
    }
    if workgroupUniformLoad(&piece_now) == 0u {
        return;
    }
    let c = coordinate(slot);
    if lid < 27u {
        let d = vec3<i32>(vec3(lid % 3u, lid / 3u % 3u, lid / 9u)) - 1;
        near[lid] = brick_entry(c + d);
    }
    if lid < 48u {
        atomicStore(&planes[lid], 0u);
    }
    workgroupBarrier();
    for (var i = lid; i < 1331u; i += 256u) {
        padded[i] = padded_value(vec3<i32>(vec3(i % 11u, i / 11u % 11u, i / 121u)) - 1);
    }
    fill_signs(lid);
    workgroupBarrier();
    for (var k = 0u; k < 2u; k++) {
        let node = lid + 256u * k;
        let triangles = cases[cell_case(node)].z;
        for (var bit = 0u; bit < 3u; bit++) {
            if ((triangles >> bit) & 1u) == 1u {
                atomicOr(&planes[16u * bit + (node >> 5u)], 1u << (node & 31u));
            }
        }
        for (var axis = 0u; axis < 3u; axis++) {
            let word = bricks[r + CROSSED + 16u * axis + (node >> 5u)];
            if ((word >> (node & 31u)) & 1u) == 1u {
                emit_vertex(slot, c, axis, node);
            }
        }
    }
    workgroupBarrier();
    let base = bricks[r + TRIANGLE_BASE];
    if bricks[r + TRIANGLE_COUNT] > 0u {
        emit_cell(base, lid);
        emit_cell(base, lid + 256u);
    }
}
