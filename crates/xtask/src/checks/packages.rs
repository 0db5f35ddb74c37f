//! Size of the program: number of packages that it is built from.
use crate::failure::Failure;
use crate::workspace::{Workspace, output};
use std::collections::BTreeSet;

/// Most packages of the program, with those of the workspace: it is built within minutes.
const MOST: usize = 290;
/// Prefix of Rerun's packages, which only `servobench-view` has.
const RERUN: &str = "re_";

/// Packages of the program `servobench` on this machine, with the features of a plain build.
#[derive(Debug)]
pub(super) struct Packages(BTreeSet<String>);

impl Packages {
    pub(super) fn read(workspace: &Workspace) -> Result<Self, Failure> {
        let tree = ["tree", "--package", "servobench-cli", "--edges", "normal,build", "--prefix", "none"];
        output(&mut workspace.cargo(tree)).map(|text| Self::of(&text))
    }

    /// Parses lines with name, version, and words in parentheses.
    fn of(tree: &str) -> Self {
        let package = |line: &str| Some(line.split(" (").next()?.trim().to_owned()).filter(|name| !name.is_empty());
        Self(tree.lines().filter_map(package).collect())
    }

    pub(super) fn count(&self) -> usize {
        self.0.len()
    }

    pub(super) fn findings(&self) -> Vec<String> {
        let many = (self.count() > MOST)
            .then(|| format!("`servobench-cli` is built of {} packages; it may have {MOST}", self.count()));
        let of_rerun = self.0.iter().filter(|package| package.starts_with(RERUN));
        many.into_iter().chain(of_rerun.map(|package| format!("`servobench-cli` links {package} of Rerun"))).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_package_counts_once_and_rerun_is_found() {
        let tree = "servobench-cli v0.1.0 (/a b/crates/cli)\nserde v1.0.0\nserde_derive v1.0.0 (proc-macro)\nserde v1.0.0 (*)\n\n";
        let packages = Packages::of(tree);
        assert_eq!((packages.count(), packages.findings().len()), (3, 0));
        let found = Packages::of(&format!("{tree}re_sdk v0.36.3\n")).findings();
        assert_eq!(found, ["`servobench-cli` links re_sdk v0.36.3 of Rerun"]);
        let many: Vec<String> = (0..=MOST).map(|number| format!("crate-{number} v1.0.0")).collect();
        assert_eq!(
            Packages::of(&many.join("\n")).findings(),
            ["`servobench-cli` is built of 291 packages; it may have 290"]
        );
    }
}
