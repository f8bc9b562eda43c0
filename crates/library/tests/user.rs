//! The user's own components: read, listed, found, saved; broken ones hide nothing.

mod common;

use std::fs;
use std::path::Path;

use common::home;
use midair_field::{Node, Placement, Primitive, Recipe};
use midair_library::{Folders, Library, Source, Warning, save};

const BALL: &str =
    r#"(id: "own/ball", name: "My ball", tags: ["toy"], recipe: Primitive(Sphere(radius: 0.1)))"#;

fn put(folders: &Folders, name: &str, text: impl AsRef<[u8]>) {
    let path = folders.components().join(name);
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    fs::write(path, text).unwrap();
}

#[test]
fn own_components_stand_beside_the_bundled_ones() {
    let (_dir, folders) = home();
    put(&folders, "toys/ball.ron", BALL);
    put(&folders, "notes.txt", "not read");
    let library = Library::load(&folders);
    assert_eq!(library.warnings(), []);
    assert_eq!(
        library.components().len(),
        Library::bundled().components().len() + 1
    );
    let ball = library.get("own/ball").unwrap();
    assert_eq!(
        ball.source,
        Source::User(folders.components().join("toys").join("ball.ron"))
    );
    let (last, own) = library.categories().last().unwrap();
    assert_eq!((last, own), ("Own", std::slice::from_ref(ball)));
}

#[test]
fn what_is_taken_away_is_kept_however_often() {
    let (_dir, folders) = home();
    let mut kept = Vec::new();
    for radius in ["0.1", "0.2", "0.3"] {
        let text = BALL.replace("0.1", radius);
        put(&folders, "ball.ron", &text);
        let mut library = Library::load(&folders);
        let away = library.take_away("own/ball").unwrap().unwrap();
        assert!(library.get("own/ball").is_none());
        assert!(Library::load(&folders).get("own/ball").is_none());
        kept.push((away, text));
    }
    for (away, text) in kept {
        assert_eq!(fs::read_to_string(away).unwrap(), text);
    }
    let mut library = Library::load(&folders);
    assert!(library.warnings().is_empty());
    assert_eq!(library.take_away("solid/cube").unwrap(), None);
    assert!(library.get("solid/cube").is_some());
}

#[test]
fn each_broken_file_costs_one_line_and_hides_nothing() {
    let broken: &[(&str, &[u8], usize, &str)] = &[
        ("a-empty.ron", b"", 1, ""),
        ("b-binary.ron", b"\x00\xff\xfe\x01", 0, "UTF-8"),
        ("c-cut.ron", b"(\n id: \"own/c\",\n name: \"C\",\n recipe: Primitive(Sphere(", 4, ""),
        ("d-unknown.ron", b"(id: \"own/d\", name: \"D\",\n recipe: Primitive(Blob(radius: 1.0)))", 2, "Blob"),
        ("e-field.ron", b"(id: \"own/e\", name: \"E\",\n colour: \"red\", recipe: Primitive(Sphere(radius: 0.1)))", 2, "colour"),
        ("f-radius.ron", b"(id: \"own/f\", name: \"F\",\n recipe: Primitive(Sphere(radius: -0.1)))", 2, "radius"),
        ("g-nan.ron", b"(id: \"own/g\", name: \"G\",\n recipe: Primitive(Sphere(radius: NaN)))", 2, "radius"),
        ("h-huge.ron", b"(id: \"own/h\", name: \"H\", recipe: Primitive(Sphere(radius: 1e9)))", 1, ""),
        ("i-nothing.ron", b"(id: \"own/i\", name: \"I\", recipe: Solid([]))", 1, ""),
        ("j-flat.ron", b"(id: \"own/j\", name: \"J\", recipe: Primitive(Convex(points: [(0,0,0), (1,0,0), (0,1,0), (1,1,0)])))", 1, ""),
        ("k-nameless.ron", b"(id: \"own/k\",\n name: \" \",\n recipe: Primitive(Sphere(radius: 0.1)))", 2, "name"),
        ("l-scale.ron", b"(id: \"own/l\", name: \"L\", recipe: Solid([(op: Union, placement: (scale: (1, 0, 1)), recipe: Primitive(Sphere(radius: 0.1)))]))", 1, ""),
        ("m-turned.ron", b"(id: \"own/m\", name: \"M\", recipe: Solid([(op: Union, placement: (rotation: (1, 1, 1, 1)), recipe: Primitive(Sphere(radius: 0.1)))]))", 1, ""),
    ];
    let (_dir, folders) = home();
    for (name, bytes, ..) in broken {
        put(&folders, name, bytes);
    }
    let deep = format!(
        "(id: \"own/n\", name: \"N\", recipe: {}",
        "Solid([(op: Union, recipe: ".repeat(50_000)
    );
    put(&folders, "n-deep.ron", deep);
    put(&folders, "o-large.ron", vec![b' '; 5 << 20]);
    fs::create_dir_all(folders.components().join("p-folder.ron")).unwrap();
    put(&folders, "z-ball.ron", BALL);
    let library = Library::load(&folders);
    assert!(library.get("own/ball").is_some());
    assert_eq!(
        library.components().len(),
        Library::bundled().components().len() + 1
    );
    let warnings = library.warnings();
    let lines: Vec<String> = warnings.iter().map(ToString::to_string).collect();
    assert_eq!(warnings.len(), broken.len() + 2, "{lines:#?}");
    for ((name, _, line, says), (warning, text)) in broken.iter().zip(warnings.iter().zip(&lines)) {
        assert!(text.contains(name) && text.contains(says), "{name}: {text}");
        assert!(!text.contains('\n') && text.len() < 400, "{name}: {text}");
        match warning {
            Warning::Broken { line: at, .. } => assert_eq!(at, line, "{text}"),
            _ => assert_eq!(*line, 0, "{text}"),
        }
    }
    assert!(lines[broken.len()].contains("n-deep.ron"));
    assert!(
        lines[broken.len() + 1].contains("o-large.ron")
            && lines[broken.len() + 1].contains("4 MiB")
    );
}

#[test]
fn of_two_files_with_one_id_the_first_is_used() {
    let (_dir, folders) = home();
    put(&folders, "a.ron", BALL);
    put(&folders, "b.ron", BALL.replace("My ball", "Other"));
    let library = Library::load(&folders);
    assert_eq!(library.get("own/ball").unwrap().name, "My ball");
    let [warning @ Warning::Duplicate { .. }] = library.warnings() else {
        panic!("{:?}", library.warnings());
    };
    let text = warning.to_string();
    assert!(
        text.contains("a.ron") && text.contains("b.ron") && text.contains("own/ball"),
        "{text}"
    );
}

#[test]
fn an_own_component_may_replace_a_bundled_one() {
    let (_dir, folders) = home();
    put(&folders, "cube.ron", BALL.replace("own/ball", "solid/cube"));
    let library = Library::load(&folders);
    assert_eq!(library.get("solid/cube").unwrap().name, "My ball");
    assert_eq!(
        library.components().len(),
        Library::bundled().components().len()
    );
}

#[test]
fn a_folder_may_take_the_place_of_the_bundled_components() {
    let (dir, folders) = home();
    let bundled = dir.path().join("bundled");
    fs::create_dir(&bundled).unwrap();
    fs::write(bundled.join("ball.ron"), BALL).unwrap();
    let library = Library::load_from(&bundled, &folders);
    assert_eq!(library.components().len(), 1);
    assert_eq!(library.components()[0].source, Source::Bundled);
    assert!(
        Library::load_from(Path::new("nowhere"), &folders)
            .components()
            .is_empty()
    );
}

#[test]
fn a_component_whose_mesh_is_gone_is_listed_as_missing() {
    let (_dir, folders) = home();
    let text = format!(
        "(id: \"own/gone\", name: \"Gone\", recipe: Mesh(mesh: \"{}\", bounds: (min: (-1, -1, -1), max: (1, 1, 1))))",
        "ab".repeat(32)
    );
    put(&folders, "gone.ron", text);
    let library = Library::load(&folders);
    assert!(library.get("own/gone").unwrap().missing);
    let [Warning::MeshGone { name, .. }] = library.warnings() else {
        panic!("{:?}", library.warnings());
    };
    assert_eq!(name, "Gone");
    assert!(library.to_text().contains("(mesh gone)"));
}

#[test]
fn a_search_forgives() {
    let library = Library::bundled();
    let first = |query: &str| library.search(query).first().map(|c| c.id.as_str());
    assert_eq!(first("sphere"), Some("solid/sphere"));
    assert_eq!(first("SPHERE"), Some("solid/sphere"));
    assert_eq!(first("shpere"), Some("solid/sphere"));
    assert_eq!(first("ball"), Some("solid/sphere"));
    assert_eq!(first("torus"), Some("solid/torus"));
    assert_eq!(first("rounded cub"), Some("solid/rounded-cube"));
    assert_eq!(first("letter q"), Some("letter/q"));
    assert_eq!(first("seven"), Some("numeral/7"));
    assert_eq!(first("spring"), Some("solid/helix"));
    assert_eq!(first("mug"), Some("cup/mug"));
    assert_eq!(first("octagonal"), Some("solid/prism-8"));
    assert!(
        library
            .search("seat")
            .iter()
            .take(3)
            .all(|c| c.id.starts_with("chair/seat"))
    );
    assert!(
        library
            .search("chair leg")
            .iter()
            .take(3)
            .all(|c| c.id.starts_with("chair/leg"))
    );
    assert!(library.search("xylophone").is_empty());
    assert_eq!(library.search("  ").len(), library.components().len());
}

#[test]
fn the_shelf_is_in_order() {
    let library = Library::bundled();
    let categories: Vec<&str> = library.categories().map(|(c, _)| c).collect();
    assert_eq!(categories, midair_library::CATEGORIES);
}

#[test]
fn listings_name_every_component() {
    let library = Library::bundled();
    let json: serde_json::Value = serde_json::from_str(&library.to_json()).unwrap();
    let entries = json.as_array().unwrap();
    let text = library.to_text();
    assert_eq!(entries.len(), library.components().len());
    for (entry, c) in entries.iter().zip(library.components()) {
        assert_eq!(entry["id"], c.id);
        assert_eq!(entry["source"], "bundled");
        assert_eq!(entry["recipe"].as_str().unwrap().len(), 64);
        assert!(text.contains(&c.id));
    }
}

#[test]
fn a_solid_is_saved_centred_and_found_again() {
    let (_dir, folders) = home();
    let ball = Recipe::from(Primitive::Sphere { radius: 0.1 });
    let moved = Recipe::new(Node::Solid(vec![midair_field::Operand {
        op: midair_field::Op::Union,
        placement: Placement::at(glam::Vec3::new(1.0, 2.0, 3.0)),
        recipe: ball.clone(),
        muted: false,
    }]));
    let none = |_: &_| None;
    let a = save(&folders, "Übung", &moved, &none).unwrap();
    assert_eq!(a.id, "own/übung");
    assert!(a.recipe.bounds().centre().length() < 1e-6);
    let again = save(&folders, "Übung", &moved, &none).unwrap();
    assert_eq!(again, a);
    let other = save(&folders, "Übung", &ball, &none).unwrap();
    assert_eq!(
        (other.id.as_str(), other.name.as_str()),
        ("own/übung-2", "Übung 2")
    );
    let mut library = Library::load(&folders);
    assert_eq!(library.get("own/übung"), Some(&a));
    assert_eq!(library.get("own/übung-2"), Some(&other));
    let count = library.components().len();
    library.insert(other);
    assert_eq!(library.components().len(), count);
    let empty = Recipe::new(Node::Solid(Vec::new()));
    assert!(save(&folders, "Nothing", &empty, &none).is_err());
}

#[cfg(unix)]
#[test]
fn a_library_that_cannot_be_written_says_so() {
    let (dir, _) = home();
    let file = dir.path().join("a-file");
    fs::write(&file, "").unwrap();
    let ball = Recipe::from(Primitive::Sphere { radius: 0.1 });
    let error = save(&Folders::below(&file), "Ball", &ball, &|_| None)
        .unwrap_err()
        .to_string();
    assert!(error.contains("a-file") && !error.contains('\n'), "{error}");
}
