// What is settled about a painting in a block without looking at its nodes, as crates/kernel/field/src/canvas has it.

// Chunks in one block beyond which bounds are not worth their time.
const MANY: u32 = 200u;

var<private> inner_bounds: array<vec2<f32>, INNER>;

// Bounds of φ of the solid that a stroke is made of, no further than `around` from a cube of the world, and the greatest slope of any of its parts.
fn solid_bounds(c: u32, s: u32, cube: vec4<f32>, around: f32) -> vec3<f32> {
    let tape_at = c + program[s + 19u];
    var depth = 0u;
    var top = vec2(HUGE);
    var steep = 1.0;
    for (var i = 0u; i < program[s + 20u]; i++) {
        let instr = program[tape_at + i];
        let op = instr >> 29u;
        if op == 0u {
            inner_bounds[min(depth, INNER - 1u)] = top;
            depth++;
            let leaf = instr & 0x1fffffffu;
            top = leaf_bounds(leaf, cube.xyz, cube.w, around) + vec2(-g.slack, g.slack);
            steep = max(steep, leaf_slope(leaf, cube.xyz, cube.w, around));
        } else if op == 1u {
            top = -top.yx;
        } else {
            depth--;
            let a = inner_bounds[min(depth, INNER - 1u)];
            switch op {
                case 2u: { top = min(a, top); }
                case 3u: { top = max(a, top); }
                default: { top = max(a, -top.yx); }
            }
        }
    }
    return vec3(top, steep);
}

// Bounds of F in a block, of the scales of what was painted there, and of |∇F|.
struct Felt {
    low: f32,
    high: f32,
    finest: f32,
    widest: f32,
    slope: f32,
    // What the twins before come to.
    twins: vec2<f32>,
    known: bool,
}

var<private> felts: array<Felt, NESTED>;

fn nothing_felt() -> Felt {
    var f: Felt;
    f.finest = UNKNOWN;
    f.known = true;
    return f;
}

fn touches(chunk: u32, low: vec3<f32>, high: vec3<f32>) -> bool {
    return all(triple(chunk) <= high) && all(low <= triple(chunk + 3u));
}

// By how much a stroke's frame stretches the canvas's at most.
fn stretch(s: u32) -> f32 {
    if program[s + 5u] == 0u {
        return 1.0;
    }
    return sqrt(dot(triple(s + 6u), triple(s + 6u)) + dot(triple(s + 9u), triple(s + 9u))
        + dot(triple(s + 12u), triple(s + 12u)));
}

// `centre`, `size` and `radius` in the canvas's frame; `cube` its middle and half side in the world.
fn painting_felt(
    l: u32, begin: u32, to: u32, centre: vec3<f32>, size: vec3<f32>, radius: f32, cube: vec4<f32>, around: f32
) -> Felt {
    let c = g.shapes + program[l + 1u];
    var f = nothing_felt();
    var depth = 0u;
    var current = NONE;
    var near = UNKNOWN;
    var far = UNKNOWN;
    var count = 0u;
    for (var i = begin; i <= to; i++) {
        var chunk = 0u;
        var index = NONE;
        if i < to {
            chunk = c + program[c + 8u] + 9u * (tape[i] & 0x1fffffffu);
            if !touches(chunk, centre - size, centre + size) {
                continue;
            }
            count++;
            if count > MANY {
                f.known = false;
                return f;
            }
            index = program[chunk + 6u];
        }
        if index != current && current != NONE {
            let s = stroke_at(c, current);
            if program[s] == BEGIN {
                felts[min(depth, NESTED - 1u)] = f;
                depth++;
                f = nothing_felt();
            } else {
                let family = family_at(c, s);
                let blend = number(family + 5u);
                let weight = number(s + 1u);
                var low = 0.0;
                var high = 0.0;
                var scales = vec2(number(s + 3u));
                var steep = number(s + 4u);
                let p = in_stroke(s, centre);
                let slope = steep / weight * radius;
                let r = radius * stretch(s);
                switch program[s] {
                    case 0u: {
                        near = max(near, 0.0);
                        low = at_point(family, far * far);
                        high = at_point(family, near * near);
                    }
                    case 1u: {
                        let at = line_axis(s, p);
                        let long = number(s + 24u) * number(s + 25u);
                        let here = at_line(family, at.x, at.y, at.y + long);
                        let t = at.y + clamp(-at.y, 0.0, long);
                        let d = sqrt(at.x + t * t) - r * number(s + 25u);
                        low = here - slope;
                        high = min(here + slope, at_axis(family, max(d, 0.0)));
                    }
                    case 2u: {
                        let here = at_polygon(c, s, p);
                        let h = abs(in_plane(s, p).z) - r * number(s + 30u);
                        low = here - slope;
                        high = min(here + slope, at_plane(family, max(h, 0.0)));
                    }
                    case 3u: {
                        let wide = number(s + 18u);
                        let phi = solid_bounds(c, s, cube, around);
                        low = half_space(phi.y / wide);
                        high = half_space(phi.x / wide);
                        // 0 where it is wholly outside or inside of where it falls off.
                        steep *= weight * (35.0 / 32.0) / wide * min(phi.z, UNKNOWN);
                        steep = select(min(steep, UNKNOWN), 0.0, phi.x >= wide || phi.y <= -wide);
                    }
                    default: {
                        let own = f;
                        depth--;
                        f = felts[min(depth, NESTED - 1u)];
                        low = own.low - 1.0e-4 * abs(own.low);
                        high = own.high + 1.0e-4 * abs(own.high);
                        steep = min(weight * own.slope, UNKNOWN);
                        if own.widest > 0.0 {
                            scales *= vec2(own.finest, own.widest);
                        }
                    }
                }
                // Rounding, here and in the closed forms.
                low = max(weight * max(low - 4.0e-5, 0.0), f.twins.x);
                high = max(weight * max(high + 4.0e-5, 0.0), f.twins.y);
                f.twins = vec2(0.0);
                f.slope += steep;
                if !erases(s) {
                    f.finest = min(f.finest, scales.x);
                    f.widest = max(f.widest, scales.y);
                }
                if are_twins(c, s, index) {
                    f.twins = vec2(low, high);
                } else if erases(s) {
                    let least = erased(f.low, high);
                    f.high = erased(f.high, low);
                    f.low = least;
                } else {
                    f.low = blended(f.low, low, blend);
                    f.high = blended(f.high, high, blend);
                }
            }
            near = UNKNOWN;
            far = UNKNOWN;
        }
        current = index;
        if i == to {
            break;
        }
        let s = stroke_at(c, index);
        if program[s] == POINTS {
            let p = in_stroke(s, centre);
            let r = radius * stretch(s);
            let segments = c + program[c + 9u];
            for (var k = program[chunk + 7u]; k < program[chunk + 8u]; k++) {
                let j = segments + 8u * k;
                let u = sqrt(at_segment(j, p));
                let wide = r / min(number(j + 6u), number(j + 6u) + number(j + 7u));
                near = min(near, u - wide);
                far = min(far, min(u + wide, 1.0e15));
            }
        }
    }
    f.low -= 1.0e-4 * abs(f.low);
    f.high += 1.0e-4 * abs(f.high);
    return f;
}

// The same about the cube of half side `half` about `centre` and `around` it.
fn felt_about(leaf: u32, begin: u32, to: u32, centre: vec3<f32>, half: f32, around: f32) -> Felt {
    let l = LEAF * leaf;
    let size = triple(l + 16u) * half + triple(l + 19u) * around;
    let radius = half * number(l + 3u) + around / number(l + 2u);
    return painting_felt(l, begin, to, to_local(l, centre), size, radius, vec4(centre, half), around);
}

// Bounds of φ of a painting no further than `around` from the cube of half side `half` about `centre`.
fn painting_bounds(leaf: u32, begin: u32, to: u32, centre: vec3<f32>, half: f32, around: f32) -> vec2<f32> {
    let l = LEAF * leaf;
    let scale = number(l + 2u);
    let f = felt_about(leaf, begin, to, centre, half, around);
    if !f.known {
        return vec2(-UNKNOWN, UNKNOWN);
    }
    let c = g.shapes + program[l + 1u];
    let none = min(number(c + 6u) * THRESHOLD, (FAR + 1.0) * g.step / scale);
    if f.widest <= 0.0 || f.high <= 0.0 {
        return vec2(scale * none, UNKNOWN);
    }
    let d = THRESHOLD - f.high;
    let low = min(d * f.finest, d * f.widest);
    if f.low > 0.0 {
        let e = THRESHOLD - f.low;
        return scale * vec2(low, max(e * f.finest, e * f.widest));
    }
    return vec2(scale * min(low, none), UNKNOWN);
}

// The greatest |∇φ| of a painting there; HUGE where it is not known.
fn painting_slope(leaf: u32, begin: u32, to: u32, centre: vec3<f32>, half: f32, around: f32) -> f32 {
    let f = felt_about(leaf, begin, to, centre, half, around);
    return select(HUGE, max(f.slope * f.widest, 1.0), f.known);
}

// Hands the chunks down that can be felt about a cube; how many words were written.
fn hand_down(leaf: u32, begin: u32, to: u32, centre: vec3<f32>, half: f32, around: f32, out: u32) -> u32 {
    let l = LEAF * leaf;
    let p = to_local(l, centre);
    let size = triple(l + 16u) * half + triple(l + 19u) * around + FAR * g.step / number(l + 2u);
    let chunks = g.shapes + program[l + 1u] + program[g.shapes + program[l + 1u] + 8u];
    var n = 0u;
    for (var i = begin; i < to; i++) {
        if touches(chunks + 9u * (tape[i] & 0x1fffffffu), p - size, p + size) {
            tape[out + n] = tape[i];
            n++;
        }
    }
    return n;
}
