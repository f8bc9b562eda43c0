use super::shapes::ball;
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
    let mesh = ball(0.2, 24, 12);
    let get = |step| {
        let options = BakeOptions::with_step(step);
        cache
            .get_or_bake(&mesh, mesh.hash(), &options, &Progress::new())
            .unwrap()
    };
    let first = get(0.02);
    assert!(!first.found && first.warning.is_none());
    let again = get(0.02);
    assert!(again.found && again.volume == first.volume);
    assert!(!get(0.03).found);
    for entry in std::fs::read_dir(cache.folder()).unwrap() {
        let path = entry.unwrap().path();
        let bytes = std::fs::read(&path).unwrap();
        std::fs::write(&path, &bytes[..bytes.len() / 2]).unwrap();
    }
    let mended = get(0.02);
    assert!(!mended.found && mended.volume == first.volume);
    assert!(get(0.02).found);
}

#[test]
fn a_folder_that_cannot_be_written_costs_only_the_keeping() {
    let folder = tempfile::tempdir().unwrap();
    let in_the_way = folder.path().join("baked");
    std::fs::write(&in_the_way, "a file").unwrap();
    let mesh = ball(0.2, 24, 12);
    let options = BakeOptions::with_step(0.02);
    let cache = BakeCache::new(&in_the_way);
    let baked = cache
        .get_or_bake(&mesh, mesh.hash(), &options, &Progress::new())
        .unwrap();
    let warning = baked.warning.unwrap();
    assert!(
        warning.contains("baked") && !warning.contains('\n'),
        "{warning}"
    );
}
