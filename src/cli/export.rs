use std::sync::atomic::AtomicBool;

use anyhow::Result;
use midair_library::Volumes;
use midair_solid::{ExportOptions, Materials, export};
use midair_studio::project::Places;

use super::{Export, open, say};

pub(super) fn run(args: Export) -> Result<()> {
    let (document, store) = open(&args.file)?;
    let library = Places::of_user()?.library;
    let volumes = Volumes::new(&library);
    let meshes = store.clone();
    volumes.add_meshes(move |hash| meshes.get(*hash));
    let options = ExportOptions {
        step: args.step,
        unit: args.unit,
        up: args.up,
        only: None,
        materials: Materials::default().with_folder(&library.materials()),
    };
    let triangles = export(
        &args.to,
        &document,
        &store,
        &volumes,
        &options,
        &AtomicBool::new(false),
    )?;
    say(format_args!("{}: {triangles} triangles", args.to.display()))
}
