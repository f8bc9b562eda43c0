use anyhow::Result;
use midair_library::Library;
use midair_studio::project::Places;

use super::say;

pub(super) fn run(json: bool) -> Result<()> {
    let library = Library::load(&Places::of_user()?.library);
    for warning in library.warnings() {
        eprintln!("midair: {warning}");
    }
    let listing = if json {
        library.to_json()
    } else {
        library.to_text()
    };
    say(listing.trim_end())
}
