// A painting: skeletons that melt into one convolution surface (3DBrushVR §4.1 Eq. 2–3), as
// crates/kernel/field/src/canvas has them. On a tape its chunks that are felt follow it, by stroke.

const PAINTING: u32 = 12u;
const INK: u32 = 5u;
const STROKE: u32 = 36u;
const THRESHOLD: f32 = 0.5;
// From this exponent on strokes are united as they are.
const HARD: f32 = 16.0;
// Steps within which the distance to what is felt nowhere is told apart.
const FAR: f32 = 3.0;
// Chunks in one block beyond which bounds are not worth their time.
const MANY: u32 = 200u;
// Up to this a potential of a polygon is rounding.
const NOTHING: f32 = 4.0e-6;
const UNKNOWN: f32 = 1.0e30;

fn is_painting(leaf: u32) -> bool {
    return PAINTED && program[LEAF * leaf] == PAINTING;
}

// Where the chunks of a painting end whose LOAD stands before `i`.
fn inks(i_first: u32, end: u32) -> u32 {
    var i = i_first;
    while i < end && (tape[i] >> 29u) == INK {
        i++;
    }
    return i;
}

// x^p for x ≥ 0, as the processor has it.
fn power(x: f32, p: f32) -> f32 {
    let shifted = bitcast<u32>(x) - 0x3f3504f3u;
    let exponent = f32(bitcast<i32>(shifted) >> 23u);
    let m = bitcast<f32>((shifted & 0x007fffffu) + 0x3f3504f3u);
    let s = (m - 1.0) / (m + 1.0);
    let s2 = s * s;
    let series = 1.0 + s2 * (1.0 / 3.0 + s2 * (0.2 + s2 * (1.0 / 7.0 + s2 / 9.0)));
    let y = clamp((exponent + s * series * 2.88539008) * p, -126.0, 126.0);
    let whole = round(y);
    let f = (y - whole) * 0.69314718;
    let e = 1.0 + f * (1.0 + f * (0.5 + f * (1.0 / 6.0 + f * (1.0 / 24.0 + f * (1.0 / 120.0 + f / 720.0)))));
    return select(0.0, e * bitcast<f32>(u32(i32(whole) + 127) << 23u), x > 1.0e-12);
}

// atan2 to 1e-7; 0 where both are 0.
fn turn(y: f32, x: f32) -> f32 {
    let low = min(abs(x), abs(y));
    let high = max(abs(x), abs(y));
    let t = low / max(high, 1.0e-30);
    let u = t * t;
    let near = 0.99999998 + u * (-0.33333037 + u * (0.19991872 + u * -0.14197798));
    let far = 0.10618371 + u * (-0.07456855 + u * (0.042137624 + u * (-0.01573125 + u * 0.0027662835)));
    var r = t * (near + u * u * u * u * far);
    r = select(r, 0.5 * PI - r, abs(x) < abs(y));
    r = select(r, PI - r, x < 0.0);
    return select(r, -r, y < 0.0);
}

// `c` is where a painting begins: reach, 1/reach², weights of a point, a line, a polygon.
fn at_point(c: u32, u2: f32) -> f32 {
    let a = max(1.0 - u2 * number(c + 1u), 0.0);
    return number(c + 2u) * a * a;
}

fn line_part(s: f32, a: f32) -> f32 {
    let s2 = s * s;
    return s * (a * a - s2 * (a * (2.0 / 3.0) - s2 * 0.2));
}

fn at_line(c: u32, d2: f32, s0: f32, s1: f32) -> f32 {
    let a = max(1.0 - d2, 0.0);
    let half = sqrt(a);
    let f = line_part(clamp(s1, -half, half), a) - line_part(clamp(s0, -half, half), a);
    return max(number(c + 3u) * f, 0.0);
}

fn at_axis(c: u32, d: f32) -> f32 {
    let a = max(1.0 - d * d, 0.0);
    return number(c + 3u) * (16.0 / 15.0) * a * a * a * sqrt(a);
}

fn at_plane(c: u32, h: f32) -> f32 {
    let a = max(1.0 - h * h, 0.0);
    return number(c + 4u) * (PI / 3.0) * a * a * a;
}

// The squared distance from a line's axis and where its start lies along it, in supports.
fn line_axis(s: u32, p: vec3<f32>) -> vec2<f32> {
    let q = (triple(s + 18u) - p) * number(s + 25u);
    let along = triple(s + 21u);
    let t = dot(q, along);
    let e = q - t * along;
    return vec2(dot(e, e), t);
}

// A place in a polygon's plane and above it, in supports.
fn in_plane(s: u32, p: vec3<f32>) -> vec3<f32> {
    let q = (p - triple(s + 18u)) * number(s + 30u);
    return vec3(dot(q, triple(s + 21u)), dot(q, triple(s + 24u)), dot(q, triple(s + 27u)));
}

fn edge_part(s: f32, c0: f32, c2: f32) -> f32 {
    let s2 = s * s;
    return s * (c0 + s2 * (c2 + s2 * (1.0 / 30.0)));
}

fn at_polygon(c: u32, s: u32, p: vec3<f32>) -> f32 {
    let q = in_plane(s, p);
    let a = max(1.0 - q.z * q.z, 0.0);
    var sum = 0.0;
    var angle = 0.0;
    let edges = c + program[s + 34u];
    for (var k = 0u; k < program[s + 33u]; k++) {
        let i = edges + 5u * k;
        let begin = vec2(number(i), number(i + 1u)) - q.xy;
        let along = vec2(number(i + 2u), number(i + 3u));
        let long = number(i + 4u);
        let e = begin.x * along.y - begin.y * along.x;
        let s0 = dot(begin, along);
        let s1 = s0 + long;
        let e2 = e * e;
        let half = sqrt(max(a - e2, 0.0));
        let low = clamp(s0, -half, half);
        let high = clamp(s1, -half, half);
        angle += turn(e * long, e2 + s0 * s1) - turn(e * (high - low), e2 + high * low);
        let c0 = a * a * 0.5 - a * e2 * 0.5 + e2 * e2 * (1.0 / 6.0);
        let c2 = (e2 * (1.0 / 3.0) - a * 0.5) * (1.0 / 3.0);
        sum += e * (edge_part(high, c0, c2) - edge_part(low, c0, c2));
    }
    // What rounding leaves of the angles where no part is felt is nothing.
    return max(number(c + 4u) * (sum + a * a * a * (1.0 / 6.0) * angle) - NOTHING, 0.0);
}

// The squared distance to a segment in its own radii.
fn at_segment(i: u32, p: vec3<f32>) -> f32 {
    let b = triple(i + 3u);
    let r = number(i + 6u);
    let w = number(i + 7u);
    let q = p - triple(i);
    let qb = dot(q, b);
    let up = w * dot(q, q) + r * qb;
    let down = dot(b, b) * r + w * qb;
    var t = select(0.0, 1.0, up > 0.0);
    if down > 1.0e-12 {
        t = clamp(up / down, 0.0, 1.0);
    }
    let d = q - t * b;
    let wide = r + t * w;
    return dot(d, d) / (wide * wide);
}

fn blended(a: f32, b: f32, p: f32) -> f32 {
    if p >= HARD {
        return max(a, b);
    }
    if p == 1.0 {
        return a + b;
    }
    return power(power(a, p) + power(b, p), 1.0 / p);
}

fn erased(f: f32, e: f32) -> f32 {
    let x = clamp((f - THRESHOLD) / THRESHOLD, 0.0, 1.0);
    let held = min(f, THRESHOLD) + THRESHOLD * x * (1.0 + x - x * x);
    let ramp = clamp(4.0 * e, 0.0, 1.0);
    return max(f - e - (f - held) * (ramp * ramp * (3.0 - 2.0 * ramp)), 0.0);
}

fn in_stroke(s: u32, p: vec3<f32>) -> vec3<f32> {
    if program[s + 5u] == 0u {
        return p;
    }
    return triple(s + 6u) * p.x + (triple(s + 9u) * p.y + (triple(s + 12u) * p.z + triple(s + 15u)));
}

fn erases(s: u32) -> bool {
    return number(s + 2u) > 0.5;
}

// φ of a painting at a place of its canvas, from its chunks on `tape[from..to]`.
fn painting_at(l: u32, begin: u32, to: u32, p: vec3<f32>) -> f32 {
    let c = g.shapes + program[l + 1u];
    let blend = number(c + 5u);
    let widest = number(c) * number(c);
    var total = 0.0;
    var felt = 0.0;
    var fine = 0.0;
    // `total` is its own p-th power while strokes are painted.
    var raised = false;
    var least = (FAR + 1.0) * g.step / number(l + 2u);
    var current = NONE;
    var one = 0.0;
    var u2 = widest;
    for (var i = begin; i <= to; i++) {
        var chunk = 0u;
        var index = NONE;
        if i < to {
            chunk = c + program[c + 8u] + 9u * (tape[i] & 0x1fffffffu);
            index = program[chunk + 6u];
        }
        if index != current && current != NONE {
            let s = c + program[c + 7u] + STROKE * current;
            if program[s] == 0u {
                one = at_point(c, u2);
            }
            one *= number(s + 1u);
            if one > 0.0 && erases(s) {
                if raised {
                    total = power(total, 1.0 / blend);
                    raised = false;
                }
                total = erased(total, one);
            } else if one > 0.0 {
                felt += one;
                fine += one / number(s + 3u);
                if blend >= HARD {
                    total = max(total, one);
                } else if blend == 1.0 {
                    total += one;
                } else {
                    if !raised {
                        total = power(total, blend);
                        raised = true;
                    }
                    total += power(one, blend);
                }
            }
            one = 0.0;
            u2 = widest;
        }
        current = index;
        if i == to {
            break;
        }
        let s = c + program[c + 7u] + STROKE * index;
        let gap = max(max(triple(chunk) - p, p - triple(chunk + 3u)), vec3(0.0));
        if all(gap == vec3(0.0)) {
            let q = in_stroke(s, p);
            switch program[s] {
                case 0u: {
                    let segments = c + program[c + 9u];
                    for (var k = program[chunk + 7u]; k < program[chunk + 8u]; k++) {
                        u2 = min(u2, at_segment(segments + 8u * k, q));
                    }
                }
                case 1u: {
                    let at = line_axis(s, q);
                    one = at_line(c, at.x, at.y, at.y + number(s + 24u) * number(s + 25u));
                }
                default: { one = at_polygon(c, s, q); }
            }
        }
        if !erases(s) {
            least = min(least, max(length(gap), THRESHOLD * number(s + 3u)));
        }
    }
    if fine <= 0.0 {
        return least;
    }
    if raised {
        total = power(total, 1.0 / blend);
    }
    return (THRESHOLD - total) * felt / fine;
}

// Bounds of F in a block, of the scales of what was painted there, and of |∇F|.
struct Felt {
    low: f32,
    high: f32,
    finest: f32,
    widest: f32,
    slope: f32,
    known: bool,
}

fn touches(chunk: u32, low: vec3<f32>, high: vec3<f32>) -> bool {
    return all(triple(chunk) <= high) && all(low <= triple(chunk + 3u));
}

fn painting_felt(l: u32, begin: u32, to: u32, centre: vec3<f32>, size: vec3<f32>, radius: f32) -> Felt {
    let c = g.shapes + program[l + 1u];
    let blend = number(c + 5u);
    var f: Felt;
    f.finest = UNKNOWN;
    f.known = true;
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
            let s = c + program[c + 7u] + STROKE * current;
            let weight = number(s + 1u);
            var low = 0.0;
            var high = 0.0;
            let p = in_stroke(s, centre);
            let slope = number(s + 4u) / weight * radius;
            var r = radius;
            if program[s + 5u] == 1u {
                let m = dot(triple(s + 6u), triple(s + 6u)) + dot(triple(s + 9u), triple(s + 9u))
                    + dot(triple(s + 12u), triple(s + 12u));
                r *= sqrt(m);
            }
            switch program[s] {
                case 0u: {
                    near = max(near, 0.0);
                    low = at_point(c, far * far);
                    high = at_point(c, near * near);
                }
                case 1u: {
                    let at = line_axis(s, p);
                    let long = number(s + 24u) * number(s + 25u);
                    let here = at_line(c, at.x, at.y, at.y + long);
                    let t = at.y + clamp(-at.y, 0.0, long);
                    let d = sqrt(at.x + t * t) - r * number(s + 25u);
                    low = here - slope;
                    high = min(here + slope, at_axis(c, max(d, 0.0)));
                }
                default: {
                    let here = at_polygon(c, s, p);
                    let h = abs(in_plane(s, p).z) - r * number(s + 30u);
                    low = here - slope;
                    high = min(here + slope, at_plane(c, max(h, 0.0)));
                }
            }
            // Rounding, here and in the closed forms.
            low = weight * max(low - 4.0e-5, 0.0);
            high = weight * max(high + 4.0e-5, 0.0);
            f.slope += number(s + 4u);
            if erases(s) {
                let least = erased(f.low, high);
                f.high = erased(f.high, low);
                f.low = least;
            } else {
                f.low = blended(f.low, low, blend);
                f.high = blended(f.high, high, blend);
                f.finest = min(f.finest, number(s + 3u));
                f.widest = max(f.widest, number(s + 3u));
            }
            near = UNKNOWN;
            far = UNKNOWN;
        }
        current = index;
        if i == to {
            break;
        }
        let s = c + program[c + 7u] + STROKE * index;
        if program[s] == 0u {
            let p = in_stroke(s, centre);
            var r = radius;
            if program[s + 5u] == 1u {
                let m = dot(triple(s + 6u), triple(s + 6u)) + dot(triple(s + 9u), triple(s + 9u))
                    + dot(triple(s + 12u), triple(s + 12u));
                r *= sqrt(m);
            }
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

// Bounds of φ of a painting no further than `around` from the cube of half side `half` about `centre`.
fn painting_bounds(leaf: u32, begin: u32, to: u32, centre: vec3<f32>, half: f32, around: f32) -> vec2<f32> {
    let l = LEAF * leaf;
    let scale = number(l + 2u);
    let size = triple(l + 16u) * half + triple(l + 19u) * around;
    let f = painting_felt(l, begin, to, to_local(l, centre), size, half * number(l + 3u) + around / scale);
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
    let l = LEAF * leaf;
    let size = triple(l + 16u) * half + triple(l + 19u) * around;
    let r = half * number(l + 3u) + around / number(l + 2u);
    let f = painting_felt(l, begin, to, to_local(l, centre), size, r);
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
