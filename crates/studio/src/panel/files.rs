//! Choosing files: one dialog for opening, saving and bringing in.

use std::path::PathBuf;

use bevy_egui::egui::{Context, Rect, Vec2};
use egui_file_dialog::FileDialog;

use crate::command::{Command, Dialog};
use crate::project::{Project, Then};

/// Endings of the pictures that can be worked from.
pub const PICTURES: [&str; 3] = ["png", "jpg", "jpeg"];
/// What a window has around its content, in points.
const FRAME: Vec2 = Vec2::splat(34.0);

/// The dialog, and what is asked with it.
#[derive(Default)]
pub struct Files {
    open: Option<(Dialog, FileDialog)>,
    /// Where one was last.
    folder: Option<PathBuf>,
    /// What the dialog fills, in points: a panel of its own in a room; `None` as a window on a screen.
    fills: Option<Rect>,
}

impl Files {
    /// Dialogs that fill a part of a panel, in points.
    pub fn filling(part: Rect) -> Self {
        Self {
            fills: Some(part),
            ..Self::default()
        }
    }

    /// Whether one is open.
    pub fn is_open(&self) -> bool {
        self.open.is_some()
    }

    /// What is asked.
    pub fn title(&self) -> &'static str {
        match &self.open {
            Some((dialog, _)) => title(*dialog),
            None => "Files",
        }
    }

    /// Gives the question up.
    pub fn close(&mut self) {
        self.open = None;
    }

    /// Asks for a file.
    pub fn ask(&mut self, dialog: Dialog, project: &Project) {
        let folder = self
            .folder
            .clone()
            .or_else(|| project.path().and_then(|p| p.parent()).map(Into::into))
            .unwrap_or_else(|| project.work_folder().to_owned());
        // A folder that is not there yet is nothing to look into.
        let folder = folder
            .ancestors()
            .find(|f| f.is_dir())
            .map_or_else(|| PathBuf::from("."), Into::into);
        let base = FileDialog::new()
            .title(title(dialog))
            .initial_directory(folder);
        let base = match self.fills {
            None => base.as_modal(true),
            Some(part) => base
                .as_modal(false)
                .fixed_pos(part.min)
                .default_size(part.size() - FRAME)
                .min_size(part.size() - FRAME)
                .max_size(part.size() - FRAME)
                .title_bar(false)
                .movable(false),
        };
        let mut shown = match dialog {
            Dialog::Open => base
                .add_file_filter_extensions("Midair documents", vec!["midair"])
                .default_file_filter("Midair documents"),
            Dialog::Import => base
                .add_file_filter_extensions(
                    "Meshes: GLB, OBJ, STL, PLY",
                    vec!["glb", "gltf", "obj", "stl", "ply"],
                )
                .default_file_filter("Meshes: GLB, OBJ, STL, PLY"),
            Dialog::Reference => base
                .add_file_filter_extensions("Pictures: PNG, JPEG", PICTURES.into())
                .default_file_filter("Pictures: PNG, JPEG"),
            Dialog::SaveAs => base.default_file_name(&format!("{}.midair", project.title())),
        };
        match dialog {
            Dialog::Open => shown.pick_file(),
            Dialog::Import | Dialog::Reference => shown.pick_multiple(),
            Dialog::SaveAs => shown.save_file(),
        }
        self.open = Some((dialog, shown));
    }

    /// Draws the dialog where it is open, and says what was chosen.
    pub fn show(&mut self, ctx: &Context) -> Option<Command> {
        let (dialog, shown) = self.open.as_mut()?;
        shown.update(ctx);
        let chosen = match dialog {
            Dialog::Import | Dialog::Reference => shown.take_picked_multiple(),
            Dialog::Open | Dialog::SaveAs => shown.take_picked().map(|p| vec![p]),
        };
        let closed = *shown.state() != egui_file_dialog::DialogState::Open;
        let dialog = *dialog;
        if closed || chosen.is_some() {
            self.open = None;
        }
        let mut chosen = chosen.filter(|c| !c.is_empty())?;
        self.folder = chosen[0].parent().map(Into::into);
        Some(match dialog {
            Dialog::Open => Command::Leave(Then::Open(chosen.swap_remove(0))),
            Dialog::Import => Command::Import(chosen),
            Dialog::Reference => Command::Reference {
                paths: chosen,
                at: None,
            },
            Dialog::SaveAs => {
                let path = chosen.swap_remove(0);
                Command::SaveAs(if has_ending(&path, &["midair"]) {
                    path
                } else {
                    let mut name = path.into_os_string();
                    name.push(".midair");
                    name.into()
                })
            }
        })
    }
}

fn title(dialog: Dialog) -> &'static str {
    match dialog {
        Dialog::Open => "Open a document",
        Dialog::SaveAs => "Save the document as",
        Dialog::Import => "Bring meshes into the library",
        Dialog::Reference => "Pictures to work from",
    }
}

/// Whether a file's name ends in one of `endings`, in upper or lower case.
pub fn has_ending(file: &std::path::Path, endings: &[&str]) -> bool {
    file.extension()
        .is_some_and(|e| endings.iter().any(|ending| e.eq_ignore_ascii_case(ending)))
}
