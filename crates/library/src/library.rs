use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

use include_dir::{Dir, DirEntry, include_dir};

use crate::component::{Component, Source, category_rank};
use crate::folders::Folders;
use crate::read::{Warning, parse, read_folder};
use crate::save::SaveError;
use crate::shelf::MeshShelf;

static BUNDLED: Dir<'static> = include_dir!("$CARGO_MANIFEST_DIR/../../assets/components");

/// Everything that can be placed, in the order of the shelf: by category, bundled before the
/// user's own, then by name.
#[derive(Clone, Debug, Default)]
pub struct Library {
    components: Vec<Component>,
    warnings: Vec<Warning>,
}

impl Library {
    /// The bundled components and what lies in the user's folders. Broken files cost a warning
    /// each and hide nothing else; folders that do not exist are empty.
    pub fn load(folders: &Folders) -> Self {
        let mut library = Self::bundled();
        library.add_user(folders);
        library.sort();
        library
    }

    /// As [`Library::load`], with the components below `bundled` in place of those built in.
    pub fn load_from(bundled: &Path, folders: &Folders) -> Self {
        let mut library = Self::default();
        for (_, file) in read_folder(bundled, &mut library.warnings) {
            library
                .components
                .push(Component::from_file(file, Source::Bundled));
        }
        library.add_user(folders);
        library.sort();
        library
    }

    /// The components built into the program, and nothing else.
    pub fn bundled() -> Self {
        let mut library = Self::default();
        library.add_dir(&BUNDLED);
        library.sort();
        library
    }

    /// All components, in the order of the shelf.
    pub fn components(&self) -> &[Component] {
        &self.components
    }

    /// What could not be read, one line each.
    pub fn warnings(&self) -> &[Warning] {
        &self.warnings
    }

    /// The component of that id.
    pub fn get(&self, id: &str) -> Option<&Component> {
        self.components.iter().find(|c| c.id == id)
    }

    /// The categories that hold something, in the order of the shelf, with what they hold.
    pub fn categories(&self) -> impl Iterator<Item = (&str, &[Component])> {
        self.components
            .chunk_by(|a, b| a.category == b.category)
            .map(|c| (c[0].category.as_str(), c))
    }

    /// Puts a component on the shelf, in place of one with the same id.
    pub fn insert(&mut self, component: Component) {
        self.components.retain(|c| c.id != component.id);
        self.components.push(component);
        self.sort();
    }

    /// Takes a component of the user's own off the shelf; its file is kept beside the others as `*.ron.away`, with a
    /// number where there is one, and no longer read. Gives that file, or `None` where the component is not the user's own.
    ///
    /// # Errors
    /// The file cannot be renamed; the component is then on the shelf as before.
    pub fn take_away(&mut self, id: &str) -> Result<Option<PathBuf>, SaveError> {
        let Some(Source::User(path)) = self.get(id).map(|c| &c.source) else {
            return Ok(None);
        };
        let path = path.clone();
        // One of the same name may have been taken away before.
        let named = |n: u32| match n {
            1 => path.with_extension("ron.away"),
            n => path.with_extension(format!("ron.away{n}")),
        };
        let free = (1..).map(named).find(|p| !p.exists());
        let away = free.unwrap_or_else(|| named(1));
        match std::fs::rename(&path, &away) {
            Err(reason) if reason.kind() != std::io::ErrorKind::NotFound => {
                return Err(SaveError::Unwritable { path, reason });
            }
            _ => {}
        }
        self.components.retain(|c| c.id != id);
        Ok(Some(away))
    }

    fn add_dir(&mut self, dir: &Dir<'static>) {
        for entry in dir.entries() {
            match entry {
                DirEntry::Dir(d) => self.add_dir(d),
                DirEntry::File(f) if f.path().extension().is_some_and(|e| e == "ron") => {
                    let text = f.contents_utf8().ok_or((1, "not UTF-8".to_owned()));
                    match text.and_then(parse) {
                        Ok(file) => {
                            let component = Component::from_file(file, Source::Bundled);
                            self.components.push(component);
                        }
                        Err((line, reason)) => self.warnings.push(Warning::Broken {
                            path: f.path().to_owned(),
                            line,
                            reason,
                        }),
                    }
                }
                DirEntry::File(_) => {}
            }
        }
    }

    fn add_user(&mut self, folders: &Folders) {
        let shelf = MeshShelf::new(folders.meshes());
        let mut first = HashMap::new();
        let mut own = Vec::new();
        for (path, file) in read_folder(&folders.components(), &mut self.warnings) {
            if let Some(first) = first.get(&file.id) {
                self.warnings.push(Warning::Duplicate {
                    path,
                    id: file.id,
                    first: std::path::PathBuf::clone(first),
                });
                continue;
            }
            first.insert(file.id.clone(), path.clone());
            let mut component = Component::from_file(file, Source::User(path.clone()));
            let gone = component
                .recipe
                .meshes()
                .into_iter()
                .find(|m| !shelf.has(m));
            if let Some(mesh) = gone {
                component.missing = true;
                self.warnings.push(Warning::MeshGone {
                    path,
                    name: component.name.clone(),
                    mesh: mesh.to_string(),
                });
            }
            own.push(component);
        }
        let replaced: HashSet<&str> = own.iter().map(|c| c.id.as_str()).collect();
        self.components
            .retain(|c| !replaced.contains(c.id.as_str()));
        self.components.extend(own);
    }

    fn sort(&mut self) {
        let order = |c: &Component| {
            let (rank, category) = category_rank(&c.category);
            let own = matches!(c.source, Source::User(_));
            (
                rank,
                category.to_owned(),
                own,
                c.name.to_lowercase(),
                c.id.clone(),
            )
        };
        self.components.sort_by_cached_key(order);
    }
}
