//! Pictures of the library's components: drawn off the frame when first looked at, kept on disk.

use std::io::Cursor;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex, PoisonError};

use bevy::prelude::*;
use bevy::tasks::AsyncComputeTaskPool;
use midair_field::{Recipe, RecipeHash};
use midair_library::Volumes;
use midair_solid::Thumbnail;

use crate::bounded::Bounded;

/// Pixels along each side.
pub const SIZE: usize = 128;
/// So many are drawn at once: the rest of the machine is the frame's and the solids'.
const AT_ONCE: usize = 2;
/// Changes where pictures are drawn in another way, so that old ones are not found.
const STYLE: u32 = 1;

/// What there is of a picture.
#[derive(Clone, Debug)]
pub enum Picture {
    /// It is being drawn, or will be.
    Waiting,
    /// It is there.
    Here(Arc<Thumbnail>),
    /// It cannot be drawn; says why.
    None(Arc<str>),
}

/// The pictures that were asked for.
#[derive(Resource, Clone, Default)]
pub struct Thumbnails(Arc<Mutex<Shelf>>);

/// So many are kept in memory, 64 KiB each: several screens full.
const KEPT: usize = 512;

struct Shelf {
    pictures: Bounded<RecipeHash, Picture>,
    drawing: usize,
}

impl Default for Shelf {
    fn default() -> Self {
        Self {
            pictures: Bounded::new(KEPT),
            drawing: 0,
        }
    }
}

impl Thumbnails {
    /// The picture of a recipe; where there is none yet it is begun, if few enough are on their way.
    pub fn get(&self, recipe: &Recipe, volumes: &Arc<Volumes>, cache: &Path) -> Picture {
        let mut shelf = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let hash = recipe.hash();
        if let Some(picture) = shelf.pictures.get(&hash) {
            return picture.clone();
        }
        if shelf.drawing >= AT_ONCE {
            return Picture::Waiting;
        }
        shelf.drawing += 1;
        shelf.pictures.insert(hash, Picture::Waiting);
        drop(shelf);
        let (slot, recipe, volumes) = (self.0.clone(), recipe.clone(), volumes.clone());
        let file = file(cache, &hash);
        AsyncComputeTaskPool::get()
            .spawn(async move {
                let picture =
                    read(&file).map_or_else(|| draw(&recipe, &volumes, &file), Picture::Here);
                let mut shelf = slot.lock().unwrap_or_else(PoisonError::into_inner);
                shelf.drawing -= 1;
                shelf.pictures.insert(hash, picture);
            })
            .detach();
        Picture::Waiting
    }

    /// Whether any is being drawn, so that what shows them looks again.
    pub fn is_busy(&self) -> bool {
        self.0
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .drawing
            > 0
    }
}

fn file(cache: &Path, hash: &RecipeHash) -> PathBuf {
    cache.join(format!("{hash}-{SIZE}-{STYLE}.png"))
}

fn draw(recipe: &Recipe, volumes: &Volumes, file: &Path) -> Picture {
    match Thumbnail::of(recipe, SIZE, volumes, &AtomicBool::new(false)) {
        Ok(picture) => {
            // A cache that cannot be written is only slower.
            let _ = write(&picture, file);
            Picture::Here(Arc::new(picture))
        }
        Err(reason) => Picture::None(reason.to_string().into()),
    }
}

/// A picture that cannot be read is drawn again.
fn read(file: &Path) -> Option<Arc<Thumbnail>> {
    let bytes = std::fs::read(file).ok()?;
    let decoded = image::load_from_memory_with_format(&bytes, image::ImageFormat::Png).ok()?;
    let rgba = decoded.into_rgba8();
    let right = rgba.width() as usize == SIZE && rgba.height() as usize == SIZE;
    right.then(|| {
        Arc::new(Thumbnail {
            size: SIZE,
            rgba: rgba.into_raw(),
        })
    })
}

fn write(picture: &Thumbnail, file: &Path) -> Option<()> {
    let size = picture.size as u32;
    let image = image::RgbaImage::from_raw(size, size, picture.rgba.clone())?;
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, image::ImageFormat::Png).ok()?;
    std::fs::create_dir_all(file.parent()?).ok()?;
    std::fs::write(file, bytes.into_inner()).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use midair_field::Primitive;

    #[test]
    fn a_picture_on_disk_is_found_again_and_a_broken_one_is_not() {
        let folder = std::env::temp_dir().join(format!("midair-thumbnails-{}", std::process::id()));
        let recipe: Recipe = Primitive::Sphere { radius: 0.1 }.into();
        let file = file(&folder, &recipe.hash());
        let picture = Thumbnail::of(&recipe, SIZE, &(), &AtomicBool::new(false)).unwrap();
        write(&picture, &file).unwrap();
        assert_eq!(*read(&file).unwrap(), picture);
        std::fs::write(&file, b"\x89PNG\r\n").unwrap();
        assert!(read(&file).is_none());
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
