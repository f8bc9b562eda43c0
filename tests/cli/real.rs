//! Real meshes, as people find them: open, many-pieced, self-crossing.

use crate::place::Place;

#[test]
fn every_mesh_at_hand_becomes_an_operand() {
    let Some(folder) = std::env::var_os("MIDAIR_MESHES") else {
        println!("skipped: MIDAIR_MESHES names no folder of meshes");
        return;
    };
    let mut meshes: Vec<_> = std::fs::read_dir(folder)
        .unwrap()
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| midair_mesh::Format::from_path(path).is_some())
        .collect();
    meshes.sort();
    let place = Place::new();
    println!(
        "{:<24} {:>10} {:>10} {:>7}  verdict",
        "mesh", "triangles", "united", "pieces"
    );
    let mut failed = Vec::new();
    for path in &meshes {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let own = midair_mesh::read(path).map(|r| r.mesh.triangles.len());
        let said = place.midair(&["import", &path.to_string_lossy()]);
        assert_eq!(said.status, 0, "{name}: {}", said.err);
        let id = said.out.split_whitespace().next().unwrap();
        place.session(&format!(
            r#"Click(Right, Library),
            Move(hand: Right, to: (0, 1, 0)),
            Ask(Place(component: "{id}", side: Right)),
            Wait(0.2),
            Move(hand: Right, to: (0.13, 1.11, 0.07)),
            Ask(Place(component: "solid/sphere", side: Right)),
            Ask(Edit(SetPending(pending: [(1, Union), (2, Union)]))),
            Ask(Tool(tool: "csg", ask: "update")),
            Expect(objects: 1, closed: true),"#
        ));
        let said = place.midair(&["play", "session.ron", "--export", "united.stl"]);
        assert_eq!(said.status, 0, "{name}: {}", said.err);
        let said = place.midair(&["check", "--json", "united.stl"]);
        let all: serde_json::Value = serde_json::from_str(&said.out).unwrap();
        let verdict = if all[0]["faultless"] == true {
            "faultless".to_owned()
        } else {
            failed.push(name.clone());
            all[0]["faults"].to_string()
        };
        println!(
            "{name:<24} {:>10} {:>10} {:>7}  {verdict}",
            own.map_or(0, |n| n),
            all[0]["triangles"].to_string(),
            all[0]["pieces"].to_string(),
        );
    }
    assert!(failed.is_empty(), "{failed:?}");
}
