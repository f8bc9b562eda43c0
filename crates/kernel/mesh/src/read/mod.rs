mod gltf;
mod obj;
pub(crate) mod ply;
mod reason;
mod stl;

use std::fs;
use std::io;
use std::path::Path;

pub use reason::{ReadError, ReadReason};

use crate::weld::Soup;
use crate::{Format, TriMesh, Unit};

/// Larger files are refused rather than read into memory.
const MAX_BYTES: u64 = 4 << 30;

/// What a file held.
#[derive(Clone, Debug)]
pub struct Read {
    /// All of its triangles, in metres, vertices joined where their positions are equal.
    pub mesh: TriMesh,
    /// What the user should know about the reading, each one clause without a full stop.
    pub warnings: Vec<String>,
    /// The file's name without folder and extension.
    pub name: String,
    /// What it was read as.
    pub format: Format,
}

/// Reads a mesh file, in the unit its format has ([`Format::unit`]).
///
/// The format is told by content first and by extension second, so that a wrongly named file is
/// read all the same, with a warning. All meshes of the (default) scene become one.
///
/// # Errors
/// One line that names the file, says what is wrong with it and what to do.
pub fn read(path: &Path) -> Result<Read, ReadError> {
    read_as(path, None)
}

/// As [`read`], its lengths taken to be in `unit`; `None` is the format's own.
pub fn read_as(path: &Path, unit: Option<Unit>) -> Result<Read, ReadError> {
    let file = path
        .file_name()
        .unwrap_or(path.as_os_str())
        .to_string_lossy()
        .into_owned();
    load(path)
        .and_then(|bytes| parse(&bytes, Format::from_path(path), &file, path.parent(), unit))
        .map_err(|reason| ReadError { file, reason })
}

/// Reads a mesh from the bytes of a file, for example one inside an archive. `name` is what it is
/// called in errors. A glTF file whose buffers lie in other files is refused.
pub fn read_bytes(bytes: &[u8], format: Format, name: &str) -> Result<Read, ReadError> {
    read_bytes_as(bytes, format, name, None)
}

/// As [`read_bytes`], its lengths taken to be in `unit`; `None` is the format's own.
pub fn read_bytes_as(
    bytes: &[u8],
    format: Format,
    name: &str,
    unit: Option<Unit>,
) -> Result<Read, ReadError> {
    parse(bytes, Some(format), name, None, unit).map_err(|reason| ReadError {
        file: name.to_owned(),
        reason,
    })
}

/// The bytes of a regular file of bearable size.
fn load(path: &Path) -> Result<Vec<u8>, ReadReason> {
    let about = fs::metadata(path).map_err(reason::of_io)?;
    if about.is_dir() {
        return Err(ReadReason::Folder);
    }
    // A pipe or a device could wait, or go on, for ever.
    if !about.is_file() {
        return Err(ReadReason::Io(io::ErrorKind::InvalidInput.to_string()));
    }
    if about.len() > MAX_BYTES {
        return Err(ReadReason::TooManyBytes);
    }
    fs::read(path).map_err(reason::of_io)
}

fn parse(
    bytes: &[u8],
    named: Option<Format>,
    file: &str,
    folder: Option<&Path>,
    unit: Option<Unit>,
) -> Result<Read, ReadReason> {
    if bytes.iter().all(u8::is_ascii_whitespace) {
        return Err(ReadReason::Empty);
    }
    let shown = Format::from_content(bytes);
    let format = match (shown, named) {
        (Some(shown), _) => shown,
        // These two have no sure signature; the rest do, and it is missing.
        (None, Some(named @ (Format::Obj | Format::Stl))) => named,
        (None, Some(named)) => return Err(ReadReason::NotWhatItSays(named)),
        (None, None) => return Err(ReadReason::UnknownFormat),
    };
    let mut soup: Soup = match format {
        Format::Glb | Format::Gltf => gltf::parse(bytes, folder)?,
        Format::Obj => obj::parse(bytes)?,
        Format::Stl => stl::parse(bytes)?,
        Format::Ply => ply::parse(bytes)?,
        Format::ThreeMf => return Err(ReadReason::WriteOnly),
    };
    let alike = |a, b| {
        a == b
            || matches!(
                (a, b),
                (Format::Glb, Format::Gltf) | (Format::Gltf, Format::Glb)
            )
    };
    match named {
        Some(named) if !alike(named, format) => {
            let article = if format == Format::Obj || format == Format::Stl {
                "an"
            } else {
                "a"
            };
            soup.warnings.insert(
                0,
                format!("{file} is really {article} {format} file and was read as one"),
            );
        }
        _ => {}
    }
    let factor = match unit.unwrap_or(format.unit()) {
        Unit::M => 1.0,
        unit => unit.metres(),
    };
    let (mesh, warnings) = soup.weld(factor)?;
    let name = Path::new(file)
        .file_stem()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned();
    Ok(Read {
        mesh,
        warnings,
        name,
        format,
    })
}
