//! name: Plush
//! about: Soft pile, light at the edges, as a toy is covered with
//! colour: #c98a5e
//! roughness: 1
//! metallic: 0
//! dial pile: 0 to 1, usually 0.6, Pile
//! dial size: 0.001 to 0.05, usually 0.006, Size of the tufts (m)
//! dial sheen: 0 to 1, usually 0.5, Light at the edges

fn surface(at: Point, plain: Surface) -> Surface {
    var made = plain;
    let p = at.position / dial.size;
    // Tufts lie every way: fine ones on coarse ones.
    let tuft = 0.65 * noise(p) + 0.35 * noise(2.7 * p);
    let lie = vec3<f32>(noise(p + vec3<f32>(7.3, 0.0, 0.0)), noise(p + vec3<f32>(0.0, 5.1, 0.0)), noise(p + vec3<f32>(0.0, 0.0, 3.7))) - 0.5;
    made.bend = 0.9 * dial.pile * lie;
    made.colour = plain.colour * mix(1.0, 0.45 + 0.8 * tuft, dial.pile);
    let edge = pow(1.0 - clamp(dot(at.normal, at.eye), 0.0, 1.0), 2.0);
    made.glow = plain.glow + 0.35 * dial.sheen * edge * mix(plain.colour, vec3<f32>(1.0), 0.3);
    made.roughness = 1.0;
    made.metallic = 0.0;
    return made;
}
