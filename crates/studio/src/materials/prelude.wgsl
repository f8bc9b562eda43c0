// What every material can use.

// A point of the surface, in the object's own frame.
struct Point {
    // Metres, as modelled.
    position: vec3<f32>,
    // Of length 1.
    normal: vec3<f32>,
    // Towards who looks, of length 1; nothing in shift.
    eye: vec3<f32>,
    // Seconds.
    time: f32,
}

// How a point looks.
struct Surface {
    // Linear red, green, blue.
    colour: vec3<f32>,
    // 1 for what nothing is seen through.
    opacity: f32,
    // 0 as a mirror, 1 as chalk.
    roughness: f32,
    // 0 or 1.
    metallic: f32,
    // Light of its own.
    glow: vec3<f32>,
    // Added to the normal, in the object's own frame.
    bend: vec3<f32>,
}

fn midair_hash(p: vec3<i32>) -> f32 {
    var h = bitcast<u32>(p.x) * 0x8da6b343u + bitcast<u32>(p.y) * 0xd8163841u + bitcast<u32>(p.z) * 0xcb1ab31fu;
    h = (h ^ (h >> 15u)) * 0x2c1b3c6du;
    h = (h ^ (h >> 12u)) * 0x297a2d39u;
    h = h ^ (h >> 15u);
    return f32(h >> 8u) / 16777216.0;
}

// Smooth noise from 0 to 1; its lumps are as large as 1.
fn noise(p: vec3<f32>) -> f32 {
    let cell = floor(p);
    let f = p - cell;
    let w = f * f * (3.0 - 2.0 * f);
    let i = vec3<i32>(cell);
    let x00 = mix(midair_hash(i), midair_hash(i + vec3<i32>(1, 0, 0)), w.x);
    let x10 = mix(midair_hash(i + vec3<i32>(0, 1, 0)), midair_hash(i + vec3<i32>(1, 1, 0)), w.x);
    let x01 = mix(midair_hash(i + vec3<i32>(0, 0, 1)), midair_hash(i + vec3<i32>(1, 0, 1)), w.x);
    let x11 = mix(midair_hash(i + vec3<i32>(0, 1, 1)), midair_hash(i + vec3<i32>(1, 1, 1)), w.x);
    return mix(mix(x00, x10, w.y), mix(x01, x11, w.y), w.z);
}

// A full colour from around the circle: 0 and 1 are red.
fn hue(h: f32) -> vec3<f32> {
    return clamp(abs(fract(vec3<f32>(h) + vec3<f32>(0.0, 2.0 / 3.0, 1.0 / 3.0)) * 6.0 - 3.0) - 1.0, vec3<f32>(0.0), vec3<f32>(1.0));
}

// A colour turned around the circle: 1 is once around.
fn turned(colour: vec3<f32>, by: f32) -> vec3<f32> {
    let axis = vec3<f32>(0.57735027);
    let angle = 6.2831853 * by;
    let c = cos(angle);
    let around = colour * c + cross(axis, colour) * sin(angle) + axis * dot(axis, colour) * (1.0 - c);
    return max(around, vec3<f32>(0.0));
}
