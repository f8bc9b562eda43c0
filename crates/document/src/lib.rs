//! The document: a plain value, the edits that change it, and how neither is ever lost.
//!
//! A [`Document`] holds objects; only an [`Edit`] changes it, through a [`History`], which undoes,
//! redoes and writes every committed step to a [`Journal`]. [`save`] and [`open`] are its file,
//! `*.midair`. Lengths are metres.
//!
//! ```
//! use midair_document::{Document, Edit, History, MeshStore, Object};
//! use midair_field::{Placement, Primitive};
//!
//! let mut history = History::new(Document::new(), MeshStore::new());
//! let ball = history.add(Object::solid("Ball", Primitive::Sphere { radius: 0.1 }))?;
//! let placement = Placement::at([0.0, 1.0, 0.0].into());
//! history.apply(Edit::SetPlacement { id: ball, placement })?;
//! assert_eq!(history.undo().as_deref(), Some("Move"));
//! # Ok::<(), midair_document::EditError>(())
//! ```

mod apply;
mod autosave;
mod check;
mod document;
mod drawing;
mod edit;
mod file;
mod history;
mod ids;
mod image_hash;
mod journal;
mod mesh_store;
mod object;
mod recipes;
mod stored;

pub use apply::EditError;
pub use autosave::Autosave;
pub use document::Document;
pub use drawing::{
    ConstructionLine, DrawingFault, DrawnStroke, Kept, LineReading, MAX_POINTS, Relation,
    StrokeReading, Through, affine,
};
pub use edit::Edit;
pub use file::{OpenError, Opened, SaveError, may_save, open, save};
pub use history::{History, InProgress};
pub use ids::{GroupId, LayerId, ObjectId};
pub use image_hash::ImageHash;
pub use journal::{
    Journal, JournalError, MeshSpool, Recoverable, Recovered, Recovery, RecoveryError,
};
pub use mesh_store::MeshStore;
pub use object::{Colour, Dials, Group, Kind, Layer, Link, Object, Reference};
pub use recipes::{RecipeFault, TableError};
pub use stored::{FORMAT, TextError};
