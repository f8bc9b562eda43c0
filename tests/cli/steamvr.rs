//! What SteamVR is told of Midair.

use std::path::Path;

use serde_json::Value;

#[test]
fn the_manifest_names_what_is_there() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(root.join("midair.vrmanifest")).unwrap();
    let manifest: Value = serde_json::from_str(&text).unwrap();
    let app = &manifest["applications"][0];
    for file in ["binary_path_linux64", "image_path"] {
        let path = root.join(app[file].as_str().unwrap());
        assert!(path.is_file(), "{}", path.display());
    }
    assert_eq!(app["arguments"], "--vr");
    assert_eq!(app["strings"]["en_us"]["name"], "Midair");
    let picture = image::open(root.join(app["image_path"].as_str().unwrap())).unwrap();
    assert_eq!((picture.width(), picture.height()), (460, 215));
}
