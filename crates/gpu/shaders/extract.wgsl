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

// Which nodes lie inside, of values that `fuse` did not make.
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
        near[13 + d.x + 3 * d.y + 9 * d.z] = entry_beside(bricks[STRIDE * slot + TABLE], c, c + d);
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
// How many are set in the words before, of each of the three.
var<workgroup> planes_before: array<u32, 48>;
// The cells that the surface crosses, few of a brick's: number and case. Threads that go through these have all something to do.
var<workgroup> busy: array<u32, 512>;
var<workgroup> busy_count: atomic<u32>;

fn padded_value(l: vec3<i32>) -> f32 {
    let d = (l >> vec3(3u)) + 1;
    let entry = near[d.x + 3 * d.y + 9 * d.z];
    let far = 8.0 * g.step;
    if entry < NEAR {
        return select(far, -far, entry == INSIDE);
    }
    return value(entry - NEAR, within(l));
}

// The brick's own crossed edges and how many lie before each two words, as its record has them: nearly all vertices that its
// triangles name are its own.
var<workgroup> own_ranks: array<u32, 72>;

fn own_rank(axis: u32, node: u32) -> u32 {
    let word = 16u * axis + (node >> 5u);
    let pair = own_ranks[48u + (word >> 1u)];
    let before = select(pair & 0xffffu, pair >> 16u, (word & 1u) == 1u);
    return before + countOneBits(own_ranks[word] & ((1u << (node & 31u)) - 1u));
}

fn vertex_of(own_base: u32, axis: u32, l: vec3<i32>) -> u32 {
    if all(l < vec3(8)) {
        return own_base + own_rank(axis, within(l));
    }
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

fn emit_vertex(own_base: u32, c: vec3<i32>, axis: u32, node: u32) {
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
    let at = 6u * (own_base + own_rank(axis, node));
    put(at, p * g.step);
    put(at + 3u, n);
}

const HUGEST: f32 = 3.0e38;

fn emit_cell(own_base: u32, base: u32, case_now: u32, node: u32) {
    let row = cases[case_now];
    var first = 0u;
    let below = (1u << (node & 31u)) - 1u;
    for (var k = 0u; k < 3u; k++) {
        let word = 16u * k + (node >> 5u);
        first += (planes_before[word] + countOneBits(atomicLoad(&planes[word]) & below)) << k;
    }
    let l = vec3<i32>(vec3(node & 7u, (node >> 3u) & 7u, node >> 6u));
    for (var k = 0u; k < 3u * row.z; k++) {
        let edge = (select(row.x, row.y, k >= 8u) >> (4u * (k & 7u))) & 15u;
        let axis = edge >> 2u;
        var at = l;
        at[(axis + 1u) % 3u] += i32(edge & 1u);
        at[(axis + 2u) % 3u] += i32((edge >> 1u) & 1u);
        indices[3u * (base + first) + k] = vertex_of(own_base, axis, at);
    }
}

// Which of the eight nodes of a cell lie inside.
fn padded_case(node: u32) -> u32 {
    let o = (node & 7u) + 1u + 11u * (((node >> 3u) & 7u) + 1u) + 121u * ((node >> 6u) + 1u);
    var found = 0u;
    for (var k = 0u; k < 8u; k++) {
        let at = o + (k & 1u) + 11u * ((k >> 1u) & 1u) + 121u * (k >> 2u);
        found |= select(0u, 1u << k, padded[at] <= -g.eps);
    }
    return found;
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
        atomicStore(&busy_count, 0u);
    }
    if workgroupUniformLoad(&piece_now) == 0u {
        return;
    }
    let c = coordinate(slot);
    if lid < 27u {
        let d = vec3<i32>(vec3(lid % 3u, lid / 3u % 3u, lid / 9u)) - 1;
        near[lid] = entry_beside(bricks[r + TABLE], c, c + d);
    }
    if lid < 48u {
        atomicStore(&planes[lid], 0u);
    }
    // CROSSED and BEFORE lie one after the other.
    if lid < 72u {
        own_ranks[lid] = bricks[r + CROSSED + lid];
    }
    workgroupBarrier();
    for (var i = lid; i < 1331u; i += 256u) {
        padded[i] = padded_value(vec3<i32>(vec3(i % 11u, i / 11u % 11u, i / 121u)) - 1);
    }
    workgroupBarrier();
    for (var k = 0u; k < 2u; k++) {
        let node = lid + 256u * k;
        let case_now = padded_case(node);
        if case_now != 0u && case_now != 255u {
            busy[atomicAdd(&busy_count, 1u)] = node | (case_now << 9u);
            let triangles = cases[case_now].z;
            for (var bit = 0u; bit < 3u; bit++) {
                if ((triangles >> bit) & 1u) == 1u {
                    atomicOr(&planes[16u * bit + (node >> 5u)], 1u << (node & 31u));
                }
            }
        }
    }
    workgroupBarrier();
    if lid < 48u {
        var sum = 0u;
        for (var w = lid & 48u; w < lid; w++) {
            sum += countOneBits(atomicLoad(&planes[w]));
        }
        planes_before[lid] = sum;
    }
    workgroupBarrier();
    let own_base = bricks[r + VERTEX_BASE];
    let base = bricks[r + TRIANGLE_BASE];
    let any = bricks[r + TRIANGLE_COUNT] > 0u;
    let all = atomicLoad(&busy_count);
    for (var i = lid; i < all; i += 256u) {
        let node = busy[i] & 511u;
        let case_now = busy[i] >> 9u;
        for (var axis = 0u; axis < 3u; axis++) {
            if ((case_now >> (1u << axis)) & 1u) != (case_now & 1u) {
                emit_vertex(own_base, c, axis, node);
            }
        }
        if any {
            emit_cell(own_base, base, case_now, node);
        }
    }
}
