//! The shaders without any device.

use naga::valid::{Capabilities, ValidationFlags, Validator};

use crate::kernels::sources;
use crate::layout::{Block, Globals, Stage};

fn parsed() -> Vec<(String, naga::Module)> {
    let parse = |(name, text): (String, String)| {
        let module = naga::front::wgsl::parse_str(&text);
        let module = module.unwrap_or_else(|e| panic!("{name}: {}", e.emit_to_string(&text)));
        (name, module)
    };
    sources().into_iter().map(parse).collect()
}

#[test]
fn every_shader_is_valid() {
    for (name, module) in parsed() {
        let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
        if let Err(e) = validator.validate(&module) {
            let text = sources().into_iter().find(|(n, _)| *n == name).unwrap().1;
            panic!("{name}: {}", e.emit_to_string(&text));
        }
    }
}

#[test]
fn structs_are_as_long_as_their_mirrors() {
    let mirrors = [
        ("Globals", size_of::<Globals>()),
        ("Stage", size_of::<Stage>()),
        ("Block", size_of::<Block>()),
    ];
    for (name, module) in parsed() {
        for (mirror, bytes) in mirrors {
            let found = module
                .types
                .iter()
                .find(|(_, t)| t.name.as_deref() == Some(mirror));
            let Some((_, t)) = found else {
                panic!("{name} has no {mirror}");
            };
            let naga::TypeInner::Struct { span, members } = &t.inner else {
                panic!("{mirror} is no struct");
            };
            assert_eq!(*span as usize, bytes, "{mirror} in {name}");
            assert!(members.len() > 4);
        }
    }
}

#[test]
fn members_lie_where_their_mirrors_have_them() {
    use std::mem::offset_of;
    let module = &parsed()[0].1;
    let members = |wanted: &str| {
        let found = module
            .types
            .iter()
            .find(|(_, t)| t.name.as_deref() == Some(wanted));
        match &found.unwrap().1.inner {
            naga::TypeInner::Struct { members, .. } => members.clone(),
            _ => unreachable!(),
        }
    };
    let at = |of: &str, member: &str| {
        let all = members(of);
        let found = all.iter().find(|m| m.name.as_deref() == Some(member));
        found
            .unwrap_or_else(|| panic!("{of} has no {member}"))
            .offset as usize
    };
    macro_rules! same {
        ($t:ident: $($field:ident),*) => {
            $(assert_eq!(at(stringify!($t), stringify!($field)), offset_of!($t, $field));)*
        };
    }
    same!(Globals: step, slack, around, eps, low, shapes, high, top, mesh_low, update, mesh_high, slots);
    same!(Globals: hash_mask, info_base, table_base, chunks, tables, blocks, tape, vertices, triangles);
    same!(Stage: level, split, from_block, to_block, count_in, count_out, group, most, target_args);
    assert_eq!(at("Block", "off"), offset_of!(Block, off));
    assert_eq!(at("Block", "table"), offset_of!(Block, table));
}

/// Numbers that both sides write down.
#[test]
fn constants_agree() {
    use crate::layout::*;
    let module = &parsed()[0].1;
    let number = |wanted: &str| {
        let found = module
            .constants
            .iter()
            .find(|(_, c)| c.name.as_deref() == Some(wanted));
        let init = found.unwrap_or_else(|| panic!("no {wanted}")).1.init;
        match module.global_expressions[init] {
            naga::Expression::Literal(naga::Literal::U32(n)) => n,
            ref other => panic!("{wanted} is {other:?}"),
        }
    };
    let words = [
        ("LEAF", LEAF as u32),
        ("STROKE", STROKE as u32),
        ("INK", INK),
        ("NESTED", NESTED as u32),
        ("INNER", INNER as u32 + 1),
        ("STRIDE", STRIDE as u32),
        ("ALIVE", ALIVE as u32),
        ("NONE", NONE),
        ("INSIDE", INSIDE),
        ("NEAR", NEAR),
        ("ROW", ROW),
        ("SLOTS", counter::SLOTS as u32),
        ("FREE", counter::FREE as u32),
        ("CHUNKS", counter::CHUNKS as u32),
        ("TABLES", counter::TABLES as u32),
        ("TAPE", counter::TAPE as u32),
        ("WORK", counter::WORK as u32),
        ("VERTICES", counter::VERTICES as u32),
        ("TRIANGLES", counter::TRIANGLES as u32),
        ("OVERFLOW", counter::OVERFLOW as u32),
        ("ALL_VERTICES", counter::ALL_VERTICES as u32),
        ("ALL_TRIANGLES", counter::ALL_TRIANGLES as u32),
        ("VERTEX_HEADS", counter::VERTEX_HEADS as u32),
        ("NO_SLOTS", overflow::SLOTS),
        ("NO_CHUNKS", overflow::CHUNKS),
        ("NO_BLOCKS", overflow::BLOCKS),
        ("NO_TAPE", overflow::TAPE),
        ("NO_VERTICES", overflow::VERTICES),
        ("NO_TRIANGLES", overflow::TRIANGLES),
    ];
    for (name, value) in words {
        assert_eq!(number(name), value, "{name}");
    }
    assert!(number("DEEPEST") as usize > DEEPEST);
}

/// WebGPU's least: what every adapter allows.
#[test]
fn workgroups_fit_the_least_adapter() {
    for (name, module) in parsed() {
        for entry in &module.entry_points {
            let [x, y, z] = entry.workgroup_size;
            assert!(x * y * z <= 256, "{name}, {}", entry.name);
        }
        let workgroup: u32 = module
            .global_variables
            .iter()
            .filter(|(_, v)| v.space == naga::AddressSpace::WorkGroup)
            .map(|(_, v)| module.types[v.ty].inner.size(module.to_ctx()))
            .sum();
        assert!(workgroup <= 16_384, "{name}: {workgroup} bytes");
    }
}
