// From triangles to a smooth surface (3DBrushVR §4.2): voxels whose middles are the lattice's nodes, the
// cubes that triangles touch, a scanline fill, and the mean of the 27 around each node.

// The mesh: for each triangle its three corners, then the corners' places in metres.
@group(0) @binding(19) var<storage, read> corners: array<u32>;
// One bit to a voxel, x fastest, rows of whole words: touched, then crossings of lines along x, which the fill
// makes what lies inside.
@group(0) @binding(20) var<storage, read_write> voxels: array<atomic<u32>>;

// The voxels: from g.mesh_low to g.mesh_high.
fn extent() -> vec3<i32> {
    return g.mesh_high - g.mesh_low + 1;
}

fn row_words() -> u32 {
    return (u32(extent().x) + 31u) / 32u;
}

fn row_of(y: i32, z: i32) -> u32 {
    return row_words() * u32(y - g.mesh_low.y + extent().y * (z - g.mesh_low.z));
}

fn all_words() -> u32 {
    return row_words() * u32(extent().y * extent().z);
}

// In steps.
fn corner(triangle: u32, k: u32) -> vec3<f32> {
    let i = 3u * (g.shapes + corners[3u * triangle + k]);
    return bitcast<vec3<f32>>(vec3(corners[i], corners[i + 1u], corners[i + 2u])) / g.step;
}

// Whether the shadows of a triangle and of the unit cube about the origin part along an axis.
fn parted(axis: vec3<f32>, a: vec3<f32>, b: vec3<f32>, c: vec3<f32>) -> bool {
    let p = vec3(dot(axis, a), dot(axis, b), dot(axis, c));
    let r = 0.5 * (abs(axis.x) + abs(axis.y) + abs(axis.z));
    return min(p.x, min(p.y, p.z)) > r || max(p.x, max(p.y, p.z)) < -r;
}

fn touches(middle: vec3<f32>, p: vec3<f32>, q: vec3<f32>, r: vec3<f32>) -> bool {
    let a = p - middle;
    let b = q - middle;
    let c = r - middle;
    if any(min(a, min(b, c)) > vec3(0.5)) || any(max(a, max(b, c)) < vec3(-0.5)) {
        return false;
    }
    if parted(cross(b - a, c - a), a, b, c) {
        return false;
    }
    for (var k = 0u; k < 3u; k++) {
        var e = b - a;
        if k == 1u {
            e = c - b;
        } else if k == 2u {
            e = a - c;
        }
        if parted(vec3(0.0, -e.z, e.y), a, b, c) || parted(vec3(e.z, 0.0, -e.x), a, b, c)
            || parted(vec3(-e.y, e.x, 0.0), a, b, c) {
            return false;
        }
    }
    return true;
}

// Where an edge crosses the height z, from the same end whichever triangle asks.
fn crossing(a: vec3<f32>, b: vec3<f32>, z: f32) -> f32 {
    let first = a.z < b.z || (a.z == b.z && a.y < b.y);
    let low = select(b, a, first);
    let high = select(a, b, first);
    return low.y + (z - low.z) / (high.z - low.z) * (high.y - low.y);
}

fn beyond(a: vec3<f32>, b: vec3<f32>, y: f32, z: f32) -> bool {
    return ((a.z > z) != (b.z > z)) && y < crossing(a, b, z);
}

// One group to a triangle.
@compute @workgroup_size(64)
fn shell(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lid: u32) {
    let t = flat_group(group);
    if t >= g.shapes {
        return;
    }
    let a = corner(t, 0u);
    let b = corner(t, 1u);
    let c = corner(t, 2u);
    let low = max(vec3<i32>(floor(min(a, min(b, c)) + 0.5)), g.mesh_low);
    let high = min(vec3<i32>(floor(max(a, max(b, c)) + 0.5)), g.mesh_high);
    let size = vec3<u32>(max(high - low + 1, vec3(0)));
    let lines = size.y * size.z;
    let n = cross(b - a, c - a);
    for (var i = lid; i < lines; i += 64u) {
        let y = low.y + i32(i % size.y);
        let z = low.z + i32(i / size.y);
        let row = row_of(y, z);
        let at = vec2(f32(y), f32(z));
        for (var x = low.x; x <= high.x; x++) {
            if touches(vec3(f32(x), at.x, at.y), a, b, c) {
                let bit = u32(x - g.mesh_low.x);
                atomicOr(&voxels[row + (bit >> 5u)], 1u << (bit & 31u));
            }
        }
        let inside = (beyond(a, b, at.x, at.y) != beyond(b, c, at.x, at.y)) != beyond(c, a, at.x, at.y);
        if inside && n.x != 0.0 {
            // The first voxel whose middle lies beyond the plane along x.
            let x = a.x - (n.y * (at.x - a.y) + n.z * (at.y - a.z)) / n.x;
            let first = clamp(i32(ceil(clamp(x, f32(low.x) - 1.0, f32(high.x) + 1.0))), g.mesh_low.x, g.mesh_high.x);
            let bit = u32(first - g.mesh_low.x);
            atomicXor(&voxels[all_words() + row + (bit >> 5u)], 1u << (bit & 31u));
        }
    }
}

// Each line of cubes from its crossings (§4.2.1 f): one thread to a line.
@compute @workgroup_size(64)
fn fill(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lid: u32) {
    let line = 64u * flat_group(group) + lid;
    let words = row_words();
    if line >= u32(extent().y * extent().z) {
        return;
    }
    var odd = 0u;
    for (var w = 0u; w < words; w++) {
        let at = line * words + w;
        var word = atomicLoad(&voxels[all_words() + at]);
        for (var by = 1u; by < 32u; by <<= 1u) {
            word ^= word << by;
        }
        word ^= odd;
        odd = select(0u, NONE, (word >> 31u) == 1u);
        atomicStore(&voxels[all_words() + at], word | atomicLoad(&voxels[at]));
    }
}

fn voxel(n: vec3<i32>) -> u32 {
    if any(n < g.mesh_low) || any(n > g.mesh_high) {
        return 0u;
    }
    let bit = u32(n.x - g.mesh_low.x);
    return (atomicLoad(&voxels[all_words() + row_of(n.y, n.z) + (bit >> 5u)]) >> (bit & 31u)) & 1u;
}

// How many of the 27 voxels around a node are filled (§4.2.2).
fn filled(n: vec3<i32>) -> u32 {
    var sum = 0u;
    for (var i = 0u; i < 27u; i++) {
        sum += voxel(n + vec3<i32>(vec3(i % 3u, i / 3u % 3u, i / 9u)) - 1);
    }
    return sum;
}

var<workgroup> fewest: atomic<u32>;
var<workgroup> most: atomic<u32>;
var<workgroup> entry_now: u32;

// The potential as a field: (T − F) · 3 steps, whose slope is 1 where the surface is flat. One group to a brick.
@compute @workgroup_size(8, 8, 4)
fn smoothed(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lid: u32) {
    let i = flat_group(group);
    let size = vec3<u32>(g.high - g.low + 1);
    if i >= size.x * size.y * size.z {
        return;
    }
    let brick = g.low + vec3<i32>(vec3(i % size.x, i / size.x % size.y, i / (size.x * size.y)));
    if lid == 0u {
        atomicStore(&fewest, NONE);
        atomicStore(&most, 0u);
    }
    workgroupBarrier();
    var sums: array<u32, 2>;
    for (var k = 0u; k < 2u; k++) {
        let node = lid + 256u * k;
        sums[k] = filled(brick * 8 + vec3<i32>(vec3(node & 7u, (node >> 3u) & 7u, node >> 6u)));
        atomicMin(&fewest, sums[k]);
        atomicMax(&most, sums[k]);
    }
    workgroupBarrier();
    if lid == 0u {
        // Every brick that is looked at lies in a chunk with a table.
        let table = table_of(find(brick >> vec3(3u), 3u));
        var entry = OUTSIDE;
        if atomicLoad(&fewest) == 27u {
            entry = INSIDE;
        } else if atomicLoad(&most) > 0u {
            let slot = atomicAdd(&counters[SLOTS], 1u);
            if slot < g.slots {
                entry = NEAR + slot;
                let r = STRIDE * slot;
                let u = bitcast<vec3<u32>>(brick);
                bricks[r] = u.x;
                bricks[r + 1u] = u.y;
                bricks[r + 2u] = u.z;
                bricks[r + ALIVE] = 1u;
                bricks[r + TABLE] = table;
                bricks[r + VERTEX_COUNT] = 0u;
                bricks[r + TRIANGLE_COUNT] = 0u;
            } else {
                failed(NO_SLOTS);
            }
        }
        atomicStore(&pages[entry_at(table, brick)], entry);
        entry_now = entry;
    }
    let entry = workgroupUniformLoad(&entry_now);
    if entry < NEAR {
        return;
    }
    for (var k = 0u; k < 2u; k++) {
        let phi = (0.5 - f32(sums[k]) / 27.0) * 3.0 * g.step;
        values[512u * (entry - NEAR) + lid + 256u * k] = bitcast<u32>(phi);
    }
}
