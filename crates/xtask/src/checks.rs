//! Checks that no compiler makes: dependency arrows between the project's crates, licences of all others, left-overs in the text, keys of
//! scenario files in crates below the reader, concepts with two types, the number of packages of the program, calls of the operating system
//! outside of their folders, and counts above their budgets.

mod arrows;
mod budgets;
mod doors;
mod keys;
mod licences;
mod metadata;
mod packages;
mod representations;
mod text;
mod words;

use crate::failure::Failure;
use crate::workspace::Workspace;
use budgets::{Budgets, TABLE};
pub(crate) use metadata::{Metadata, Package};
use packages::Packages;
use std::path::PathBuf;

/// The JSON Schema of scenario files.
const SCHEMA: &str = "docs/scenario.schema.json";

/// Runs every check.
///
/// # Errors
/// [`Failure::Findings`] lists all mistakes, not only the first.
pub(crate) fn run(workspace: &Workspace) -> Result<(), Failure> {
    let metadata = Metadata::read(workspace)?;
    let mut findings = arrows::findings(&metadata);
    findings.extend(licences::findings(&metadata));
    let program = Packages::read(workspace)?;
    findings.extend(program.findings());
    let files = workspace.tracked(&[])?;
    let key_paths = keys::paths(&schema(workspace)?);
    let keyless: Vec<_> = keys::below(&metadata).into_iter().map(|package| source_of(package, workspace)).collect();
    let (mut types, mut budgets) = (Vec::new(), Budgets::default());
    for path in &files {
        // A file other than UTF-8 (pictures, recordings) has no text to check, nor has a deleted one.
        if let Ok(text) = std::fs::read_to_string(workspace.root.join(path)) {
            findings.extend(text::findings(path, &text));
            findings.extend(doors::findings(path, &text));
            types.extend(representations::declared(path, &text));
            budgets.count(path, &text);
            if keyless.iter().any(|source| path.starts_with(source)) {
                findings.extend(keys::findings(path, &text, &key_paths));
            }
        }
    }
    findings.extend(representations::findings(&types));
    let place = workspace.root.join(TABLE);
    let table = std::fs::read_to_string(&place).map_err(Failure::file("read", &place))?;
    if Budgets::are_written() {
        std::fs::write(&place, budgets.written(&table)).map_err(Failure::file("write", &place))?;
    } else {
        findings.extend(budgets.findings(&table));
    }
    if !findings.is_empty() {
        return Err(Failure::Findings { findings });
    }
    println!("{}", budgets.sums());
    println!("nothing found in {} packages and {} files", metadata.count(), files.len());
    println!("packages of the program without the viewer: {}", program.count());
    Ok(())
}

fn schema(workspace: &Workspace) -> Result<serde_json::Value, Failure> {
    let path = workspace.root.join(SCHEMA);
    let text = std::fs::read_to_string(&path).map_err(Failure::file("read", &path))?;
    serde_json::from_str(&text).map_err(|error| Failure::File { what: "read", path, source: error.into() })
}

/// The folder of the package's source, relative to the root of the workspace.
fn source_of(package: &Package, workspace: &Workspace) -> PathBuf {
    let folder = package.manifest_path.parent().unwrap_or(&package.manifest_path);
    folder.strip_prefix(&workspace.root).unwrap_or(folder).join("src")
}
