use std::fmt::Write;

use super::{Lines, Part};

/// A text with one object per mesh, and one of `l` elements per curve. The numbers are the shortest that give the same f32 again.
pub(super) fn encode(parts: &[Part], curves: &[Lines]) -> Vec<u8> {
    let mut text = String::from("# Midair\n");
    let (mut first, mut mapped) = (1_u64, 1_u64);
    for part in parts {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "o {}", word(part.name));
        for p in &part.positions {
            let _ = writeln!(text, "v {} {} {}", p.x, p.y, p.z);
        }
        for uv in part.uv {
            let _ = writeln!(text, "vt {} {}", uv.x, uv.y);
        }
        for triangle in &part.mesh.triangles {
            let [a, b, c] = triangle.map(|v| u64::from(v) + first);
            if part.uv.is_empty() {
                let _ = writeln!(text, "f {a} {b} {c}");
            } else {
                let [p, q, r] = triangle.map(|v| u64::from(v) + mapped);
                let _ = writeln!(text, "f {a}/{p} {b}/{q} {c}/{r}");
            }
        }
        first += part.positions.len() as u64;
        mapped += part.uv.len() as u64;
    }
    for curve in curves {
        let _ = writeln!(text, "o {}", word(curve.name));
        for p in &curve.positions {
            let _ = writeln!(text, "v {} {} {}", p.x, p.y, p.z);
        }
        text.push('l');
        let count = curve.positions.len() as u64;
        for i in (0..count).chain(curve.closed.then_some(0)) {
            let _ = write!(text, " {}", first + i);
        }
        text.push('\n');
        first += count;
    }
    text.into_bytes()
}

/// A name without what ends one in this format.
fn word(name: &str) -> String {
    let plain = |c: char| {
        if c.is_whitespace() || c.is_control() {
            '_'
        } else {
            c
        }
    };
    if name.is_empty() {
        return "object".to_owned();
    }
    name.chars().map(plain).collect()
}
