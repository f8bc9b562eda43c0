//! A material's file, and what is put around it: looked at by naga before anything is drawn with it.

use std::fmt::Write;

use midair_solid::{HeadFault, MOST_DIALS, MaterialInfo};
use naga::front::wgsl;
use naga::valid::{Capabilities, ValidationFlags, Validator};

const PRELUDE: &str = include_str!("prelude.wgsl");
const HOST: &str = include_str!("host.wgsl");

/// In place of the host, where there is no Bevy around it: both functions in the stage that calls them.
const TRIAL: &str = "
@vertex fn midair_vertex(@location(0) p: vec3<f32>) -> @builtin(position) vec4<f32> {
    let moved: vec3<f32> = shift(Point(p, p, p, dial.midair_pace));
    return vec4<f32>(moved, 1.0);
}
@fragment fn midair_fragment_main(@location(0) p: vec3<f32>) -> @location(0) vec4<f32> {
    let plain = Surface(p, 1.0, 1.0, 0.0, p, p);
    let made: Surface = surface(Point(p, p, p, dial.midair_pace), plain);
    return vec4<f32>(made.colour, made.opacity);
}
";

/// Why a file is no material: the line, from 1, and the reason.
pub(super) type Fault = HeadFault;

/// Reads a file and looks its WGSL through. What comes back can be drawn with.
pub(super) fn read(id: &str, text: &str) -> Result<MaterialInfo, Fault> {
    let info = MaterialInfo::read(id, text)?;
    look_through(&info, text)?;
    Ok(info)
}

/// What is compiled: the file first, so that its lines are the compiler's, then what is put around it.
pub(super) fn whole(info: &MaterialInfo) -> String {
    assemble(
        info,
        info.wgsl.as_deref().unwrap_or_default(),
        "#{MATERIAL_BIND_GROUP}",
        HOST,
    )
}

fn assemble(info: &MaterialInfo, text: &str, group: &str, host: &str) -> String {
    let mut all = format!("{text}\n{PRELUDE}\nstruct Dials {{\n");
    for dial in &info.dials {
        let _ = writeln!(all, "    {}: f32,", dial.id);
    }
    for spare in info.dials.len()..MOST_DIALS {
        let _ = writeln!(all, "    midair_spare_{spare}: f32,");
    }
    let _ = writeln!(
        all,
        "    midair_pace: f32,\n    midair_line: f32,\n}}\n@group({group}) @binding(100) var<uniform> dial: Dials;"
    );
    let code = code(text);
    if !defines(&code, "shift") {
        all += "fn shift(at: Point) -> vec3<f32> { return vec3<f32>(0.0); }\n";
    }
    if !defines(&code, "surface") {
        all += "fn surface(at: Point, plain: Surface) -> Surface { return plain; }\n";
    }
    all + host
}

fn look_through(info: &MaterialInfo, text: &str) -> Result<(), Fault> {
    let code = code(text);
    let lines = text.lines().count();
    let at = |line: usize, why: String| Fault { line, why };
    if !defines(&code, "shift") && !defines(&code, "surface") {
        let why = "a material has fn surface(at: Point, plain: Surface) -> Surface, \
                   fn shift(at: Point) -> vec3<f32>, or both";
        return Err(at(1, why.to_owned()));
    }
    for (line, words) in code.lines().enumerate() {
        if let Some(sign) = words.chars().find(|c| ['#', '@'].contains(c)) {
            let why = format!("a material is functions and constants, and has no {sign}");
            return Err(at(line + 1, why));
        }
    }
    let trial = assemble(info, text, "3", TRIAL);
    // What is wrong outside the file is wrong with how its functions or dials are named.
    let place = |line: usize, why: String| {
        if line <= lines {
            return at(line, why);
        }
        let wanted = [
            ("shift", "fn shift(at: Point) -> vec3<f32>"),
            (
                "surface",
                "fn surface(at: Point, plain: Surface) -> Surface",
            ),
        ];
        for (name, form) in wanted {
            let found = code.lines().position(|l| defines(l, name));
            if let Some(line) = found.filter(|_| {
                trial
                    .lines()
                    .nth(line - 1)
                    .is_some_and(|l| l.contains(&format!(" {name}(")))
            }) {
                return at(line + 1, format!("{name} is to be {form}"));
            }
        }
        at(1, format!("with what Midair adds: {why}"))
    };
    let module = wgsl::parse_str(&trial).map_err(|error| {
        let line = error.location(&trial).map_or(1, |l| l.line_number as usize);
        place(line, error.message().to_owned())
    })?;
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
    validator.validate(&module).map_err(|error| {
        let line = error.location(&trial).map_or(1, |l| l.line_number as usize);
        let mut why = error.as_inner().to_string();
        let mut source = std::error::Error::source(error.as_inner());
        while let Some(inner) = source {
            why = inner.to_string();
            source = inner.source();
        }
        place(line, why)
    })?;
    Ok(())
}

/// Whether it moves what is made of it.
pub(super) fn shifts(text: &str) -> bool {
    defines(&code(text), "shift")
}

/// Whether a function of that name is written there.
fn defines(code: &str, name: &str) -> bool {
    code.match_indices("fn ").any(|(at, _)| {
        let before = code[..at].chars().next_back();
        let rest = code[at + 3..].trim_start();
        let free = before.is_none_or(|c| !c.is_alphanumeric() && c != '_');
        free && rest
            .strip_prefix(name)
            .is_some_and(|r| r.trim_start().starts_with('('))
    })
}

/// The text without its comments, line for line.
fn code(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut deep = 0_usize;
    for line in text.lines() {
        let mut rest = line;
        while !rest.is_empty() {
            if let Some(after) = rest.strip_prefix("/*") {
                (deep, rest) = (deep + 1, after);
            } else if let Some(after) = rest.strip_prefix("*/").filter(|_| deep > 0) {
                (deep, rest) = (deep - 1, after);
            } else if deep == 0 && rest.starts_with("//") {
                break;
            } else {
                let next = rest.chars().next().map_or(1, char::len_utf8);
                if deep == 0 {
                    out.push_str(&rest[..next]);
                }
                rest = &rest[next..];
            }
        }
        out.push('\n');
    }
    out
}

#[cfg(test)]
mod tests {
    use midair_solid::Materials;

    use super::*;

    #[test]
    fn what_is_bundled_can_be_drawn_with() {
        let all = Materials::default();
        let mut seen = 0;
        for info in all.iter() {
            if let Some(text) = &info.wgsl {
                read(&info.id, text).unwrap_or_else(|f| panic!("{}, {f}", info.id));
                seen += 1;
            }
        }
        assert_eq!(seen, 4);
    }

    #[test]
    fn a_fault_is_told_with_its_line() {
        let fault = |text: &str| read("moss", text).unwrap_err().to_string();
        let head = "//! name: Moss\n//! dial speed: 0 to 1, usually 0.5\n";
        let sound = "fn surface(at: Point, plain: Surface) -> Surface {\n    return plain;\n}\n";
        read("moss", &format!("{head}{sound}")).unwrap();
        for (text, says) in [
            ("fn other() {}", "line 1: a material has fn surface"),
            (
                "fn surface(at: Point, plain: Surface) -> Surface {\n    return plane;\n}",
                "line 4: no definition in scope",
            ),
            (
                "fn surface(at: Point, plain: Surface) -> Surface {\n    var p = plain\n    return p;\n}",
                "line 5: expected",
            ),
            (
                "fn surface(at: Point, plain: Surface) -> Surface {\n    var p = plain;\n    p.colour = dial.size * p.colour;\n    return p;\n}",
                "line 5: invalid field accessor",
            ),
            (
                "fn surface(at: Point) -> vec3<f32> {\n    return at.normal;\n}",
                "line 3: surface is to be fn surface",
            ),
            (
                "fn shift(at: Point) -> f32 {\n    return 1.0;\n}",
                "line 3: shift is to be fn shift",
            ),
            (
                "fn surface(at: Point, plain: Surface) -> Surface {\n    return plain;\n}\n@group(0) @binding(0) var<uniform> a: f32;",
                "line 6: a material is functions",
            ),
            (
                "#import bevy_pbr::forward_io\nfn shift(at: Point) -> vec3<f32> { return at.normal; }",
                "line 3: a material is functions",
            ),
            (
                "fn shift(at: Point) -> vec3<f32> {\n    return dpdx(at.normal);\n}",
                "line",
            ),
        ] {
            let said = fault(&format!("{head}{text}"));
            assert!(said.starts_with(says), "{text}\n{said}");
        }
        // A name that the language keeps for itself.
        let kept = format!("//! name: A\n//! dial loop: 0 to 1, usually 0\n{sound}");
        assert!(
            fault(&kept).contains("line 1: with what Midair adds"),
            "{}",
            fault(&kept)
        );
    }

    #[test]
    fn comments_are_no_code() {
        let text = "// fn shift(\n/* @ /* # */ */ fn surface(a)\n";
        assert_eq!(code(text), "\n fn surface(a)\n");
        assert!(defines(&code(text), "surface") && !defines(&code(text), "shift"));
        assert!(!defines("xfn shift()", "shift") && !defines("fn shifted()", "shift"));
        assert!(defines("fn  shift ()", "shift"));
    }
}
