// From large blocks down to bricks: which are near the surface, and which operands matter there
// (EasyVRModeling §5.4).

// One block: settled inside or outside, or appended with its own operands.
@compute @workgroup_size(64)
fn cull(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lid: u32) {
    let i = 64u * flat_group(group) + lid;
    let count = min(atomicLoad(&counters[stage.count_in]), g.blocks);
    if i >= count * stage.split {
        return;
    }
    let parent = blocks[stage.from_block + i / stage.split];
    var c = block_at(parent);
    if stage.split == 8u {
        c = c * 2 + vec3<i32>(vec3(i & 1u, (i >> 1u) & 1u, (i >> 2u) & 1u));
    }
    let level = stage.level;
    let low = c << vec3(level);
    let high = ((c + 1) << vec3(level)) - 1;
    if any(low > g.high) || any(high < g.low) {
        return;
    }
    let nodes = f32(8u << level);
    let centre = (vec3<f32>(c) * nodes + vec3(0.5 * (nodes - 1.0))) * g.step;
    let half = 0.5 * (nodes - 1.0) * g.step;
    let slack = g.slack * (1.0 + 0.25 * f32(level));
    // One word more: leaving out what stood before an operand may ask for a negation.
    let out = atomicAdd(&counters[TAPE], parent.len + 1u);
    if out + parent.len + 1u > g.tape {
        failed(NO_TAPE);
        return;
    }
    let range = prune(parent.off, parent.len, centre, half, slack, out);
    if range.low > 0.0 {
        return;
    }
    var table = parent.table;
    if range.high < 0.0 {
        inside(c, level, table);
        return;
    }
    if level == 3u && g.update == 0u {
        table = new_table();
        if table == NONE {
            return;
        }
        add_record(c, 3u, table);
    }
    let at = atomicAdd(&counters[stage.count_out], 1u);
    if at >= g.blocks {
        failed(NO_BLOCKS);
        return;
    }
    blocks[stage.to_block + at] = Block(c.x, c.y, c.z, out, range.len, table);
}

fn inside(c: vec3<i32>, level: u32, table: u32) {
    if level >= 3u && g.update == 0u {
        add_record(c, level, NONE);
        return;
    }
    let side = 1i << level;
    for (var z = 0; z < side; z++) {
        for (var y = 0; y < side; y++) {
            for (var x = 0; x < side; x++) {
                let b = (c << vec3(level)) + vec3(x, y, z);
                if all(b >= g.low) && all(b <= g.high) {
                    atomicStore(&pages[entry_at(table, b)], INSIDE);
                }
            }
        }
    }
}

// Makes the records added since the last time findable.
@compute @workgroup_size(64)
fn link(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lid: u32) {
    let r = stage.from_block + 64u * flat_group(group) + lid;
    if r >= min(atomicLoad(&counters[CHUNKS]), g.chunks) {
        return;
    }
    let i = g.info_base + 5u * r;
    let c = bitcast<vec3<i32>>(vec3(atomicLoad(&pages[i]), atomicLoad(&pages[i + 1u]), atomicLoad(&pages[i + 2u])));
    var h = hash(c, atomicLoad(&pages[i + 3u])) & g.hash_mask;
    for (var n = 0u; n <= g.hash_mask; n++) {
        if atomicLoad(&pages[h]) == r + 1u {
            return;
        }
        let old = atomicCompareExchangeWeak(&pages[h], 0u, r + 1u);
        if old.exchanged {
            return;
        }
        // The exchange may fail although nothing is there: the same place is tried again.
        if old.old_value != 0u {
            h = (h + 1u) & g.hash_mask;
        }
    }
    failed(NO_CHUNKS);
}

// How many groups the next pass has; one thread.
@compute @workgroup_size(1)
fn args() {
    if bitcast<i32>(atomicLoad(&counters[FREE])) < 0 {
        atomicStore(&counters[FREE], 0u);
    }
    let count = min(atomicLoad(&counters[stage.count_in]), stage.most) * stage.split;
    let groups = (count + stage.group - 1u) / stage.group;
    let at = 3u * stage.target_args;
    indirect[at] = min(groups, ROW);
    indirect[at + 1u] = (groups + ROW - 1u) / ROW;
    indirect[at + 2u] = 1u;
}
