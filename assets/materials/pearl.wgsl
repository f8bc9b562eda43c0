//! name: Pearl
//! about: Shimmers in other colours where it turns away
//! colour: #e6ddd2
//! roughness: 0.22
//! metallic: 0.2
//! dial shimmer: 0 to 1, usually 0.6, Shimmer
//! dial grain: 0 to 1, usually 0.25, Grain
//! dial size: 0.002 to 0.2, usually 0.02, Size of the grain (m)

fn surface(at: Point, plain: Surface) -> Surface {
    var made = plain;
    let facing = clamp(dot(at.normal, at.eye), 0.0, 1.0);
    let p = at.position / dial.size;
    let grain = noise(p) - 0.5;
    // Thin layers: the colour follows how far light goes through them.
    let layer = hue(1.1 * (1.0 - facing) + 0.35 * noise(0.25 * p) + 0.52);
    let rim = smoothstep(0.0, 0.9, 1.0 - facing);
    made.colour = mix(plain.colour, plain.colour * (0.35 + layer), dial.shimmer * (0.25 + 0.6 * rim));
    made.glow = plain.glow + 0.1 * dial.shimmer * rim * layer;
    made.roughness = clamp(0.2 + 0.3 * dial.grain * grain, 0.08, 1.0);
    made.metallic = 0.2;
    made.bend = 0.12 * dial.grain * vec3<f32>(
        noise(p + vec3<f32>(0.5, 0.0, 0.0)) - noise(p - vec3<f32>(0.5, 0.0, 0.0)),
        noise(p + vec3<f32>(0.0, 0.5, 0.0)) - noise(p - vec3<f32>(0.0, 0.5, 0.0)),
        noise(p + vec3<f32>(0.0, 0.0, 0.5)) - noise(p - vec3<f32>(0.0, 0.0, 0.5)),
    );
    return made;
}
