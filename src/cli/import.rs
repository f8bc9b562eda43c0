use anyhow::{Result, bail};
use midair_field::bake::Progress;
use midair_library::import_all;
use midair_studio::project::Places;

use super::{Import, say};

pub(super) fn run(args: Import) -> Result<()> {
    let folders = Places::of_user()?.library;
    let progress = Progress::new();
    let mut failures = Vec::new();
    for outcome in import_all(&folders, &args.meshes, args.name.as_deref(), &progress) {
        match outcome {
            Ok(component) => say(format_args!("{}  {}", component.id, component.name))?,
            // The others still go in; each failure is said once.
            Err(error) => failures.push(error.to_string()),
        }
    }
    if let Some(last) = failures.pop() {
        for failure in failures {
            eprintln!("midair: {failure}");
        }
        bail!(last);
    }
    Ok(())
}
