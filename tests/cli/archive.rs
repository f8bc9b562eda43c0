//! Zip archives of stored entries, to make documents that Midair would not write.

fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0, |crc, &byte| {
        (0..8).fold(crc ^ u32::from(byte), |c, _| {
            if c & 1 == 1 {
                (c >> 1) ^ 0xEDB8_8320
            } else {
                c >> 1
            }
        })
    })
}

/// An archive of one file.
pub fn of_one(name: &str, content: &[u8]) -> Vec<u8> {
    let mut common = Vec::new();
    // Version, flags, method; time and date of 1 January 1980.
    for short in [20_u16, 0, 0, 0, 0x21] {
        common.extend(short.to_le_bytes());
    }
    for long in [crc32(content), content.len() as u32, content.len() as u32] {
        common.extend(long.to_le_bytes());
    }
    common.extend((name.len() as u16).to_le_bytes());
    common.extend([0; 2]);
    let mut zip = [b"PK\x03\x04", &*common, name.as_bytes(), content].concat();
    let list = zip.len() as u32;
    zip.extend(
        [
            b"PK\x01\x02",
            &[20, 0][..],
            &common,
            &[0; 14],
            name.as_bytes(),
        ]
        .concat(),
    );
    let end = zip.len() as u32;
    zip.extend(b"PK\x05\x06\0\0\0\0\x01\0\x01\0");
    zip.extend((end - list).to_le_bytes());
    zip.extend(list.to_le_bytes());
    zip.extend([0; 2]);
    zip
}
