use thiserror::Error;

use crate::TriMesh;
use crate::read::ply;
use crate::write::ply as write_ply;

/// Why bytes are no mesh.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum BytesError {
    /// They are damaged or cut off.
    #[error("the mesh is damaged: {0}")]
    Damaged(String),
    /// A triangle names a vertex that is not there.
    #[error("the mesh is damaged: a triangle names a vertex that is not there")]
    IndexOutOfRange,
}

/// A mesh as a binary little-endian PLY file in metres, for keeping inside a document. Positions,
/// normals, triangles, their order and so the hash come back bit for bit from [`from_bytes`].
pub fn to_bytes(mesh: &TriMesh) -> Vec<u8> {
    write_ply::encode(&[(mesh, &mesh.positions)])
}

/// The mesh that [`to_bytes`] was given. Nothing is welded, dropped or rounded.
pub fn from_bytes(bytes: &[u8]) -> Result<TriMesh, BytesError> {
    let soup = ply::parse(bytes).map_err(|reason| BytesError::Damaged(reason.to_string()))?;
    let n = soup.positions.len();
    if soup.triangles.iter().flatten().any(|&v| v as usize >= n) {
        return Err(BytesError::IndexOutOfRange);
    }
    Ok(TriMesh {
        positions: soup.positions,
        normals: soup.normals,
        triangles: soup.triangles,
    })
}
