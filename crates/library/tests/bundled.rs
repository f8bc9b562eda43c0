//! Every bundled component: sound, in place, of plausible volume, and still called what it was.

mod common;

use std::collections::BTreeSet;

use common::{Samples, sample};
use glam::Vec3;
use midair_field::{Node, Recipe};
use midair_library::{CATEGORIES, Library, Source};

#[test]
fn all_are_read_and_no_id_is_used_twice() {
    let library = Library::bundled();
    assert_eq!(library.warnings(), []);
    let ids: BTreeSet<&str> = library.components().iter().map(|c| c.id.as_str()).collect();
    assert_eq!(ids.len(), library.components().len());
    for c in library.components() {
        assert!(
            CATEGORIES.contains(&c.category.as_str()),
            "{}: category {}",
            c.id,
            c.category
        );
        assert!(!c.tags.is_empty(), "{}: no tags", c.id);
        assert!(!c.missing && c.source == Source::Bundled, "{}", c.id);
        let placed = c.placed();
        let named = matches!(placed.node(), Node::Component { id, recipe } if *id == c.id && *recipe == c.recipe);
        assert!(named, "{}", c.id);
    }
}

/// Documents and sessions name components by these. One may be added here, none taken away.
#[test]
fn ids_are_kept() {
    let library = Library::bundled();
    let mut ids: Vec<&str> = library.components().iter().map(|c| c.id.as_str()).collect();
    ids.sort_unstable();
    let known: Vec<&str> = include_str!("ids.txt").lines().collect();
    assert_eq!(
        ids, known,
        "tests/ids.txt lists the ids of all bundled components, sorted"
    );
}

#[test]
fn recipes_survive_being_written_and_read() {
    for c in Library::bundled().components() {
        let text = ron::to_string(&c.recipe).unwrap();
        let back: Recipe = ron::from_str(&text).unwrap();
        assert_eq!(back.hash(), c.recipe.hash(), "{}", c.id);
        assert_eq!(back.node(), c.recipe.node(), "{}", c.id);
    }
}

#[test]
fn each_is_centred_and_of_its_size() {
    let mut wrong = Vec::new();
    for c in Library::bundled().components() {
        let Samples {
            step,
            inside,
            volume,
        } = sample(&c.recipe);
        let mut see = |good: bool, what: String| {
            if !good {
                wrong.push(format!("{}: {what}", c.id));
            }
        };
        see(!inside.is_empty(), "nothing inside".to_owned());
        // The outermost samples inside lie within a step of the surface.
        let off = inside.centre();
        see(
            off.abs().max_element() <= 1.01 * step,
            format!("centre at {off}"),
        );
        let longest = inside.size().max_element();
        see(longest <= 0.4 + 1e-4, format!("{longest} m long"));
        let own_scale = ["Chair", "Cup", "Brushes"].contains(&c.category.as_str());
        // Of a sharp tip the lattice misses a little.
        see(own_scale || longest > 0.36, format!("{longest} m long"));
        let claimed = c.recipe.bounds();
        let held = claimed.grown(1e-5);
        let holds = held.min.cmple(inside.min).all() && held.max.cmpge(inside.max).all();
        see(holds, format!("{inside:?} beyond {claimed:?}"));
        let long = claimed.size().max_element();
        see(own_scale || long > 0.4 - 1e-4, format!("claims {long} m"));
        // No more than the box it claims, up to what the lattice adds at edges, and no mere film.
        let size = claimed.size();
        let fill = volume / (size.x * size.y * size.z);
        see(
            (0.03..=1.05).contains(&fill),
            format!("fills {fill} of its box"),
        );
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn volumes_are_those_of_the_textbook() {
    use std::f32::consts::PI;
    let library = Library::bundled();
    let cylinder = PI * 0.15 * 0.15 * 0.4;
    let known = [
        ("solid/sphere", 4.0 / 3.0 * PI * 0.008),
        ("solid/cube", 0.064),
        ("solid/cylinder", cylinder),
        ("solid/cone", PI * 0.04 * 0.4 / 3.0),
        ("solid/torus", 2.0 * PI * PI * 0.15 * 0.05 * 0.05),
        ("solid/pyramid", 0.16 * 0.3 / 3.0),
        ("solid/octahedron", 4.0 / 3.0 * 0.008),
        ("solid/half-sphere", 2.0 / 3.0 * PI * 0.008),
        ("solid/tube", PI * (0.01 - 0.075 * 0.075) * 0.4),
        ("solid/ellipsoid", 4.0 / 3.0 * PI * 0.2 * 0.12 * 0.12),
        ("solid/wedge", 0.5 * 0.4 * 0.2 * 0.3),
        ("solid/prism-6", 1.5 * 3f32.sqrt() * 0.18 * 0.18 * 0.4),
    ];
    for (id, exact) in known {
        let volume = sample(&library.get(id).unwrap().recipe).volume;
        let off = (volume / exact - 1.0).abs();
        assert!(off < 0.02, "{id}: {volume} m³ instead of {exact} m³");
    }
}

/// EasyVRModeling Fig. 7b: a chair of six components, each touching the seat.
#[test]
fn a_chair_can_be_built_of_six() {
    let library = Library::bundled();
    let size = |id: &str| library.get(id).unwrap().recipe.bounds().size();
    for seat in ["square", "round", "saddle"] {
        let seat = size(&format!("chair/seat-{seat}"));
        for leg in ["square", "round", "tapered", "turned", "sabre"] {
            let leg = size(&format!("chair/leg-{leg}"));
            assert!((leg.y - 0.4).abs() < 1e-4 && 4.0 * leg.x.max(leg.z) < seat.x);
        }
        for back in ["panel", "spindle", "ladder", "bow", "curved"] {
            let back = size(&format!("chair/back-{back}"));
            assert!((back.y - 0.4).abs() < 1e-4 && back.x <= seat.x && back.x > 0.8 * seat.x);
        }
        for arm in ["straight", "curved"] {
            let arm = size(&format!("chair/arm-{arm}"));
            assert!(arm.z <= seat.z && arm.x < 0.2 * seat.x);
        }
    }
}

#[test]
fn a_handle_reaches_into_the_wall_of_a_mug_but_not_into_the_coffee() {
    let library = Library::bundled();
    let mug = library.get("cup/mug").unwrap().recipe.bounds();
    for handle in ["round", "square", "ear"] {
        let handle = library
            .get(&format!("cup/handle-{handle}"))
            .unwrap()
            .recipe
            .bounds();
        assert!(handle.size().y < 0.9 * mug.size().y);
        assert!(handle.size().x > 0.05);
    }
    let lid = library.get("cup/lid").unwrap().recipe.bounds().size();
    assert!(Vec3::new(lid.x, 0.0, lid.z).max_element() <= mug.size().x + 0.02);
}
