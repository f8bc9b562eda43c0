use std::fmt;
use std::path::Path;

use crate::Unit;

/// A mesh file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Format {
    /// Binary glTF 2.0.
    Glb,
    /// glTF 2.0 as JSON, its buffers inside or beside it. Read only.
    Gltf,
    /// Wavefront OBJ.
    Obj,
    /// STL; read as text or binary, written as binary.
    Stl,
    /// PLY; read as text or binary, written as binary.
    Ply,
    /// 3D Manufacturing Format. Written only.
    ThreeMf,
}

impl Format {
    /// What can be read, as a user would list it.
    pub const READABLE: &str = "GLB, glTF, OBJ, STL or PLY";
    /// What can be written, as a user would list it.
    pub const WRITABLE: &str = ".glb, .obj, .stl, .ply or .3mf";

    /// The format that the extension of `path` stands for, in upper or lower case.
    pub fn from_path(path: &Path) -> Option<Self> {
        Some(
            match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
                "glb" => Self::Glb,
                "gltf" => Self::Gltf,
                "obj" => Self::Obj,
                "stl" => Self::Stl,
                "ply" => Self::Ply,
                "3mf" => Self::ThreeMf,
                _ => return None,
            },
        )
    }

    /// Whether it holds lines as well as faces.
    pub fn has_lines(self) -> bool {
        matches!(self, Self::Glb | Self::Gltf | Self::Obj)
    }

    /// The format that the bytes themselves show; `None` where they leave it open.
    pub fn from_content(bytes: &[u8]) -> Option<Self> {
        if bytes.starts_with(b"glTF") {
            return Some(Self::Glb);
        }
        if bytes.starts_with(b"ply\n") || bytes.starts_with(b"ply\r") {
            return Some(Self::Ply);
        }
        if bytes.starts_with(b"PK\x03\x04") {
            return Some(Self::ThreeMf);
        }
        // Before any look at text: a binary STL may well begin with the word "solid".
        if stl_count(bytes).is_some_and(|n| bytes.len() as u64 == 84 + 50 * n) {
            return Some(Self::Stl);
        }
        let head = &bytes[..bytes.len().min(1 << 16)];
        if head.contains(&0) {
            return None;
        }
        let text = String::from_utf8_lossy(head);
        let text = text.trim_start_matches('\u{feff}').trim_start();
        if text.starts_with('{') {
            return text.contains("\"asset\"").then_some(Self::Gltf);
        }
        let lower = |n: usize| {
            text.chars()
                .take(n)
                .collect::<String>()
                .to_ascii_lowercase()
        };
        if lower(5) == "solid" && lower(4096).contains("facet") {
            return Some(Self::Stl);
        }
        // An OBJ has no signature: its first vertex line must look like one.
        text.lines()
            .find(|line| line.starts_with("v ") || line.starts_with("v\t"))
            .filter(|line| {
                line.split_whitespace()
                    .skip(1)
                    .take(3)
                    .filter(|w| w.parse::<f32>().is_ok())
                    .count()
                    == 3
            })
            .map(|_| Self::Obj)
    }

    /// The unit that this format has on disk: millimetres for STL and 3MF, metres for the rest.
    pub const fn unit(self) -> Unit {
        match self {
            Self::Stl | Self::ThreeMf => Unit::Mm,
            Self::Glb | Self::Gltf | Self::Obj | Self::Ply => Unit::M,
        }
    }
}

/// The number of triangles that a binary STL header announces.
pub(crate) fn stl_count(bytes: &[u8]) -> Option<u64> {
    let count: [u8; 4] = bytes.get(80..84)?.try_into().ok()?;
    Some(u32::from_le_bytes(count).into())
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Glb => "GLB",
            Self::Gltf => "glTF",
            Self::Obj => "OBJ",
            Self::Stl => "STL",
            Self::Ply => "PLY",
            Self::ThreeMf => "3MF",
        })
    }
}
