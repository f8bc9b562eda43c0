//! name: Aurora
//! about: Bands of colour that drift over the form
//! colour: #3f8fd2
//! roughness: 0.38
//! metallic: 0
//! dial speed: 0 to 2, usually 0.25, Speed
//! dial size: 0.02 to 1, usually 0.1, Size of the bands (m)
//! dial spread: 0 to 1, usually 0.45, Spread of the colours
//! dial glow: 0 to 1, usually 0.2, Glow

// The object's own colour is in the middle of the bands; the rest lie around it.
fn surface(at: Point, plain: Surface) -> Surface {
    var made = plain;
    let p = at.position / dial.size;
    let time = at.time * dial.speed;
    // Bands bend as noise bends them, and both drift.
    let bend = noise(0.9 * p + vec3<f32>(0.0, -0.6 * time, 0.4 * time));
    let band = sin(2.2 * p.y + 3.5 * bend + 1.3 * time) + 0.6 * sin(1.4 * p.x - 1.1 * p.z - 0.7 * time);
    let turn = 0.4 * dial.spread * band;
    made.colour = mix(plain.colour, turned(plain.colour, turn), clamp(2.0 * dial.spread, 0.0, 1.0));
    let edge = pow(1.0 - clamp(dot(at.normal, at.eye), 0.0, 1.0), 2.0);
    made.glow = plain.glow + dial.glow * made.colour * (0.25 + edge);
    made.roughness = mix(0.3, 0.55, bend);
    return made;
}
