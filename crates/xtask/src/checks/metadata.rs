//! Packages and their dependencies from `cargo metadata`.
use crate::failure::Failure;
use crate::workspace::{Workspace, output, parse};
use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

/// The packages of a build with all features on this machine's platform.
#[derive(Debug, Default, Deserialize)]
pub(crate) struct Metadata {
    packages: Vec<Package>,
    workspace_members: BTreeSet<String>,
    resolve: Resolve,
}

/// One package.
#[derive(Debug, Default, Clone, Deserialize)]
pub(crate) struct Package {
    /// Cargo's identifier.
    pub(crate) id: String,
    /// Name.
    pub(crate) name: String,
    /// Version.
    pub(crate) version: String,
    /// Licence expression.
    pub(crate) license: Option<String>,
    /// Its `Cargo.toml`.
    pub(crate) manifest_path: PathBuf,
}

#[derive(Debug, Default, Deserialize)]
struct Resolve {
    nodes: Vec<Node>,
}

#[derive(Debug, Default, Deserialize)]
struct Node {
    id: String,
    deps: Vec<Arrow>,
}

#[derive(Debug, Default, Deserialize)]
struct Arrow {
    pkg: String,
    dep_kinds: Vec<Kind>,
}

#[derive(Debug, Default, Deserialize)]
struct Kind {
    /// None for a normal dependency, else `build` or `dev`.
    kind: Option<String>,
}

impl Metadata {
    /// Runs `cargo metadata` with all features for the platform of this machine.
    pub(crate) fn read(workspace: &Workspace) -> Result<Self, Failure> {
        let mut rustc = workspace.command("rustc", ["--print", "host-tuple"]);
        let host = output(&mut rustc)?;
        let mut cargo = workspace.cargo(["metadata", "--format-version", "1", "--all-features"]);
        cargo.args(["--filter-platform", host.trim()]);
        let text = output(&mut cargo)?;
        parse(&cargo, &text)
    }

    /// The packages of the workspace.
    pub(crate) fn members(&self) -> impl Iterator<Item = &Package> {
        self.packages.iter().filter(|package| self.is_member(package))
    }

    /// Number of packages, those of the workspace and others.
    pub(crate) fn count(&self) -> usize {
        self.packages.len()
    }

    /// True if `package` belongs to the workspace.
    pub(crate) fn is_member(&self, package: &Package) -> bool {
        self.workspace_members.contains(&package.id)
    }

    /// Normal and build dependencies of `package`, without those of its tests.
    pub(crate) fn needs(&self, package: &Package) -> Vec<&Package> {
        let node = self.resolve.nodes.iter().find(|node| node.id == package.id);
        let arrows = node.map_or(&[][..], |node| &node.deps);
        let counts = |kind: &Kind| kind.kind.as_deref() != Some("dev");
        arrows
            .iter()
            .filter(|arrow| arrow.dep_kinds.iter().any(counts))
            .filter_map(|arrow| self.packages.iter().find(|p| p.id == arrow.pkg))
            .collect()
    }

    /// `roots` and everything that they need, directly or not, in the order of name and version.
    pub(crate) fn closure<'a>(&'a self, roots: impl Iterator<Item = &'a Package>) -> Vec<&'a Package> {
        let mut found = BTreeMap::new();
        let mut open: Vec<&Package> = roots.collect();
        while let Some(package) = open.pop() {
            if found.insert((&package.name, &package.version, &package.id), package).is_none() {
                open.extend(self.needs(package));
            }
        }
        found.into_values().collect()
    }
}

#[cfg(test)]
pub(super) mod example {
    //! Metadata for the tests of the checks.
    use super::{Arrow, Kind, Metadata, Node, Package};

    /// Members by name, others by name and licence, arrows by name and kind.
    pub(in crate::checks) fn metadata(
        members: &[&str],
        others: &[(&str, Option<&str>)],
        arrows: &[(&str, &str, Option<&str>)],
    ) -> Metadata {
        let mut metadata = Metadata::default();
        let all = members.iter().map(|&name| (name, None)).chain(others.iter().copied());
        for (name, license) in all {
            let deps = arrows.iter().filter(|(from, _, _)| *from == name);
            metadata.resolve.nodes.push(Node {
                id: name.into(),
                deps: deps
                    .map(|(_, to, kind)| Arrow {
                        pkg: (*to).into(),
                        dep_kinds: vec![Kind { kind: kind.map(Into::into) }],
                    })
                    .collect(),
            });
            metadata.packages.push(Package {
                id: name.into(),
                name: name.into(),
                version: "1.0.0".into(),
                license: license.map(Into::into),
                ..Package::default()
            });
        }
        metadata.workspace_members = members.iter().map(|&name| name.into()).collect();
        metadata
    }
}
