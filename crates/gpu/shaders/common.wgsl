// What all passes share: uniforms, buffers, the page table. Rust mirrors: src/layout.rs.

struct Globals {
    // Metres between nodes.
    step: f32,
    // By how much bounds may be off by rounding, metres.
    slack: f32,
    // A zero of the field this near to a brick's nodes makes it hold values, metres.
    around: f32,
    // Smaller magnitudes become this much outside, metres.
    eps: f32,
    // First and last brick that may be made.
    low: vec3<i32>,
    // Where shapes begin in `program`.
    shapes: u32,
    high: vec3<i32>,
    // The coarsest level that inside blocks are kept at.
    top: u32,
    // The bricks whose mesh is made again, both included.
    mesh_low: vec3<i32>,
    update: u32,
    mesh_high: vec3<i32>,
    // Room for so many bricks.
    slots: u32,
    hash_mask: u32,
    // Where records of chunks and their tables begin in `pages`, and how many there may be.
    info_base: u32,
    table_base: u32,
    chunks: u32,
    tables: u32,
    blocks: u32,
    tape: u32,
    vertices: u32,
    triangles: u32,
    spare0: u32,
    spare1: u32,
    spare2: u32,
}

// One step of a descent or of a list.
struct Stage {
    level: u32,
    // 8: each block of the level above has eight children; 1: blocks are looked at as they are.
    split: u32,
    // Where the list read and the list written begin in `blocks`.
    from_block: u32,
    to_block: u32,
    // Counters of the two.
    count_in: u32,
    count_out: u32,
    // For `args`: threads to a group, the most entries, and which indirect dispatch is written.
    group: u32,
    most: u32,
    target_args: u32,
    spare0: u32,
    spare1: u32,
    spare2: u32,
}

struct Block {
    x: i32,
    y: i32,
    z: i32,
    // Its operands: a stretch of `tape`.
    off: u32,
    len: u32,
    // The table of its chunk, for blocks within one.
    table: u32,
}

@group(0) @binding(0) var<uniform> g: Globals;
@group(0) @binding(1) var<uniform> stage: Stage;
// Leaves, then what shapes are made of.
@group(0) @binding(2) var<storage, read> program: array<u32>;
// Baked meshes.
@group(0) @binding(3) var<storage, read> volumes: array<u32>;
@group(0) @binding(4) var<storage, read_write> tape: array<u32>;
@group(0) @binding(5) var<storage, read_write> blocks: array<Block>;
@group(0) @binding(6) var<storage, read_write> counters: array<atomic<u32>>;
// Hash of chunks and inside blocks, their records, and tables of 8³ entries.
@group(0) @binding(7) var<storage, read_write> pages: array<atomic<u32>>;
// The pool: values of 8³ nodes for each slot.
@group(0) @binding(8) var<storage, read_write> values: array<u32>;
// What is known of each slot.
@group(0) @binding(9) var<storage, read_write> bricks: array<u32>;
@group(0) @binding(10) var<storage, read_write> work: array<u32>;
@group(0) @binding(11) var<storage, read_write> vertices: array<u32>;
@group(0) @binding(12) var<storage, read_write> indices: array<u32>;
@group(0) @binding(13) var<storage, read_write> indirect: array<u32>;
// Triangles of the 256 cases: four bits to an edge, fifteen edges, then how many triangles.
@group(0) @binding(14) var<uniform> cases: array<vec4<u32>, 256>;

// Values are kept as 16-bit multiples of 1e-4 steps; else as f32.
override QUANTISED: bool = false;
// There are paintings among the leaves.
override PAINTED: bool = false;

const NONE: u32 = 0xffffffffu;
const OUTSIDE: u32 = 0u;
const INSIDE: u32 = 1u;
// Entries from here on are slots.
const NEAR: u32 = 2u;

const SLOTS: u32 = 0u;
const FREE: u32 = 1u;
const CHUNKS: u32 = 2u;
const TABLES: u32 = 3u;
const TAPE: u32 = 4u;
const WORK: u32 = 5u;
const VERTICES: u32 = 6u;
const TRIANGLES: u32 = 7u;
const OVERFLOW: u32 = 8u;
const ALL_VERTICES: u32 = 9u;
const ALL_TRIANGLES: u32 = 10u;
const VERTEX_HEADS: u32 = 48u;
const TRIANGLE_HEADS: u32 = 56u;

// What ran out, as bits of counters[OVERFLOW].
const NO_SLOTS: u32 = 1u;
const NO_CHUNKS: u32 = 2u;
const NO_BLOCKS: u32 = 4u;
const NO_TAPE: u32 = 8u;
const NO_VERTICES: u32 = 16u;
const NO_TRIANGLES: u32 = 32u;

// A brick's record.
const STRIDE: u32 = 104u;
const FREE_SLOT: u32 = 3u;
const VERTEX_BASE: u32 = 4u;
const VERTEX_COUNT: u32 = 5u;
const TRIANGLE_BASE: u32 = 6u;
const TRIANGLE_COUNT: u32 = 7u;
const ALIVE: u32 = 8u;
// The table of its chunk.
const TABLE: u32 = 9u;
const SIGNS: u32 = 16u;
const CROSSED: u32 = 32u;
const BEFORE: u32 = 80u;

// Groups along x of an indirect dispatch.
const ROW: u32 = 32768u;

fn failed(what: u32) {
    atomicOr(&counters[OVERFLOW], what);
}

fn hash(c: vec3<i32>, level: u32) -> u32 {
    let u = bitcast<vec3<u32>>(c);
    var h = u.x * 73856093u ^ u.y * 19349663u ^ u.z * 83492791u ^ level * 2654435761u;
    h ^= h >> 15u;
    h *= 0x2c1b3c6du;
    h ^= h >> 12u;
    h *= 0x297a2d39u;
    return h ^ (h >> 15u);
}

fn is_record(r: u32, c: vec3<i32>, level: u32) -> bool {
    let i = g.info_base + 5u * r;
    let u = bitcast<vec3<u32>>(c);
    return atomicLoad(&pages[i]) == u.x && atomicLoad(&pages[i + 1u]) == u.y
        && atomicLoad(&pages[i + 2u]) == u.z && atomicLoad(&pages[i + 3u]) == level;
}

// The record of a block at a level, or NONE.
fn find(c: vec3<i32>, level: u32) -> u32 {
    var i = hash(c, level) & g.hash_mask;
    for (var n = 0u; n <= g.hash_mask; n++) {
        let e = atomicLoad(&pages[i]);
        if e == 0u {
            return NONE;
        }
        if is_record(e - 1u, c, level) {
            return e - 1u;
        }
        i = (i + 1u) & g.hash_mask;
    }
    return NONE;
}

fn table_of(record: u32) -> u32 {
    return atomicLoad(&pages[g.info_base + 5u * record + 4u]);
}

// The place of a brick in its chunk's table, and of a node in its brick.
fn within(c: vec3<i32>) -> u32 {
    let l = vec3<u32>(c & vec3(7));
    return l.x | (l.y << 3u) | (l.z << 6u);
}

fn entry_at(table: u32, c: vec3<i32>) -> u32 {
    return g.table_base + 512u * table + within(c);
}

// What the page table says of a brick: OUTSIDE, INSIDE, or NEAR plus its slot.
fn brick_entry(c: vec3<i32>) -> u32 {
    let chunk = c >> vec3(3u);
    for (var level = 3u; level <= g.top; level++) {
        let r = find(chunk >> vec3(level - 3u), level);
        if r != NONE {
            let table = table_of(r);
            if table == NONE {
                return INSIDE;
            }
            return atomicLoad(&pages[entry_at(table, c)]);
        }
    }
    return OUTSIDE;
}

// The same of a brick beside one whose chunk has this table: most lie in the same chunk, which is then not looked for.
fn entry_beside(table: u32, c: vec3<i32>, beside: vec3<i32>) -> u32 {
    if all((c >> vec3(3u)) == (beside >> vec3(3u))) {
        return atomicLoad(&pages[entry_at(table, beside)]);
    }
    return brick_entry(beside);
}

// Appends a record; `link` makes it findable.
fn add_record(c: vec3<i32>, level: u32, table: u32) {
    let r = atomicAdd(&counters[CHUNKS], 1u);
    if r >= g.chunks {
        failed(NO_CHUNKS);
        return;
    }
    let i = g.info_base + 5u * r;
    let u = bitcast<vec3<u32>>(c);
    atomicStore(&pages[i], u.x);
    atomicStore(&pages[i + 1u], u.y);
    atomicStore(&pages[i + 2u], u.z);
    atomicStore(&pages[i + 3u], level);
    atomicStore(&pages[i + 4u], table);
}

fn new_table() -> u32 {
    let t = atomicAdd(&counters[TABLES], 1u);
    if t >= g.tables {
        failed(NO_CHUNKS);
        return NONE;
    }
    return t;
}

fn value(slot: u32, node: u32) -> f32 {
    if QUANTISED {
        let word = values[slot * 256u + (node >> 1u)];
        let q = bitcast<i32>(word << (16u - 16u * (node & 1u))) >> 16u;
        return f32(q) * g.eps;
    }
    return bitcast<f32>(values[slot * 512u + node]);
}

// Lengths of ranges in the mesh buffers go by powers of two: 32 to 2048 vertices, 64 to 4096 triangles.
fn class_of(count: u32, smallest: u32) -> u32 {
    var k = 0u;
    while (smallest << k) < count {
        k++;
    }
    return k;
}

fn block_at(b: Block) -> vec3<i32> {
    return vec3(b.x, b.y, b.z);
}

fn flat_group(id: vec3<u32>) -> u32 {
    return id.x + ROW * id.y;
}
