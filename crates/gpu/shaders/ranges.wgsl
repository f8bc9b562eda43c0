// Stretches of the mesh buffers: given back to and taken from lists by length. A pass either gives
// back or takes, never both, so that no list is seen half changed.

fn give_back(slot: u32) {
    let r = STRIDE * slot;
    let v = bricks[r + VERTEX_COUNT];
    if v > 0u {
        let base = bricks[r + VERTEX_BASE];
        let head = VERTEX_HEADS + class_of(v, 32u);
        vertices[6u * base] = atomicExchange(&counters[head], base + 1u);
        atomicSub(&counters[ALL_VERTICES], v);
    }
    let t = bricks[r + TRIANGLE_COUNT];
    if t > 0u {
        let base = bricks[r + TRIANGLE_BASE];
        let head = TRIANGLE_HEADS + class_of(t, 64u);
        indices[3u * base] = atomicExchange(&counters[head], base + 1u);
        atomicSub(&counters[ALL_TRIANGLES], t);
    }
    bricks[r + VERTEX_COUNT] = 0u;
    bricks[r + TRIANGLE_COUNT] = 0u;
}

fn take_vertices(count: u32) -> u32 {
    let size_class = class_of(count, 32u);
    for (var n = 0u; n < 100000u; n++) {
        let head = atomicLoad(&counters[VERTEX_HEADS + size_class]);
        if head == 0u {
            break;
        }
        let next = vertices[6u * (head - 1u)];
        if atomicCompareExchangeWeak(&counters[VERTEX_HEADS + size_class], head, next).exchanged {
            return head - 1u;
        }
    }
    let size = 32u << size_class;
    let base = atomicAdd(&counters[VERTICES], size);
    if base + size > g.vertices {
        failed(NO_VERTICES);
        return NONE;
    }
    return base;
}

fn take_triangles(count: u32) -> u32 {
    let size_class = class_of(count, 64u);
    for (var n = 0u; n < 100000u; n++) {
        let head = atomicLoad(&counters[TRIANGLE_HEADS + size_class]);
        if head == 0u {
            break;
        }
        let next = indices[3u * (head - 1u)];
        if atomicCompareExchangeWeak(&counters[TRIANGLE_HEADS + size_class], head, next).exchanged {
            return head - 1u;
        }
    }
    let size = 64u << size_class;
    let base = atomicAdd(&counters[TRIANGLES], size);
    if base + size > g.triangles {
        failed(NO_TRIANGLES);
        return NONE;
    }
    return base;
}
