use std::io::ErrorKind;

use glam::Vec3;
use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::{
    BeginList, ElementDef, Header, Property, PropertyAccess, PropertyAccessResult, PropertyType,
    ScalarType,
};

use super::reason::{ReadReason, line};
use crate::weld::{MAX_TRIANGLES, Soup};

/// Triangles of a PLY file, text or binary of either byte order; polygons become fans.
pub(crate) fn parse(bytes: &[u8]) -> Result<Soup, ReadReason> {
    let mut reader = Reader::new(bytes);
    let header = Parser::<Other>::new()
        .read_header(&mut reader)
        .map_err(of_parser)?;
    let mut soup = Soup::default();
    for (name, element) in &header.elements {
        // Whatever an element is, it takes a byte: a larger count is a lie that would cost time.
        if element.count > 0
            && (element.properties.is_empty() || element.count > reader.get_ref().len())
        {
            return Err(match element.properties.is_empty() {
                true => ReadReason::Damaged(format!(
                    "its elements \"{}\" have no properties",
                    line(name)
                )),
                false => ReadReason::CutOff(format!(
                    "it announces {} of \"{}\" and ends before",
                    element.count,
                    line(name)
                )),
            });
        }
        match name.as_str() {
            "vertex" => vertices(&mut soup, &mut reader, element, &header)?,
            "face" => faces(&mut soup, &mut reader, element, &header)?,
            "tristrips" => return Err(ReadReason::Unsupported("triangle strips".into())),
            _ => drop(
                Parser::<Other>::new()
                    .read_payload_for_element(&mut reader, element, &header)
                    .map_err(of_parser)?,
            ),
        }
    }
    Ok(soup)
}

fn vertices(
    soup: &mut Soup,
    reader: &mut Reader<&[u8]>,
    element: &ElementDef,
    header: &Header,
) -> Result<(), ReadReason> {
    let has = |names: [&str; 3]| names.iter().all(|&n| element.properties.contains_key(n));
    if !has(["x", "y", "z"]) {
        return Err(ReadReason::Damaged(
            "its vertices have no x, y and z".into(),
        ));
    }
    let read = Parser::<Vertex>::new()
        .read_payload_for_element(reader, element, header)
        .map_err(of_parser)?;
    soup.positions = read.iter().map(|v| v.position).collect();
    if has(["nx", "ny", "nz"]) {
        soup.normals = read.iter().map(|v| v.normal).collect();
    }
    Ok(())
}

fn faces(
    soup: &mut Soup,
    reader: &mut Reader<&[u8]>,
    element: &ElementDef,
    header: &Header,
) -> Result<(), ReadReason> {
    let integers = |kind: &ScalarType| !matches!(kind, ScalarType::Float | ScalarType::Double);
    let known = |name| matches!(element.properties.get(name), Some(p) if matches!(&p.data_type, PropertyType::List(_, of) if integers(of)));
    if element.count > 0 && !known("vertex_indices") && !known("vertex_index") {
        return Err(ReadReason::Damaged(
            "its faces have no list of vertices".into(),
        ));
    }
    if element.count > MAX_TRIANGLES {
        return Err(ReadReason::TooManyTriangles);
    }
    let read = Parser::<Face>::new()
        .read_payload_for_element(reader, element, header)
        .map_err(of_parser)?;
    soup.triangles.reserve(read.len());
    let mut flat = 0;
    for Face(corners) in read {
        if corners.len() < 3 {
            flat += 1;
            continue;
        }
        for pair in corners[1..].windows(2) {
            soup.triangles.push([corners[0], pair[0], pair[1]]);
        }
        if soup.triangles.len() > MAX_TRIANGLES {
            return Err(ReadReason::TooManyTriangles);
        }
    }
    if flat > 0 {
        soup.warnings.push(format!(
            "{flat} faces with fewer than three corners were left out"
        ));
    }
    Ok(())
}

struct Vertex {
    position: Vec3,
    normal: Vec3,
}

impl PropertyAccess for Vertex {
    fn new() -> Self {
        Self {
            position: Vec3::ZERO,
            normal: Vec3::ZERO,
        }
    }

    fn set_float(&mut self, name: &str, value: f32) -> PropertyAccessResult {
        let to = match name {
            "x" => &mut self.position.x,
            "y" => &mut self.position.y,
            "z" => &mut self.position.z,
            "nx" => &mut self.normal.x,
            "ny" => &mut self.normal.y,
            "nz" => &mut self.normal.z,
            _ => return PropertyAccessResult::Ignored,
        };
        *to = value;
        PropertyAccessResult::Set
    }

    fn set_property(&mut self, name: &str, value: Property) -> PropertyAccessResult {
        match value.to_f32_lossy() {
            Some(value) => self.set_float(name, value),
            None => PropertyAccessResult::Ignored,
        }
    }
}

struct Face(Vec<u32>);

impl Face {
    fn is_list(name: &str) -> bool {
        name == "vertex_indices" || name == "vertex_index"
    }
}

impl PropertyAccess for Face {
    fn new() -> Self {
        Self(Vec::new())
    }

    fn begin_list_uint(&mut self, name: &str, _: usize) -> BeginList<'_, u32> {
        if Self::is_list(name) {
            BeginList::Fill(&mut self.0)
        } else {
            BeginList::UseSetter
        }
    }

    fn set_property(&mut self, name: &str, value: Property) -> PropertyAccessResult {
        if !Self::is_list(name) {
            return PropertyAccessResult::Ignored;
        }
        // A negative index is out of range whatever the range: the largest stands for it.
        self.0 = match value {
            Property::ListInt(list) => list
                .into_iter()
                .map(|i| u32::try_from(i).unwrap_or(u32::MAX))
                .collect(),
            other => other.to_u32_list().unwrap_or_else(|| vec![u32::MAX; 3]),
        };
        PropertyAccessResult::Set
    }
}

/// An element that is read over.
struct Other;

impl PropertyAccess for Other {
    fn new() -> Self {
        Self
    }
}

fn of_parser(error: ParseError) -> ReadReason {
    match error.kind() {
        ErrorKind::UnexpectedEof => ReadReason::CutOff("it ends in the middle of its data".into()),
        _ => ReadReason::Damaged(line(error).to_string()),
    }
}
