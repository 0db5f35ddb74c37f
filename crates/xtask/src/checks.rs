//! What no compiler checks: dependency arrows between our crates, licences of all others, left-overs in the text.

mod arrows;
mod licences;
mod metadata;
mod text;

use crate::failure::Failure;
use crate::workspace::Workspace;
pub(crate) use metadata::{Metadata, Package};

/// Runs every check.
///
/// # Errors
/// [`Failure::Findings`] lists everything that is wrong, not only the first.
pub(crate) fn run(workspace: &Workspace) -> Result<(), Failure> {
    let metadata = Metadata::read(workspace)?;
    let mut findings = arrows::findings(&metadata);
    findings.extend(licences::findings(&metadata));
    let files = workspace.tracked(&[])?;
    for path in &files {
        // What is not UTF-8 (pictures, recordings) has no text to check; a deleted file has none either.
        if let Ok(text) = std::fs::read_to_string(workspace.root.join(path)) {
            findings.extend(text::findings(path, &text));
        }
    }
    if !findings.is_empty() {
        return Err(Failure::Findings { findings });
    }
    println!("nothing found in {} packages and {} files", metadata.count(), files.len());
    Ok(())
}
