use std::io::{self, Cursor};

use glam::Vec3;

use super::reason::{ReadReason, line};
use crate::format::stl_count;
use crate::weld::{MAX_TRIANGLES, Soup};

/// Triangles of an STL file, binary or text, three positions each, in the file's unit.
pub(super) fn parse(bytes: &[u8]) -> Result<Soup, ReadReason> {
    let count = stl_count(bytes);
    let fits = count.is_some_and(|n| bytes.len() as u64 == 84 + 50 * n);
    let start = bytes.trim_ascii_start();
    let is_text = !fits && start.len() >= 5 && start[..5].eq_ignore_ascii_case(b"solid");
    if is_text { text(start) } else { binary(bytes) }
}

fn binary(bytes: &[u8]) -> Result<Soup, ReadReason> {
    let Some(count) = stl_count(bytes) else {
        return Err(ReadReason::CutOff("its header is incomplete".into()));
    };
    let present = (bytes.len() as u64 - 84) / 50;
    if present < count {
        return Err(ReadReason::CutOff(format!(
            "it announces {count} triangles and holds {present}"
        )));
    }
    if count > MAX_TRIANGLES as u64 {
        return Err(ReadReason::TooManyTriangles);
    }
    let mut soup = Soup::default();
    if (bytes.len() as u64) > 84 + 50 * count {
        soup.warnings
            .push("there is more in the file behind its last triangle, which was left out".into());
    }
    // The header is free text; blank it, for the parser takes "solid" to mean a text file.
    let body = &bytes[80..84 + 50 * count as usize];
    add(&mut soup, &mut Cursor::new([&[0; 80], body].concat()))?;
    Ok(soup)
}

/// Text may hold several solids, in any case, with or without names; the parser knows one form.
fn text(bytes: &[u8]) -> Result<Soup, ReadReason> {
    let mut soup = Soup::default();
    let mut solid = String::new();
    for raw in String::from_utf8_lossy(bytes).lines() {
        let words = raw.trim();
        if words
            .get(..5)
            .is_some_and(|w| w.eq_ignore_ascii_case("solid"))
        {
            solid.clear();
            solid.push_str("solid _\n");
        } else if words
            .get(..8)
            .is_some_and(|w| w.eq_ignore_ascii_case("endsolid"))
        {
            solid.push_str("endsolid\n");
            add(&mut soup, &mut Cursor::new(std::mem::take(&mut solid)))?;
        } else if !words.is_empty() && solid.is_empty() {
            return Err(ReadReason::Damaged(
                "there is text outside of its solids".into(),
            ));
        } else {
            solid.push_str(&words.to_ascii_lowercase());
            solid.push('\n');
        }
    }
    match solid.trim().is_empty() {
        true => Ok(soup),
        false => Err(ReadReason::CutOff("its last solid has no end".into())),
    }
}

fn add<R: io::Read + io::Seek>(soup: &mut Soup, from: &mut R) -> Result<(), ReadReason> {
    for triangle in stl_io::create_stl_reader(from).map_err(of_parser)? {
        let first = soup.positions.len() as u32;
        soup.positions.extend(
            triangle
                .map_err(of_parser)?
                .vertices
                .map(|v| Vec3::from_array(v.0)),
        );
        soup.triangles.push([first, first + 1, first + 2]);
        if soup.triangles.len() > MAX_TRIANGLES {
            return Err(ReadReason::TooManyTriangles);
        }
    }
    Ok(())
}

fn of_parser(error: io::Error) -> ReadReason {
    match error.kind() {
        io::ErrorKind::UnexpectedEof => ReadReason::CutOff("a triangle is incomplete".into()),
        _ => ReadReason::Damaged(line(error)),
    }
}
