use super::shapes::ball;
use midair_mesh::MeshHash;

use super::*;

#[test]
fn a_volume_survives_its_bytes() {
    let v = baked(&ball(0.2, 24, 12));
    let bytes = v.to_bytes();
    assert!(Volume::from_bytes(&bytes) == Some(v));
    for cut in [0, 7, 8, 39, 47, 48, 200, bytes.len() - 1] {
        assert!(Volume::from_bytes(&bytes[..cut]).is_none());
    }
    for place in (0..bytes.len()).step_by(bytes.len() / 50) {
        let mut bad = bytes.clone();
        bad[place] ^= 0x20;
        assert!(Volume::from_bytes(&bad).is_none());
    }
}

#[test]
fn a_forged_file_is_refused() {
    for plain in [vec![0xff; 200], vec![0; 200], vec![1; 4000], Vec::new()] {
        let mut rest = (plain.len() as u64).to_le_bytes().to_vec();
        rest.extend(lz4_flex::block::compress(&plain));
        let mut bytes = b"mdrvol\0\x03".to_vec();
        bytes.extend(blake3::hash(&rest).as_bytes());
        bytes.extend(rest);
        assert!(Volume::from_bytes(&bytes).is_none());
    }
}

#[test]
fn the_cache_keeps_and_mends() {
    let folder = tempfile::tempdir().unwrap();
    let cache = BakeCache::new(folder.path().join("baked"));
    let volume = baked(&ball(0.2, 24, 12));
    let (name, other) = (MeshHash([1; 32]), MeshHash([2; 32]));
    let options = BakeOptions::with_step(0.02);
    assert!(cache.find(name, &options).is_none());
    cache.keep(name, &options, &volume).unwrap();
    assert!(cache.find(name, &options) == Some(volume.clone()));
    assert!(cache.find(other, &options).is_none());
    assert!(cache.find(name, &BakeOptions::with_step(0.03)).is_none());
    for entry in std::fs::read_dir(cache.folder()).unwrap() {
        let path = entry.unwrap().path();
        let bytes = std::fs::read(&path).unwrap();
        std::fs::write(&path, &bytes[..bytes.len() / 2]).unwrap();
    }
    assert!(cache.find(name, &options).is_none());
    cache.keep(name, &options, &volume).unwrap();
    assert!(cache.find(name, &options) == Some(volume));
}

#[test]
fn a_folder_that_cannot_be_written_costs_only_the_keeping() {
    let folder = tempfile::tempdir().unwrap();
    let in_the_way = folder.path().join("baked");
    std::fs::write(&in_the_way, "a file").unwrap();
    let cache = BakeCache::new(&in_the_way);
    let options = BakeOptions::with_step(0.02);
    let warning = cache
        .keep(MeshHash([1; 32]), &options, &baked(&ball(0.2, 24, 12)))
        .unwrap_err();
    assert!(
        warning.contains("baked") && !warning.contains('\n'),
        "{warning}"
    );
}
