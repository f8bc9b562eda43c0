//! Frames: length (4 bytes, little-endian), the first 8 bytes of BLAKE3 of the payload, payload.

use std::io;

/// What a journal starts with.
pub(super) const HEADER: &[u8] = b"midair-journal 1\n";

const SUM: usize = 8;

pub(super) fn push(bytes: &mut Vec<u8>, payload: &[u8]) -> io::Result<()> {
    let len = u32::try_from(payload.len())
        .map_err(|_| io::Error::other("a step of more than 4 GiB cannot be journalled"))?;
    bytes.extend(len.to_le_bytes());
    bytes.extend(&blake3::hash(payload).as_bytes()[..SUM]);
    bytes.extend(payload);
    Ok(())
}

/// The whole, undamaged frames from the start, each with where it ends.
pub(super) fn read(bytes: &[u8]) -> impl Iterator<Item = (&[u8], u64)> {
    let mut rest = bytes.strip_prefix(HEADER).unwrap_or_default();
    std::iter::from_fn(move || {
        let (len, after) = rest.split_first_chunk::<4>()?;
        let (sum, after) = after.split_first_chunk::<SUM>()?;
        let (payload, after) = after.split_at_checked(u32::from_le_bytes(*len) as usize)?;
        if blake3::hash(payload).as_bytes()[..SUM] != *sum {
            return None;
        }
        rest = after;
        Some((payload, (bytes.len() - rest.len()) as u64))
    })
}
