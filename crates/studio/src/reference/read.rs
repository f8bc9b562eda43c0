//! From the bytes of a file to a picture, or to one line that says why not.

use std::io::{Cursor, Read};
use std::path::Path;

use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits};

/// A file of a picture may have so many bytes: it is saved again with every document.
const FILE: u64 = 64 << 20;
/// And so many pixels along a side, and in all: what a common machine holds in memory.
const ALONG: u32 = 16_384;
const PIXELS: u64 = 64_000_000;
/// Larger ones are drawn with fewer: no screen shows more.
const DRAWN: u32 = 4_096;

/// A picture's file that can be read.
pub(crate) struct Picture {
    /// As it was found.
    pub bytes: Vec<u8>,
    /// Width and height in pixels, as it is to be seen.
    pub size: (u32, u32),
}

/// Reads a picture's file, whole, so that a broken one is found here.
///
/// # Errors
/// One line that names the file, the reason and the way out.
pub(crate) fn read(path: &Path) -> Result<Picture, String> {
    let name = path.file_name().map_or_else(
        || path.display().to_string(),
        |n| n.to_string_lossy().into(),
    );
    let unreadable = |e: std::io::Error| {
        let reason = match e.kind() {
            std::io::ErrorKind::NotFound => "there is no such file".to_owned(),
            std::io::ErrorKind::PermissionDenied => "you may not read it".to_owned(),
            std::io::ErrorKind::IsADirectory => "it is a folder".to_owned(),
            kind => kind.to_string(),
        };
        format!("{name} cannot be read: {reason}. Check its name, or pick another picture.")
    };
    let mut bytes = Vec::new();
    let file = std::fs::File::open(path).map_err(unreadable)?;
    file.take(FILE + 1)
        .read_to_end(&mut bytes)
        .map_err(unreadable)?;
    if bytes.len() as u64 > FILE {
        return Err(format!(
            "{name} has more than {} MB, too much for a reference image. Save it smaller, then bring it in again.",
            FILE >> 20
        ));
    }
    match decode(&bytes) {
        Ok(picture) => Ok(Picture {
            size: (picture.width(), picture.height()),
            bytes,
        }),
        Err(fault) => Err(format!("{name} {fault}")),
    }
}

/// The pixels to draw: red, green, blue and opacity, at most [`DRAWN`] along a side.
pub(super) fn pixels(bytes: &[u8]) -> Option<image::RgbaImage> {
    let picture = decode(bytes).ok()?;
    let small = if picture.width().max(picture.height()) > DRAWN {
        picture.thumbnail(DRAWN, DRAWN)
    } else {
        picture
    };
    Some(small.into_rgba8())
}

/// Why there is no picture; follows the file's name in a sentence.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
enum Fault {
    #[error("is no PNG or JPEG picture. Save it as one of these, or pick another file.")]
    Format,
    #[error(
        "is cut off or damaged. Save it again from where it was made, or pick another picture."
    )]
    Damaged,
    #[error(
        "has {0} × {1} pixels, too many for a reference image (16,384 along a side, 64 million in all). Save it smaller, then bring it in again."
    )]
    Huge(u32, u32),
}

fn decode(bytes: &[u8]) -> Result<DynamicImage, Fault> {
    let reader = || {
        let reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format();
        reader.map_err(|_| Fault::Damaged)
    };
    let first = reader()?;
    if !matches!(first.format(), Some(ImageFormat::Png | ImageFormat::Jpeg)) {
        return Err(Fault::Format);
    }
    // The size is looked at before anything of that size is made.
    let (width, height) = first.into_dimensions().map_err(|_| Fault::Damaged)?;
    if width.max(height) > ALONG || u64::from(width) * u64::from(height) > PIXELS {
        return Err(Fault::Huge(width, height));
    }
    let mut second = reader()?;
    let mut limits = Limits::no_limits();
    limits.max_alloc = Some(16 * PIXELS);
    second.limits(limits);
    let mut decoder = second.into_decoder().map_err(|_| Fault::Damaged)?;
    // A camera that was held upright says so beside the pixels.
    let orientation = decoder.orientation();
    let mut picture = DynamicImage::from_decoder(decoder).map_err(|_| Fault::Damaged)?;
    if let Ok(orientation) = orientation {
        picture.apply_orientation(orientation);
    }
    Ok(picture)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn png(width: u32, height: u32) -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        let picture = DynamicImage::new_rgb8(width, height);
        picture.write_to(&mut bytes, ImageFormat::Png).unwrap();
        bytes.into_inner()
    }

    #[test]
    fn a_picture_is_read_and_what_is_none_says_why_in_one_line() {
        let folder = std::env::temp_dir().join(format!("midair-pictures-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let whole = png(300, 200);
        let mut wide = png(8, 8);
        // The header says more than there is; its checksum is checked as well.
        wide[16..20].copy_from_slice(&200_000_u32.to_be_bytes());
        for (name, bytes, says) in [
            ("good.png", whole.clone(), None),
            (
                "cut.png",
                whole[..whole.len() / 2].to_vec(),
                Some("damaged"),
            ),
            ("empty.png", Vec::new(), Some("no PNG or JPEG")),
            (
                "text.jpg",
                b"not a picture".to_vec(),
                Some("no PNG or JPEG"),
            ),
            ("short.jpg", b"\xff\xd8\xff\xe0".to_vec(), Some("damaged")),
            ("wide.png", wide, Some("")),
            (
                "gif.png",
                b"GIF89a\x01\0\x01\0".to_vec(),
                Some("no PNG or JPEG"),
            ),
        ] {
            let path = folder.join(name);
            std::fs::write(&path, bytes).unwrap();
            match (read(&path), says) {
                (Ok(picture), None) => assert_eq!(picture.size, (300, 200)),
                (Err(line), Some(says)) => {
                    assert!(line.starts_with(name) && line.contains(says), "{line}");
                    assert_eq!(line.lines().count(), 1);
                }
                (found, _) => panic!("{name}: {:?}", found.map(|p| p.size)),
            }
        }
        assert!(read(&folder).is_err_and(|line| line.contains("cannot be read")));
        assert!(read(&folder.join("gone.png")).is_err_and(|l| l.contains("no such file")));
        std::fs::remove_dir_all(&folder).unwrap();
        assert_eq!(decode(&png(16_385, 1)).unwrap_err(), Fault::Huge(16_385, 1));
    }
}
