//! Every command, its help, and wrong usage.

use std::fs::File;

use crate::place::{CUBE, Place, Said};

const COMMANDS: [&str; 6] = ["play", "export", "import", "library", "bench", "check"];

#[test]
fn help_and_version_are_done() {
    let place = Place::new();
    let help = place.done(&["--help"]);
    for command in COMMANDS {
        assert!(help.contains(command), "{command}");
        let its = place.done(&[command, "--help"]);
        assert!(its.contains("Usage: midair"), "{its}");
    }
    let version = place.done(&["--version"]);
    assert!(version.starts_with("midair "), "{version}");
}

#[test]
fn wrong_usage_is_status_two() {
    let place = Place::new();
    let cases: [&[&str]; 12] = [
        &["--nonsense"],
        &["play"],
        &["play", "a.ron", "--speed", "2"],
        &["play", "a.ron", "--step", "0"],
        &["play", "a.ron", "--step", "nan"],
        &["export", "a.midair"],
        &["export", "a.midair", "--to", "b.stl", "--unit", "furlong"],
        &["export", "a.midair", "--to", "b.stl", "--step", "two"],
        &["import"],
        &["bench", "--backend", "quantum"],
        &["check"],
        &["library", "extra"],
    ];
    for args in cases {
        let said = place.midair(args);
        assert_eq!(said.status, 2, "{args:?}: {}", said.err);
        assert!(said.out.is_empty() && !said.err.contains("panicked"));
    }
}

#[test]
fn what_this_machine_cannot_do_is_said_in_one_line() {
    let place = Place::new();
    place.refused(&["--vr"], &["no headset", "flat screen"]);
    place.refused(&[], &["display"]);
    place.refused(&["a.midair"], &["a.midair"]);
    place.refused(
        &["bench", "--backend", "gpu", "csg/teapot"],
        &["csg/teapot", "gpu/chair"],
    );
    place.refused(&["bench", "csg/teapot"], &["csg/teapot", "csg/cup"]);
}

#[test]
fn the_library_is_listed() {
    let place = Place::new();
    let text = place.done(&["library"]);
    assert!(text.contains("solid/cube"));
    let json: serde_json::Value =
        serde_json::from_str(&place.done(&["library", "--json"])).unwrap();
    let text = json.to_string();
    assert!(text.matches("\"id\"").count() >= 45);
}

#[test]
fn a_whole_way_from_session_to_print() {
    let place = Place::new();
    place.session(CUBE);
    let out = place.done(&[
        "play",
        "session.ron",
        "--hands-only",
        "--save",
        "a.midair",
        "--export",
        "a.stl",
        "--report",
        "a.json",
        "--record",
        "b.ron",
    ]);
    assert_eq!(out, "");
    for (file, flags) in [
        ("b.stl", ["--unit", "mm"]),
        ("b.glb", ["--unit", "m"]),
        ("b.obj", ["--unit", "inch"]),
        ("b.ply", ["--step", "0.02"]),
        ("b.3mf", ["--step", "0.005"]),
    ] {
        let said = place.done(&[&["export", "a.midair", "--to", file], &flags[..]].concat());
        assert!(said.contains("triangles"), "{said}");
    }
    assert_eq!(place.read("a.stl"), place.read("b.stl"));
    let said = place.done(&["check", "a.stl", "b.glb", "b.ply", "a.midair", "--json"]);
    let all: serde_json::Value = serde_json::from_str(&said).unwrap();
    assert_eq!(all.as_array().unwrap().len(), 4);
    assert!(
        all.as_array()
            .unwrap()
            .iter()
            .all(|a| a["faultless"] == true)
    );
    let volume = all[1]["volume"].as_f64().unwrap();
    assert!((volume / 0.064 - 1.0).abs() < 0.02, "{volume}");
    // An export is a mesh like any other.
    place.done(&["import", "a.stl", "--name", "My cube"]);
    assert!(place.done(&["library"]).contains("My cube"));
}

#[test]
fn a_benchmark_writes_its_figures() {
    let place = Place::new();
    let row = place.done(&["bench", "csg/cube-sphere/0.012", "--json", "figures.json"]);
    assert!(row.contains("csg/cube-sphere/0.012"));
    let figures: serde_json::Value = serde_json::from_slice(&place.read("figures.json")).unwrap();
    let text = figures.to_string();
    for field in [
        "name", "backend", "unit", "median", "min", "max", "runs", "paper", "details",
    ] {
        assert!(text.contains(&format!("\"{field}\"")), "{field}");
    }
    place.refused(
        &[
            "bench",
            "csg/cube-sphere/0.012",
            "--json",
            "/proc/none/figures.json",
        ],
        &["/proc/none/figures.json"],
    );
}

#[test]
fn an_output_that_cannot_be_written_is_one_line() {
    let place = Place::new();
    place.session(CUBE);
    place.done(&["play", "session.ron", "--save", "a.midair"]);
    std::fs::create_dir(place.path("folder.stl")).unwrap();
    std::fs::create_dir(place.path("folder.midair")).unwrap();
    for (to, word) in [
        ("/proc/x.stl", "x.stl"),
        ("none/x.stl", "x.stl"),
        ("folder.stl", "folder.stl"),
        ("x", "ending"),
        ("x.gltf", "x.gltf"),
        ("/dev/full", "ending"),
    ] {
        place.refused(&["export", "a.midair", "--to", to], &[word]);
        place.refused(&["play", "session.ron", "--export", to], &[word]);
    }
    for to in ["/proc/x.midair", "none/x.midair", "folder.midair"] {
        place.refused(&["play", "session.ron", "--save", to], &[to]);
    }
    for to in ["/proc/x.json", "none/x.json", "folder.stl", "/dev/full"] {
        place.refused(&["play", "session.ron", "--report", to], &[to]);
    }
    for to in ["/proc/x.ron", "none/x.ron", "folder.stl"] {
        place.refused(&["play", "session.ron", "--record", to], &[to]);
    }
}

#[test]
fn a_full_disk_behind_the_output_is_one_line() {
    if !std::path::Path::new("/dev/full").exists() {
        println!("skipped: no /dev/full here");
        return;
    }
    let place = Place::new();
    place.session(CUBE);
    place.done(&[
        "play",
        "session.ron",
        "--save",
        "a.midair",
        "--export",
        "a.stl",
    ]);
    let cases: [&[&str]; 4] = [
        &["library"],
        &["library", "--json"],
        &["check", "a.stl"],
        &["export", "a.midair", "--to", "b.stl"],
    ];
    for args in cases {
        let full = File::options().write(true).open("/dev/full").unwrap();
        let said = Said::of(&place.command().args(args).stdout(full).output().unwrap());
        assert_eq!(said.status, 1, "{args:?}: {}", said.err);
        assert_eq!(said.err.lines().count(), 1, "{args:?}: {}", said.err);
        assert!(said.err.contains("output"), "{}", said.err);
    }
    let record = ["play", "session.ron", "--record", "/dev/full"];
    place.refused(&record, &["/dev/full"]);
}

#[test]
fn slicers_get_z_up_and_everybody_what_they_ask_for() {
    let place = Place::new();
    // A slab: 0.4 m wide, twice as high as deep.
    place.session(
        r#"
            Ask(ToggleLibrary), Ask(Place(component: "solid/cube", side: Right)),
            Ask(Objects(Place([(1, (scale: (1, 0.5, 0.25)))]))),
        "#,
    );
    place.done(&[
        "play",
        "session.ron",
        "--save",
        "a.midair",
        "--export",
        "a.stl",
    ]);
    place.done(&["play", "session.ron", "--export", "p.stl", "--up", "y"]);
    let sizes = |name: &str| {
        let bounds = midair_mesh::read(&place.path(name)).unwrap().mesh.bounds();
        bounds.size().to_array().map(|v| (v * 100.0).round() as i32)
    };
    for (name, up, wanted) in [
        ("b.stl", None, [40, 10, 20]),
        ("c.stl", Some("z"), [40, 10, 20]),
        ("d.stl", Some("y"), [40, 20, 10]),
        ("e.glb", None, [40, 20, 10]),
        ("f.obj", Some("Z"), [40, 10, 20]),
    ] {
        let mut args = vec!["export", "a.midair", "--to", name];
        args.extend(up.map(|up| ["--up", up]).into_iter().flatten());
        place.done(&args);
        assert_eq!(sizes(name), wanted, "{name}");
    }
    assert_eq!(place.read("a.stl"), place.read("b.stl"));
    assert_eq!(place.read("p.stl"), place.read("d.stl"));
    let said = place.midair(&["export", "a.midair", "--to", "g.stl", "--up", "x"]);
    assert_eq!(said.status, 2);
}

#[test]
fn what_cannot_be_written_is_said_before_anything_is_played() {
    let place = Place::new();
    // Played to its end this would fail in another way.
    place.session("Expect(objects: 7),");
    for args in [["--save", "none/a.midair"], ["--export", "none/a.stl"]] {
        place.refused(
            &["play", "session.ron", args[0], args[1]],
            &[args[1].rsplit('/').next().unwrap()],
        );
        let line = place.refused(&["play", "session.ron", args[0], args[1]], &[]);
        assert!(!line.contains('7'), "{line}");
    }
    for args in [["--report", "none/a.json"], ["--shot", "none/a.png"]] {
        let line = place.refused(&["play", "session.ron", args[0], args[1]], &[args[1]]);
        assert!(!line.contains('7'), "{line}");
    }
    // Nothing is left of the question.
    let line = place.refused(&["play", "session.ron", "--report", "a.json"], &["7"]);
    assert!(!place.path("a.json").exists(), "{line}");
}
