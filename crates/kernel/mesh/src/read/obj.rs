use std::io::Cursor;

use glam::Vec3;
use tobj::{LoadError, LoadOptions};

use super::reason::ReadReason;
use crate::weld::Soup;

/// Triangles of an OBJ file; polygons become fans. Normals are left out: an OBJ has them per
/// corner, and they follow from the rest.
pub(super) fn parse(bytes: &[u8]) -> Result<Soup, ReadReason> {
    let (text, mut soup) = shape_only(bytes)?;
    let options = LoadOptions {
        triangulate: true,
        ignore_points: true,
        ignore_lines: true,
        ..LoadOptions::default()
    };
    let no_materials = |_: &std::path::Path| Err(LoadError::OpenFileFailed);
    let (models, _) =
        tobj::load_obj_buf(&mut Cursor::new(text), &options, no_materials).map_err(of_parser)?;
    for model in models {
        let first = soup.positions.len() as u32;
        soup.positions
            .extend(model.mesh.positions.chunks_exact(3).map(Vec3::from_slice));
        soup.triangles.extend(
            model
                .mesh
                .indices
                .chunks_exact(3)
                .map(|t| [t[0] + first, t[1] + first, t[2] + first]),
        );
    }
    Ok(soup)
}

/// The lines that make the shape, in the form the parser knows: one object, so that its positions
/// are shared throughout; lines continued with a backslash joined; colours behind positions left out.
fn shape_only(bytes: &[u8]) -> Result<(String, Soup), ReadReason> {
    let mut soup = Soup::default();
    let mut text = String::with_capacity(bytes.len().min(1 << 30));
    let (mut flat, mut free) = (0_usize, false);
    let whole = String::from_utf8_lossy(bytes);
    let mut lines = whole.trim_start_matches('\u{feff}').lines();
    let mut joined = String::new();
    while let Some(raw) = lines.next() {
        let mut line = raw;
        if raw.trim_end().ends_with('\\') {
            joined.clear();
            let mut part = raw;
            while let Some(start) = part.trim_end().strip_suffix('\\') {
                joined.push_str(start);
                joined.push(' ');
                part = lines.next().unwrap_or_default();
            }
            joined.push_str(part);
            line = &joined;
        }
        let line = line.split('#').next().unwrap_or_default();
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                // A fourth number alone is a weight; more are a colour.
                let keep = if words.clone().count() == 4 { 4 } else { 3 };
                text.push('v');
                words.take(keep).for_each(|word| {
                    text.push(' ');
                    text.push_str(word);
                });
                text.push('\n');
            }
            Some("f") => match words.clone().count() {
                0..3 => flat += 1,
                _ => {
                    text.push('f');
                    // Only the position of each corner: v, v/vt, v//vn, v/vt/vn.
                    for word in words {
                        let position = word.split('/').next().unwrap_or_default();
                        // Index 0 does not exist, and the parser would count it as the last.
                        if position.parse::<i64>().is_ok_and(|i| i == 0) {
                            return Err(ReadReason::Damaged(
                                "a face names vertex 0, but OBJ counts from 1".into(),
                            ));
                        }
                        text.push(' ');
                        text.push_str(position);
                    }
                    text.push('\n');
                }
            },
            Some("l" | "p") => flat += 1,
            Some("curv" | "curv2" | "surf") => free = true,
            _ => {}
        }
    }
    if flat > 0 {
        soup.warnings
            .push(format!("{flat} points and lines were left out"));
    }
    if free {
        soup.warnings
            .push("curves and free-form surfaces were left out".into());
    }
    Ok((text, soup))
}

fn of_parser(error: LoadError) -> ReadReason {
    ReadReason::Damaged(
        match error {
            LoadError::PositionParseError => "a vertex has no three numbers",
            LoadError::ScalingByZeroError => "a vertex has weight zero",
            LoadError::FaceParseError => "a face names something that is not a vertex number",
            LoadError::FaceVertexOutOfBounds => "a face names a vertex that is not there",
            LoadError::InvalidPolygon => "a face has too few corners",
            _ => "it does not follow the format",
        }
        .into(),
    )
}
