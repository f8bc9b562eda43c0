//! Fits curves given as JSON on standard input, `[{points, tangents, samples}]`, and says for each which tangent
//! magnitudes came out and in how many milliseconds, measured along the chords of the curve as the paper's code does
//! and along the curve itself as Midair does: the other side of `benches/mvc.py`.

use std::error::Error;
use std::io::Read;
use std::time::Instant;

use glam::DVec3;
use midair_beautify::stroke::{Along, Curve, fit_with};
use serde_json::{Value, json};

fn vectors(value: &Value) -> Option<Vec<DVec3>> {
    let vector = |v: &Value| {
        let n = |i: usize| v.get(i)?.as_f64();
        Some(DVec3::new(n(0)?, n(1)?, n(2)?))
    };
    value.as_array()?.iter().map(vector).collect()
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut text = String::new();
    std::io::stdin().read_to_string(&mut text)?;
    let problems: Vec<Value> = serde_json::from_str(&text)?;
    let mut out = Vec::new();
    for problem in &problems {
        let curve = Curve {
            points: vectors(&problem["points"]).ok_or("points are triples")?,
            tangents: vectors(&problem["tangents"]).ok_or("tangents are triples")?,
            closed: false,
        };
        let samples = problem["samples"].as_u64().ok_or("samples is a number")? as usize;
        let out_of = |along: Along| {
            let mut best = f64::INFINITY;
            let mut fitted = fit_with(&curve, samples, along);
            for _ in 0..15 {
                let started = Instant::now();
                fitted = fit_with(&curve, samples, along);
                best = best.min(started.elapsed().as_secs_f64() * 1e3);
            }
            json!({ "magnitudes": fitted.magnitudes, "ms": best, "steps": fitted.steps })
        };
        out.push(json!({ "chords": out_of(Along::Chords), "curve": out_of(Along::Curve) }));
    }
    println!("{}", Value::Array(out));
    Ok(())
}
