// Before an edit: bricks in its way are given back, their chunks get tables of their own.

var<workgroup> chunk_table: u32;
var<workgroup> chunk_fill: u32;

@compute @workgroup_size(256)
fn touch(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lid: u32) {
    let i = stage.from_block + flat_group(group);
    let chunk = block_at(blocks[i]);
    if lid == 0u {
        chunk_fill = NONE;
        let own = find(chunk, 3u);
        if own != NONE && table_of(own) != NONE {
            chunk_table = table_of(own);
        } else {
            chunk_fill = OUTSIDE;
            for (var level = 3u; level <= g.top; level++) {
                if find(chunk >> vec3(level - 3u), level) != NONE {
                    chunk_fill = INSIDE;
                }
            }
            chunk_table = new_table();
            if own != NONE {
                // It was inside as a whole.
                atomicStore(&pages[g.info_base + 5u * own + 4u], chunk_table);
            } else if chunk_table != NONE {
                add_record(chunk, 3u, chunk_table);
            }
        }
        blocks[i].table = chunk_table;
    }
    let table = workgroupUniformLoad(&chunk_table);
    let fill = workgroupUniformLoad(&chunk_fill);
    if table == NONE {
        return;
    }
    for (var k = lid; k < 512u; k += 256u) {
        let b = chunk * 8 + vec3<i32>(vec3(k & 7u, (k >> 3u) & 7u, k >> 6u));
        let at = entry_at(table, b);
        if fill != NONE {
            atomicStore(&pages[at], fill);
        }
        if all(b >= g.low) && all(b <= g.high) {
            let entry = atomicLoad(&pages[at]);
            if entry >= NEAR && fill == NONE {
                let slot = entry - NEAR;
                give_back(slot);
                bricks[STRIDE * slot + ALIVE] = 0u;
                let n = atomicAdd(&counters[FREE], 1u);
                bricks[STRIDE * n + FREE_SLOT] = slot;
            }
            atomicStore(&pages[at], OUTSIDE);
        }
    }
}

// After it: lists the bricks whose mesh is made again. One thread to a brick of the box.
@compute @workgroup_size(64)
fn gather(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lid: u32) {
    let i = 64u * flat_group(group) + lid;
    let size = vec3<u32>(g.mesh_high - g.mesh_low + 1);
    if i >= size.x * size.y * size.z {
        return;
    }
    let b = g.mesh_low + vec3<i32>(vec3(i % size.x, i / size.x % size.y, i / (size.x * size.y)));
    let entry = brick_entry(b);
    if entry < NEAR {
        return;
    }
    let slot = entry - NEAR;
    // Signs of its own cells may have changed: up to one brick before the edit.
    var entered = slot;
    if all(b >= g.low - 1) && all(b <= g.high) {
        entered |= 0x40000000u;
        give_back(slot);
    }
    work[atomicAdd(&counters[WORK], 1u)] = entered;
}
