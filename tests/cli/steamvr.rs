//! What SteamVR is told of Midair.

use std::path::Path;

use serde_json::Value;

#[test]
fn the_manifest_names_what_is_there() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(root.join("midair.vrmanifest")).unwrap();
    let manifest: Value = serde_json::from_str(&text).unwrap();
    let app = &manifest["applications"][0];
    let binary = root.join(app["binary_path_linux"].as_str().unwrap());
    assert!(binary.is_file(), "{}", binary.display());
    assert_eq!(app["arguments"], "--vr");
    assert_eq!(app["strings"]["en_us"]["name"], "Midair");
    // As wide and as tall as the dashboard shows them.
    for (key, width, height) in [("image_path", 920, 430), ("image_path_capsule", 600, 900)] {
        let picture = image::open(root.join(app[key].as_str().unwrap())).unwrap();
        assert_eq!(
            (picture.width(), picture.height()),
            (width, height),
            "{key}"
        );
    }
}
