// Operands joined (EasyVRModeling §5.3 Eq. 7): a tape for a stack machine, as the processor's.

const LOAD: u32 = 0u;
const NEGATE: u32 = 1u;
const MIN: u32 = 2u;
const MAX: u32 = 3u;
const MAX_NEGATED: u32 = 4u;
const DEEPEST: u32 = 34u;

var<private> stack: array<f32, 34>;
var<private> bounds: array<vec2<f32>, 34>;
var<private> starts: array<u32, 34>;

fn joined(op: u32, a: f32, b: f32) -> f32 {
    switch op {
        case 2u: { return min(a, b); }
        case 3u: { return max(a, b); }
        default: { return max(a, -b); }
    }
}

// φ at a point from the operands of a stretch of tape.
fn evaluate(off: u32, len: u32, p: vec3<f32>) -> f32 {
    var depth = 0u;
    var top = HUGE;
    var i = off;
    let end = off + len;
    while i < end {
        let instr = tape[i];
        let op = instr >> 29u;
        i++;
        if op == LOAD {
            let leaf = instr & 0x1fffffffu;
            var v = 0.0;
            if is_painting(leaf) {
                let to = inks(i, end);
                v = number(LEAF * leaf + 2u) * painting_at(LEAF * leaf, i, to, to_local(LEAF * leaf, p), p);
                i = to;
            } else {
                v = leaf_at(leaf, p);
            }
            // Most operands are joined as soon as they are there: no need of the stack.
            if i < end && (tape[i] >> 29u) >= MIN {
                top = joined(tape[i] >> 29u, top, v);
                i++;
            } else {
                stack[min(depth, DEEPEST - 1u)] = top;
                depth++;
                top = v;
            }
        } else if op == NEGATE {
            top = -top;
        } else {
            depth--;
            top = joined(op, stack[min(depth, DEEPEST - 1u)], top);
        }
    }
    return top;
}

struct Pruned {
    len: u32,
    low: f32,
    high: f32,
}

// Bounds φ around a cube and writes the part of a tape that can matter there to `tape[out..]`.
fn prune(off: u32, len: u32, centre: vec3<f32>, half: f32, slack: f32, out: u32) -> Pruned {
    var depth = 0u;
    var n = 0u;
    for (var i = off; i < off + len; i++) {
        let instr = tape[i];
        let op = instr >> 29u;
        if op == LOAD {
            let leaf = instr & 0x1fffffffu;
            let d = min(depth, DEEPEST - 1u);
            starts[d] = n;
            depth++;
            tape[out + n] = instr;
            n++;
            if is_painting(leaf) {
                let to = inks(i + 1u, off + len);
                bounds[d] = painting_bounds(leaf, i + 1u, to, centre, half, g.around) + vec2(-slack, slack);
                n += hand_down(leaf, i + 1u, to, centre, half, g.around, out + n);
                i = to - 1u;
            } else {
                bounds[d] = leaf_bounds(leaf, centre, half, g.around) + vec2(-slack, slack);
            }
        } else if op == NEGATE {
            let d = depth - 1u;
            bounds[d] = -bounds[d].yx;
            tape[out + n] = instr;
            n++;
        } else {
            depth--;
            let at = starts[depth];
            let start = starts[depth - 1u];
            let a = bounds[depth - 1u];
            var b = bounds[depth];
            if op == MAX_NEGATED {
                b = -b.yx;
            }
            let united = op == MIN;
            let a_wins = select(a.x >= b.y, a.y <= b.x, united);
            let b_wins = select(b.x >= a.y, b.y <= a.x, united);
            if a_wins {
                n = at;
            } else if b_wins {
                for (var k = at; k < n; k++) {
                    tape[out + start + k - at] = tape[out + k];
                }
                n = start + n - at;
                if op == MAX_NEGATED {
                    tape[out + n] = NEGATE << 29u;
                    n++;
                }
                bounds[depth - 1u] = b;
            } else {
                tape[out + n] = instr;
                n++;
                bounds[depth - 1u] = select(max(a, b), min(a, b), united);
            }
        }
    }
    var done: Pruned;
    done.len = n;
    done.low = HUGE;
    done.high = HUGE;
    if depth > 0u {
        done.low = bounds[0].x;
        done.high = bounds[0].y;
    }
    return done;
}
