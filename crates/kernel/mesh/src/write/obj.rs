use std::fmt::Write;

use super::Part;

/// A text with one object per mesh. The numbers are the shortest that give the same f32 again.
pub(super) fn encode(parts: &[Part]) -> Vec<u8> {
    let mut text = String::from("# Midair\n");
    let mut first = 1_u64;
    for part in parts {
        let name: String = part
            .name
            .chars()
            .map(|c| {
                if c.is_whitespace() || c.is_control() {
                    '_'
                } else {
                    c
                }
            })
            .collect();
        // Writing to a string cannot fail.
        let _ = writeln!(text, "o {}", if name.is_empty() { "object" } else { &name });
        for p in &part.positions {
            let _ = writeln!(text, "v {} {} {}", p.x, p.y, p.z);
        }
        for triangle in &part.mesh.triangles {
            let [a, b, c] = triangle.map(|v| u64::from(v) + first);
            let _ = writeln!(text, "f {a} {b} {c}");
        }
        first += part.positions.len() as u64;
    }
    text.into_bytes()
}
