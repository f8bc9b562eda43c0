// φ of one leaf: exact primitives and baked meshes, as crates/kernel/field/src/{shape,bake} have them.

const LEAF: u32 = 32u;
const HUGE: f32 = 3.0e38;
const PI: f32 = 3.14159265358979;
const TAU: f32 = 6.28318530717959;

fn number(i: u32) -> f32 {
    return bitcast<f32>(program[i]);
}

fn triple(i: u32) -> vec3<f32> {
    return vec3(number(i), number(i + 1u), number(i + 2u));
}

fn to_local(l: u32, p: vec3<f32>) -> vec3<f32> {
    return triple(l + 4u) * p.x + (triple(l + 7u) * p.y + (triple(l + 10u) * p.z + triple(l + 13u)));
}

// Distance to the quadrant x ≤ 0, y ≤ 0.
fn quadrant(x: f32, y: f32) -> f32 {
    return length(max(vec2(x, y), vec2(0.0))) + min(max(x, y), 0.0);
}

fn slab(d: f32, half: f32, rounding: f32, z: f32) -> f32 {
    return quadrant(d + rounding, abs(z) - half) - rounding;
}

fn frustum(l: u32, p: vec3<f32>) -> f32 {
    let bottom = number(l + 24u);
    let top = number(l + 25u);
    let half = number(l + 26u);
    let side = vec2(bottom - top, -2.0 * half);
    let r = length(p.xz);
    let rim = select(top, bottom, p.y < 0.0);
    let cap = vec2(r - min(r, rim), abs(p.y) - half);
    let d = vec2(r - top, p.y - half);
    let t = clamp(dot(d, side) / dot(side, side), 0.0, 1.0);
    let s = d - t * side;
    let square = min(dot(cap, cap), dot(s, s));
    return select(1.0, -1.0, s.x < 0.0 && cap.y < 0.0) * sqrt(square);
}

fn ellipsoid(l: u32, p: vec3<f32>) -> f32 {
    let unit = number(l + 24u);
    let e = triple(l + 25u);
    let s = triple(l + 28u);
    let q = max(abs(p) / unit, 1.0e-6 * e);
    let a = e * q;
    var w = max(a.x - s.x, max(a.y - s.y, a.z - s.z));
    for (var n = 0; n < 10; n++) {
        let i = 1.0 / (vec3(w) + s);
        let r = a * i;
        let rr = r * r;
        let f = rr.x + rr.y + rr.z - 1.0;
        w += max(f, 0.0) / (2.0 * dot(rr, i));
    }
    let t = w - 1.0;
    return select(1.0, -1.0, t < 0.0) * length(q * t / (vec3(w) + s)) * unit;
}

// Closed contours, even-odd: `program[at]` edges of seven words, then boxes around each eight.
fn polygon(at: u32, p: vec2<f32>) -> f32 {
    let count = program[at];
    let boxes = at + 1u + 7u * count;
    var best = HUGE;
    var inside = false;
    for (var first = 0u; first < count; first += 8u) {
        let b = boxes + first / 2u;
        let low = vec2(number(b), number(b + 1u));
        let high = vec2(number(b + 2u), number(b + 3u));
        let gap = max(max(low - p, p - high), vec2(0.0));
        let close = dot(gap, gap) <= best;
        let crossed = high.x >= p.x && low.y <= p.y && high.y >= p.y;
        if !(close || crossed) {
            continue;
        }
        for (var k = first; k < min(first + 8u, count); k++) {
            let e = at + 1u + 7u * k;
            let a = vec2(number(e), number(e + 1u));
            let d = vec2(number(e + 2u), number(e + 3u));
            if close {
                let q = p - a;
                let t = clamp(dot(q, d) * number(e + 4u), 0.0, 1.0);
                let off = q - t * d;
                best = min(best, dot(off, off));
            }
            if crossed {
                let spans = (a.y > p.y) != (number(e + 5u) > p.y);
                if spans && p.x < a.x + (p.y - a.y) * number(e + 6u) {
                    inside = !inside;
                }
            }
        }
    }
    return select(1.0, -1.0, inside) * sqrt(best);
}

fn plane_at(i: u32, p: vec3<f32>) -> f32 {
    return dot(triple(i), p) - number(i + 3u);
}

// Planes of six words (normal, offset, first wall, walls), edges of seven, walls of four.
fn convex(at: u32, p: vec3<f32>) -> f32 {
    let planes = program[at];
    let edges = program[at + 1u];
    let plane = at + 2u;
    let edge = plane + 6u * planes;
    let wall = edge + 7u * edges;
    var highest = -HUGE;
    for (var k = 0u; k < planes; k++) {
        highest = max(highest, plane_at(plane + 6u * k, p));
    }
    if highest <= 0.0 {
        return highest;
    }
    var best = HUGE;
    for (var k = 0u; k < edges; k++) {
        let e = edge + 7u * k;
        let q = p - triple(e);
        let d = triple(e + 3u);
        let t = clamp(dot(q, d) * number(e + 6u), 0.0, 1.0);
        let off = q - t * d;
        best = min(best, dot(off, off));
    }
    best = sqrt(best);
    for (var k = 0u; k < planes; k++) {
        let i = plane + 6u * k;
        let d = plane_at(i, p);
        if d > 0.0 && d < best {
            var below = true;
            for (var w = 0u; w < program[i + 5u]; w++) {
                below = below && plane_at(wall + 4u * (program[i + 4u] + w), p) <= 0.0;
            }
            if below {
                best = d;
            }
        }
    }
    return max(best, highest);
}

// The functions of the standard may be off by 4096 units in the last place; these are not.
fn arc_tangent(y: f32, x: f32) -> f32 {
    let a = abs(y);
    let b = abs(x);
    let most = max(a, b);
    if most == 0.0 {
        return 0.0;
    }
    var q = min(a, b) / most;
    var base = 0.0;
    if q > 0.41421356 {
        base = 0.25 * PI;
        q = (q - 1.0) / (q + 1.0);
    }
    let z = q * q;
    let series = ((8.05374449538e-2 * z - 1.38776856032e-1) * z + 1.99777106478e-1) * z - 3.33329491539e-1;
    var angle = base + (series * z * q + q);
    if a > b {
        angle = 0.5 * PI - angle;
    }
    if x < 0.0 {
        angle = PI - angle;
    }
    return select(angle, -angle, y < 0.0);
}

fn sine(v: f32) -> f32 {
    let q = v * v;
    return v + v * q * (((2.6041e-6 * q - 1.980742e-4) * q + 8.333025e-3) * q - 1.6666657e-1);
}

fn cosine(v: f32) -> f32 {
    let q = v * v;
    return 1.0 - 0.5 * q + q * q * (((-2.605e-7 * q + 2.47609e-5) * q - 1.3888397e-3) * q + 4.166664e-2);
}

// The first root in 0..π of pull·sin u − c²(s − u), or where the search stopped.
fn helix_root(s: f32, pull: f32, c2: f32) -> f32 {
    var u = 0.0;
    for (var n = 0; n < 8; n++) {
        let v = u - 0.5 * PI;
        let f = pull * cosine(v) - c2 * (s - u);
        let slope = c2 - pull * sine(v);
        u = clamp(u - f / max(slope, 1.0e-12), 0.0, PI);
    }
    return u;
}

fn helix_square(u_free: f32, below: f32, end: f32, gap: f32, near: f32, pull: f32, c2: f32) -> f32 {
    let u = clamp(u_free, -end - below, end - below);
    let h = 0.5 * u;
    let s = sine(h - round(h * (1.0 / PI)) * PI);
    return near + 4.0 * pull * s * s + c2 * (u - gap) * (u - gap);
}

fn helix(l: u32, q: vec3<f32>) -> f32 {
    let major = number(l + 24u);
    let minor = number(l + 25u);
    let rise = number(l + 26u);
    let end = number(l + 28u);
    let z = q.z * number(l + 27u);
    let away = length(vec2(q.x, z));
    let angle = arc_tangent(z, q.x);
    let c2 = rise * rise;
    let pull = away * major;
    let level = q.y / rise;
    let turn = floor((level - angle) / TAU);
    let first = floor((-end - angle) / TAU);
    let last = floor((end - angle) / TAU);
    let below = angle + min(max(turn, first), last) * TAU;
    let gap = level - below;
    let near = (away - major) * (away - major);
    let up = helix_square(helix_root(gap, pull, c2), below, end, gap, near, pull, c2);
    let down = helix_square(TAU - helix_root(TAU - gap, pull, c2), below, end, gap, near, pull, c2);
    let low = helix_square(-end - below, below, end, gap, near, pull, c2);
    let high = helix_square(end - below, below, end, gap, near, pull, c2);
    return sqrt(min(min(up, down), min(low, high))) - minor;
}

// A volume: origin, step, cells, where its summaries begin, then table, ranges, values and summaries.
fn volume_number(i: u32) -> f32 {
    return bitcast<f32>(volumes[i]);
}

struct Frame {
    origin: vec3<f32>,
    step: f32,
    cells: vec3<u32>,
    bricks: vec3<u32>,
    table: u32,
    ranges: u32,
    values: u32,
}

fn frame_of(at: u32) -> Frame {
    var f: Frame;
    f.origin = vec3(volume_number(at), volume_number(at + 1u), volume_number(at + 2u));
    f.step = volume_number(at + 3u);
    f.cells = vec3(volumes[at + 4u], volumes[at + 5u], volumes[at + 6u]);
    f.bricks = (f.cells + vec3(7u)) / 8u;
    f.table = at + 8u;
    f.ranges = f.table + f.bricks.x * f.bricks.y * f.bricks.z;
    f.values = f.ranges + 3u * f.bricks.x * f.bricks.y * f.bricks.z;
    return f;
}

// Trilinear (EasyVRModeling §5.2 Eq. 5–6) in one brick, `q` cells from its first node.
fn in_brick(f: Frame, index: u32, q: vec3<f32>) -> f32 {
    let entry = volumes[f.table + index];
    var i = f.values + (entry & 0x7fffffffu);
    var t = q / 8.0;
    var dy = 2u;
    var dz = 4u;
    if (entry & 0x80000000u) != 0u {
        let l = min(vec3<u32>(q), vec3(7u));
        i += l.x + 9u * (l.y + 9u * l.z);
        t = q - vec3<f32>(l);
        dy = 9u;
        dz = 81u;
    }
    let x0 = mix(volume_number(i), volume_number(i + 1u), t.x);
    let x1 = mix(volume_number(i + dy), volume_number(i + dy + 1u), t.x);
    let x2 = mix(volume_number(i + dz), volume_number(i + dz + 1u), t.x);
    let x3 = mix(volume_number(i + dy + dz), volume_number(i + dy + dz + 1u), t.x);
    return mix(mix(x0, x1, t.y), mix(x2, x3, t.y), t.z);
}

// The same at grid coordinates within the box.
fn interpolate(f: Frame, q: vec3<f32>) -> f32 {
    let cell = min(vec3<u32>(q), f.cells - vec3(1u));
    let brick = cell / 8u;
    let index = brick.x + f.bricks.x * (brick.y + f.bricks.y * brick.z);
    return in_brick(f, index, q - vec3<f32>(brick * 8u));
}

fn volume(at: u32, p: vec3<f32>) -> f32 {
    let f = frame_of(at);
    let q = (p - f.origin) / f.step;
    let inside = clamp(q, vec3(0.0), vec3<f32>(f.cells));
    let off = q - inside;
    let beyond = dot(off, off);
    let rim = interpolate(f, inside);
    if beyond == 0.0 {
        return rim;
    }
    let r = max(rim, 0.0);
    return sqrt(beyond * f.step * f.step + r * r);
}

// What is known of bricks together: by one, by eight, by 64 …, so that no more than four along an axis are looked at.
struct Summaries {
    level: u32,
    // How many there are, and where they begin.
    count: vec3<u32>,
    first: u32,
}

fn summaries(at: u32, f: Frame, lo: vec3<u32>, hi: vec3<u32>) -> Summaries {
    var s = Summaries(0u, f.bricks, f.ranges);
    while any((hi >> vec3(s.level)) - (lo >> vec3(s.level)) > vec3(3u)) {
        s.first = select(s.first + 3u * s.count.x * s.count.y * s.count.z, at + volumes[at + 7u], s.level == 0u);
        s.count = (s.count + vec3(1u)) / 2u;
        s.level++;
    }
    return s;
}

// Bounds of a volume no further than `radius` from the middle of a box, from its bricks' summaries.
fn volume_bounds(at: u32, low: vec3<f32>, high: vec3<f32>, radius_in: f32) -> vec2<f32> {
    let f = frame_of(at);
    let top = vec3<f32>(f.cells);
    let a = (low - f.origin) / f.step - vec3(1.0e-3);
    let b = (high - f.origin) / f.step + vec3(1.0e-3);
    let p = clamp(a, vec3(0.0), top);
    let q = clamp(b, vec3(0.0), top);
    var lo = min(vec3<u32>(p / 8.0), f.bricks - vec3(1u));
    var hi = min(vec3<u32>(q / 8.0), f.bricks - vec3(1u));
    let s = summaries(at, f, lo, hi);
    lo = lo >> vec3(s.level);
    hi = hi >> vec3(s.level);
    let side = f32(8u << s.level);
    let centre = clamp(0.5 * (a + b), vec3(0.0), top);
    let radius = radius_in / f.step + 2.0e-3;
    var least = HUGE;
    var greatest = -HUGE;
    for (var z = lo.z; z <= hi.z; z++) {
        for (var y = lo.y; y <= hi.y; y++) {
            for (var x = lo.x; x <= hi.x; x++) {
                let index = x + s.count.x * (y + s.count.y * z);
                let first = vec3<f32>(vec3(x, y, z)) * side;
                let near = clamp(centre, first, min(first + vec3(side), top));
                let away = centre - near;
                let reach = radius * radius - dot(away, away);
                if reach < 0.0 {
                    continue;
                }
                var low_here = volume_number(s.first + 3u * index);
                var high_here = volume_number(s.first + 3u * index + 1u);
                let slope = volume_number(s.first + 3u * index + 2u);
                if s.level == 0u && (volumes[f.table + index] & 0x80000000u) != 0u && slope < HUGE {
                    let v = in_brick(f, index, near - first);
                    let most = slope * sqrt(reach);
                    low_here = max(low_here, v - most);
                    high_here = min(high_here, v + most);
                }
                least = min(least, low_here);
                greatest = max(greatest, high_here);
            }
        }
    }
    let above = max(max(-a, b - top), vec3(0.0));
    if any(above > vec3(0.0)) {
        let below = max(max(-b, a - top), vec3(0.0));
        let gap = length(below) * f.step * 0.99999;
        if gap > 0.0 {
            least = max(least, 0.0);
            least = sqrt(gap * gap + least * least);
        } else {
            // Beyond the box φ is positive, whatever it is at the rim.
            least = min(least, 0.0);
        }
        let far = length(above) * f.step * 1.00001;
        greatest = max(greatest, 0.0);
        greatest = sqrt(far * far + greatest * greatest);
    }
    return vec2(least, greatest);
}

const VOLUME: u32 = 11u;

// φ of a leaf in its own frame.
fn shape_at(l: u32, p: vec3<f32>) -> f32 {
    let a = number(l + 24u);
    switch program[l] {
        case 0u: { return length(p) - a; }
        case 1u: {
            let d = abs(p) - triple(l + 24u);
            return length(max(d, vec3(0.0))) + min(max(d.x, max(d.y, d.z)), 0.0) - number(l + 27u);
        }
        case 2u: {
            return quadrant(length(p.xz) - a, abs(p.y) - number(l + 25u)) - number(l + 26u);
        }
        case 3u: { return frustum(l, p); }
        case 4u: { return length(vec2(length(p.xz) - a, p.y)) - number(l + 25u); }
        case 5u: {
            return length(vec3(p.x, max(abs(p.y) - number(l + 25u), 0.0), p.z)) - a;
        }
        case 6u: { return ellipsoid(l, p); }
        case 7u: {
            return slab(polygon(g.shapes + program[l + 1u], p.xy), number(l + 24u), number(l + 25u), p.z);
        }
        case 8u: { return polygon(g.shapes + program[l + 1u], vec2(length(p.xz), p.y)); }
        case 9u: { return convex(g.shapes + program[l + 1u], p); }
        case 10u: { return helix(l, p); }
        case 11u: { return volume(program[l + 1u], p); }
        default: { return HUGE; }
    }
}

fn leaf_at(leaf: u32, p: vec3<f32>) -> f32 {
    let l = LEAF * leaf;
    return number(l + 2u) * shape_at(l, to_local(l, p));
}

// Bounds of a leaf no further than `around` from the cube of half side `half` about `centre`.
fn leaf_bounds(leaf: u32, centre: vec3<f32>, half: f32, around: f32) -> vec2<f32> {
    let l = LEAF * leaf;
    let c = to_local(l, centre);
    let scale = number(l + 2u);
    let r = half * number(l + 3u) + around / scale;
    if program[l] == VOLUME {
        let size = triple(l + 16u) * half + triple(l + 19u) * around;
        return scale * volume_bounds(program[l + 1u], c - size, c + size, r);
    }
    // |∇φ_local| ≤ 1.
    let v = shape_at(l, c);
    return scale * vec2(v - r, v + r);
}

// The greatest |∇φ| of a leaf no further than `around` from a cube, HUGE where it is not known.
fn leaf_slope(leaf: u32, centre: vec3<f32>, half: f32, around: f32) -> f32 {
    let l = LEAF * leaf;
    if program[l] != VOLUME {
        return 1.0;
    }
    let f = frame_of(program[l + 1u]);
    let c = to_local(l, centre);
    let size = triple(l + 16u) * half + triple(l + 19u) * around;
    let low = (c - size - f.origin) / f.step - vec3(1.0e-3);
    let high = (c + size - f.origin) / f.step + vec3(1.0e-3);
    if any(low < vec3(0.0)) || any(high > vec3<f32>(f.cells)) {
        return HUGE;
    }
    var lo = vec3<u32>(low / 8.0);
    var hi = min(vec3<u32>(high / 8.0), f.bricks - vec3(1u));
    let s = summaries(program[l + 1u], f, lo, hi);
    lo = lo >> vec3(s.level);
    hi = hi >> vec3(s.level);
    var most = 0.0;
    for (var z = lo.z; z <= hi.z; z++) {
        for (var y = lo.y; y <= hi.y; y++) {
            for (var x = lo.x; x <= hi.x; x++) {
                let index = x + s.count.x * (y + s.count.y * z);
                most = max(most, volume_number(s.first + 3u * index + 2u));
            }
        }
    }
    return select(HUGE, most / f.step, most < HUGE);
}
