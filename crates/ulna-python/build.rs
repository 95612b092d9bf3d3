//! Hands the examples to the wheel: their files go to the build's output, from where maturin puts them into the package
//! (`[tool.maturin] include`), so that `ulna demo` needs no checkout and git holds them once.

use std::path::{Path, PathBuf};
use std::{env, fs, io};

/// Folders of `examples/`, and what of them is no program.
const FOLDERS: [&str; 2] = ["platinum", "home-built"];
const ENDINGS: [&str; 2] = ["toml", "csv"];

fn main() -> io::Result<()> {
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo names it")).join("examples");
    if out.exists() {
        fs::remove_dir_all(&out)?; // none that is gone from the repository stays
    }
    for folder in FOLDERS {
        println!("cargo::rerun-if-changed={}", examples.join(folder).display());
        fs::create_dir_all(out.join(folder))?;
        for entry in fs::read_dir(examples.join(folder))? {
            let file = entry?.path();
            let ending = file.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
            if ENDINGS.contains(&ending) {
                let name = file.file_name().expect("a file of a folder has a name");
                fs::copy(&file, out.join(folder).join(name))?;
            }
        }
    }
    Ok(())
}
