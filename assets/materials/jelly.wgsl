//! name: Jelly
//! about: Wobbles: its surface moves with time
//! colour: #5fc48f
//! roughness: 0.16
//! metallic: 0
//! dial speed: 0 to 4, usually 1, Speed
//! dial height: 0 to 0.05, usually 0.004, Height of the waves (m)
//! dial size: 0.02 to 1, usually 0.12, Length of the waves (m)

// How far a point of the surface is moved, in metres of the object. Only what is drawn moves: hands take the object
// where it was modelled, and files hold it as it was modelled.
fn shift(at: Point) -> vec3<f32> {
    let p = 6.2832 * at.position / dial.size;
    let t = 4.0 * at.time * dial.speed;
    let wave = sin(p.x + 0.5 * p.z + t) * sin(0.8 * p.y - 0.7 * t) + 0.5 * sin(0.6 * p.z - 0.4 * p.y + 1.3 * t);
    return dial.height * wave * at.normal;
}

fn surface(at: Point, plain: Surface) -> Surface {
    var made = plain;
    // Light comes through where it is seen edge on.
    let edge = pow(1.0 - clamp(dot(at.normal, at.eye), 0.0, 1.0), 2.5);
    made.colour = mix(0.75 * plain.colour, vec3<f32>(1.0), 0.35 * edge);
    made.glow = plain.glow + 0.28 * edge * plain.colour;
    return made;
}
