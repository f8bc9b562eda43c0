//! Rebuilds the crate when a bundled component is added, changed or taken away.

fn main() {
    println!("cargo::rerun-if-changed=../../assets/components");
}
