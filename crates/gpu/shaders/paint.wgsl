// A painting: skeletons that melt into one convolution surface (3DBrushVR §4.1 Eq. 2–3), as
// crates/kernel/field/src/canvas has them. On a tape its chunks that are felt follow it, by stroke. A painting that is
// a stroke itself stands there with all of its own, between two that begin and end it.

const PAINTING: u32 = 12u;
const INK: u32 = 5u;
const STROKE: u32 = 40u;
// Kinds of strokes.
const POINTS: u32 = 0u;
const LINE: u32 = 1u;
const POLYGON: u32 = 2u;
const SOLID: u32 = 3u;
const BEGIN: u32 = 4u;
const END: u32 = 5u;
// Paintings within paintings.
const NESTED: u32 = 3u;
// Values on the stack of a brush's tape.
const INNER: u32 = 18u;
const THRESHOLD: f32 = 0.5;
// From this exponent on strokes are united as they are.
const HARD: f32 = 16.0;
// Steps within which the distance to what is felt nowhere is told apart.
const FAR: f32 = 3.0;
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

// `c` is where a family begins: reach, 1/reach², weights of a point, a line, a polygon; then the blend.
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
    return max(number(family_at(c, s) + 4u) * (sum + a * a * a * (1.0 / 6.0) * angle) - NOTHING, 0.0);
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

// The stroke of a number, of the painting that begins at `c`.
fn stroke_at(c: u32, index: u32) -> u32 {
    return c + program[c + 7u] + STROKE * index;
}

// Its family and blend; for one that ends a painting, of what that is a stroke of.
fn family_at(c: u32, s: u32) -> u32 {
    return c + program[s + 36u];
}

// Whether a stroke and the one after it are one.
fn are_twins(c: u32, s: u32, next: u32) -> bool {
    return next != NONE && program[s + 35u] != 0u && program[s + 35u] == program[stroke_at(c, next) + 35u];
}

// The kernel's integral over a half-space whose surface is `x` supports away.
fn half_space(far: f32) -> f32 {
    let x = clamp(far, -1.0, 1.0);
    let x2 = x * x;
    let f = 0.5 - 35.0 / 32.0 * x * (1.0 - x2 * (1.0 - x2 * (0.6 - x2 / 7.0)));
    return select(0.0, clamp(f, 0.0, 1.0), x < 1.0);
}

var<private> inner: array<f32, INNER>;

// φ of the solid that a stroke is made of, at a place of the world. Its tape lies with the painting: no solid has a
// painting in it here.
fn solid_at(c: u32, s: u32, world: vec3<f32>) -> f32 {
    let tape_at = c + program[s + 19u];
    var depth = 0u;
    var top = HUGE;
    for (var i = 0u; i < program[s + 20u]; i++) {
        let instr = program[tape_at + i];
        let op = instr >> 29u;
        if op == 0u {
            inner[min(depth, INNER - 1u)] = top;
            depth++;
            top = leaf_at(instr & 0x1fffffffu, world);
        } else if op == 1u {
            top = -top;
        } else {
            depth--;
            let a = inner[min(depth, INNER - 1u)];
            switch op {
                case 2u: { top = min(a, top); }
                case 3u: { top = max(a, top); }
                default: { top = max(a, -top); }
            }
        }
    }
    return top;
}

// What a painting comes to at a place, stroke by stroke.
struct Sum {
    // Its own p-th power while strokes are painted.
    total: f32,
    raised: bool,
    // Σ F of what was painted, and Σ F/scale.
    felt: f32,
    fine: f32,
    // The most that the twins before are felt.
    twins: f32,
}

var<private> sums: array<Sum, NESTED>;

fn lowered(now: Sum, blend: f32) -> Sum {
    var s = now;
    if s.raised {
        s.total = power(s.total, 1.0 / blend);
        s.raised = false;
    }
    return s;
}

// φ of a painting at a place of its canvas and of the world, from its chunks on `tape[from..to]`.
fn painting_at(l: u32, begin: u32, to: u32, p: vec3<f32>, world: vec3<f32>) -> f32 {
    let c = g.shapes + program[l + 1u];
    var now: Sum;
    var depth = 0u;
    var least = (FAR + 1.0) * g.step / number(l + 2u);
    var current = NONE;
    var one = 0.0;
    var u2 = UNKNOWN;
    for (var i = begin; i <= to; i++) {
        var chunk = 0u;
        var index = NONE;
        if i < to {
            chunk = c + program[c + 8u] + 9u * (tape[i] & 0x1fffffffu);
            index = program[chunk + 6u];
        }
        if index != current && current != NONE {
            let s = stroke_at(c, current);
            let kind = program[s];
            if kind == BEGIN {
                sums[min(depth, NESTED - 1u)] = now;
                depth++;
                now = Sum();
            } else {
                let family = family_at(c, s);
                let blend = number(family + 5u);
                var scale = 1.0 / number(s + 3u);
                if kind == POINTS {
                    one = at_point(family, u2);
                } else if kind == END {
                    let own = lowered(now, number(c + program[s + 38u] + 5u));
                    depth--;
                    now = sums[min(depth, NESTED - 1u)];
                    one = own.total;
                    scale *= select(0.0, own.fine / own.felt, own.felt > 0.0);
                }
                one *= number(s + 1u);
                if one > 0.0 && !erases(s) {
                    now.felt += one;
                    now.fine += one * scale;
                }
                one = max(one, now.twins);
                now.twins = 0.0;
                if are_twins(c, s, index) {
                    now.twins = one;
                } else if one > 0.0 && erases(s) {
                    now = lowered(now, blend);
                    now.total = erased(now.total, one);
                } else if one > 0.0 && blend >= HARD {
                    now.total = max(now.total, one);
                } else if one > 0.0 && blend == 1.0 {
                    now.total += one;
                } else if one > 0.0 {
                    if !now.raised {
                        now.total = power(now.total, blend);
                        now.raised = true;
                    }
                    now.total += power(one, blend);
                }
            }
            one = 0.0;
            u2 = UNKNOWN;
        }
        current = index;
        if i == to {
            break;
        }
        let s = stroke_at(c, index);
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
                    one = at_line(family_at(c, s), at.x, at.y, at.y + number(s + 24u) * number(s + 25u));
                }
                case 2u: { one = at_polygon(c, s, q); }
                case 3u: { one = half_space(solid_at(c, s, world) / number(s + 18u)); }
                default: {}
            }
        }
        if program[s + 37u] == 1u {
            least = min(least, max(length(gap), THRESHOLD * number(s + 3u)));
        }
    }
    if now.fine <= 0.0 {
        return least;
    }
    now = lowered(now, number(c + 5u));
    return (THRESHOLD - now.total) * now.felt / now.fine;
}
