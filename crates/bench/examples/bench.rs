//! `midair bench` without the app around it: `bench [NAME...] [--json FILE]`.

use std::error::Error;
use std::io;

use midair_bench::{Budget, report, select};

fn main() -> Result<(), Box<dyn Error>> {
    let mut names = Vec::new();
    let mut json = None;
    let mut args = std::env::args().skip(1);
    while let Some(arg) = args.next() {
        match arg.as_str() {
            "--json" => json = Some(args.next().ok_or("--json needs a file")?),
            _ => names.push(arg),
        }
    }
    let figures = report(
        &select(&names)?,
        &Budget::default(),
        &mut io::stdout().lock(),
    )?;
    if let Some(file) = json {
        std::fs::write(file, serde_json::to_string_pretty(&figures)? + "\n")?;
    }
    Ok(())
}
