// The whole mesh without gaps: scan how much each brick has, then move it together.

@group(0) @binding(15) var<storage, read_write> offsets: array<vec2<u32>>;
@group(0) @binding(16) var<storage, read_write> tight_vertices: array<u32>;
@group(0) @binding(17) var<storage, read_write> tight_indices: array<u32>;
// From a vertex to its number in the mesh without gaps.
@group(0) @binding(18) var<storage, read_write> renumbered: array<u32>;

var<workgroup> sums: array<vec2<u32>, 256>;

fn held(slot: u32) -> vec2<u32> {
    let r = STRIDE * slot;
    if slot < min(atomicLoad(&counters[SLOTS]), g.slots) && bricks[r + ALIVE] == 1u {
        return vec2(bricks[r + VERTEX_COUNT], bricks[r + TRIANGLE_COUNT]);
    }
    return vec2(0u);
}

// Inclusive sums over a group of 256.
fn scanned(lid: u32, own: vec2<u32>) -> vec2<u32> {
    sums[lid] = own;
    workgroupBarrier();
    for (var by = 1u; by < 256u; by <<= 1u) {
        var sum = sums[lid];
        if lid >= by {
            sum += sums[lid - by];
        }
        workgroupBarrier();
        sums[lid] = sum;
        workgroupBarrier();
    }
    return sums[lid];
}

// Offsets within tiles of 256 slots; the tiles' sums come after all slots.
@compute @workgroup_size(256)
fn scan_tiles(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lid: u32) {
    let tile = flat_group(group);
    let slot = 256u * tile + lid;
    let own = held(slot);
    let sum = scanned(lid, own);
    if slot < g.slots {
        offsets[slot] = sum - own;
    }
    if lid == 255u && 256u * tile < g.slots {
        offsets[g.slots + tile] = sum;
    }
}

// Offsets of the tiles; one group.
@compute @workgroup_size(256)
fn scan_sums(@builtin(local_invocation_index) lid: u32) {
    let tiles = (g.slots + 255u) / 256u;
    let each = (tiles + 255u) / 256u;
    var own = vec2(0u);
    for (var k = 0u; k < each; k++) {
        let tile = lid * each + k;
        if tile < tiles {
            own += offsets[g.slots + tile];
        }
    }
    var before = scanned(lid, own) - own;
    for (var k = 0u; k < each; k++) {
        let tile = lid * each + k;
        if tile < tiles {
            let here = offsets[g.slots + tile];
            offsets[g.slots + tile] = before;
            before += here;
        }
    }
}

fn offset_of(slot: u32) -> vec2<u32> {
    return offsets[slot] + offsets[g.slots + slot / 256u];
}

@compute @workgroup_size(64)
fn compact_vertices(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lid: u32) {
    let slot = flat_group(group);
    let n = held(slot).x;
    if n == 0u {
        return;
    }
    let base = bricks[STRIDE * slot + VERTEX_BASE];
    let to = offset_of(slot).x;
    for (var i = lid; i < n; i += 64u) {
        renumbered[base + i] = to + i;
    }
    for (var i = lid; i < 6u * n; i += 64u) {
        tight_vertices[6u * to + i] = vertices[6u * base + i];
    }
}

@compute @workgroup_size(64)
fn compact_triangles(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lid: u32) {
    let slot = flat_group(group);
    let n = held(slot).y;
    if n == 0u {
        return;
    }
    let base = bricks[STRIDE * slot + TRIANGLE_BASE];
    let to = offset_of(slot).y;
    for (var i = lid; i < 3u * n; i += 64u) {
        tight_indices[3u * to + i] = renumbered[indices[3u * base + i]];
    }
}
