use std::path::{Path, PathBuf};

use anyhow::{Result, anyhow, bail};
use midair_mesh::{check, read};
use serde_json::{Value, json};

use super::say;

pub(super) fn run(files: &[PathBuf], as_json: bool) -> Result<()> {
    let mut faulty = Vec::new();
    let mut all = Vec::new();
    for file in files {
        let (text, value, faults) = if file.extension().is_some_and(|e| e == "midair") {
            document(file)?
        } else {
            mesh(file)?
        };
        if as_json {
            all.push(value);
        } else {
            say(format_args!("{}\n{}", file.display(), text.trim_end()))?;
        }
        if let Some(first) = faults.first() {
            faulty.push(format!("{}: {first}", file.display()));
        }
    }
    if as_json {
        say(serde_json::to_string_pretty(&all)?)?;
    }
    match faulty.len() {
        0 => Ok(()),
        1 => Err(anyhow!(faulty.remove(0))),
        several => bail!("{several} files have faults; the first is {}", faulty[0]),
    }
}

type Checked = (String, Value, Vec<String>);

fn mesh(file: &Path) -> Result<Checked> {
    let read = read(file)?;
    for warning in &read.warnings {
        eprintln!("midair: {warning}");
    }
    let report = check(&read.mesh);
    let faults = report.faults();
    let mut value = serde_json::to_value(&report)?;
    if let Value::Object(map) = &mut value {
        map.insert("file".into(), json!(file));
        map.insert("faults".into(), json!(faults));
        map.insert("faultless".into(), json!(report.is_faultless()));
    }
    Ok((report.to_string(), value, faults))
}

fn document(file: &Path) -> Result<Checked> {
    let opened = midair_document::open(file)?;
    let mut faults = opened.warnings;
    faults.extend(opened.document.check());
    let text = format!(
        "  objects  {}\n  marks    {}\n  meshes   {}\n  step     {} m\n  {}",
        opened.document.len(),
        opened.document.pending().len(),
        opened.document.meshes().len(),
        opened.document.step(),
        if faults.is_empty() {
            "sound".to_owned()
        } else {
            faults.join("\n  ")
        }
    );
    let value = json!({
        "file": file,
        "objects": opened.document.len(),
        "pending": opened.document.pending().len(),
        "meshes": opened.document.meshes().len(),
        "step": opened.document.step(),
        "faults": faults,
        "faultless": faults.is_empty(),
    });
    Ok((text, value, faults))
}
