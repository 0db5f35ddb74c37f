//! `cargo xtask dist`: one archive that runs after unpacking anywhere.
//!
//! ```text
//! servobench-<version>-<target>/bin/servobench              finds the library by $ORIGIN/../native/lib
//!                              /bin/servobench-view         draws recordings for the Rerun viewer
//!                              /native/lib/libmujoco.so.…
//!                              /lib/libservobench_fmu.so    what goes into exported FMUs
//!                              /share/man/man1              man pages; completions of bash, zsh and fish beside them, where
//!                                                           shells look for those of a prefix such as /usr/local
//!                              /models /scenarios /scenarios-fmu /docs README.md LICENSE-… NOTICE
//!                              /licenses                    of everything that is in the binary
//! ```
use crate::checks::{Metadata, Package};
use crate::failure::Failure;
use crate::wheel;
use crate::workspace::{Workspace, output, run as run_command};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

/// Files tracked by git that are packed beside binary and library.
const TRACKED: [&str; 7] = ["models", "scenarios", "scenarios-fmu", "docs", "README.md", "LICENSE*", "NOTICE"];

/// Builds, packs, unpacks elsewhere and runs the demo there.
///
/// # Errors
/// [`Failure`] of the build, or of the unpacked program, without leaving an archive.
pub(crate) fn run(workspace: &Workspace) -> Result<(), Failure> {
    let library = wheel::MUJOCO.ensure(workspace)?;
    let mut build = workspace.cargo(["build", "--release", "--package", "servobench-cli"]);
    build.args(["--package", "servobench-view", "--package", "servobench-fmu", "--features", "servobench-cli/mujoco"]);
    run_command(&mut build, 0)?;

    let metadata = Metadata::read(workspace)?;
    let cli = metadata.members().find(|package| package.name == "servobench-cli");
    let version = cli.map_or("unknown", |package| &package.version);
    let host = output(&mut workspace.command("rustc", ["--print", "host-tuple"]))?;
    let name = format!("servobench-{version}-{}", host.trim());

    let folder = workspace.target.join("dist");
    fs::create_dir_all(&folder).map_err(Failure::file("create", &folder))?;
    let room = tempfile::tempdir_in(&folder).map_err(Failure::file("write into", &folder))?;
    let root = room.path().join(&name);
    copy(&workspace.binary(), &root.join("bin/servobench"))?;
    copy_into(&workspace.binary().with_file_name("servobench-view"), &root.join("bin"))?;
    copy_into(&library, &root.join("native/lib"))?;
    copy_into(&workspace.binary().with_file_name("libservobench_fmu.so"), &root.join("lib"))?;
    for licence in wheel::MUJOCO.licences(workspace) {
        copy_into(&licence, &root.join("licenses/mujoco"))?;
    }
    for file in workspace.tracked(&TRACKED)? {
        copy(&workspace.root.join(&file), &root.join(&file))?;
    }
    write_share(workspace, &root)?;
    let viewer = metadata.members().find(|package| package.name == "servobench-view");
    let others = metadata.closure(cli.into_iter().chain(viewer));
    let text = licence_texts(others.into_iter().filter(|package| !metadata.is_member(package)));
    let file = root.join("licenses/rust-crates.txt");
    fs::write(&file, text).map_err(Failure::file("write", &file))?;

    let fresh = room.path().join("archive.tar.gz");
    let mut pack = workspace.command("python3", ["-m", "tarfile", "--create"]);
    run_command(pack.arg(&fresh).arg(&name).current_dir(room.path()), 0)?;
    try_out(workspace, &fresh, &name)?;

    let archive = folder.join(format!("{name}.tar.gz"));
    fs::rename(&fresh, &archive).map_err(Failure::file("write", &archive))?;
    println!("{}", archive.display());
    Ok(())
}

/// Completions: shell and file.
const COMPLETIONS: [(&str, &str); 3] = [
    ("bash", "share/bash-completion/completions/servobench"),
    ("zsh", "share/zsh/site-functions/_servobench"),
    ("fish", "share/fish/vendor_completions.d/servobench.fish"),
];

/// Writes man pages and completions, by the program in `root` itself.
fn write_share(workspace: &Workspace, root: &Path) -> Result<(), Failure> {
    let program = |arguments: &[&str]| {
        let mut program = workspace.command(root.join("bin/servobench"), arguments);
        // `cargo run` names folders of the workspace in this variable.
        program.env_remove("LD_LIBRARY_PATH");
        program
    };
    run_command(program(&["man", "--out"]).arg(root.join("share/man/man1")), 0)?;
    for (shell, file) in COMPLETIONS {
        let file = root.join(file);
        let folder = file.parent().unwrap_or(root);
        fs::create_dir_all(folder).map_err(Failure::file("create", folder))?;
        fs::write(&file, output(&mut program(&["completions", shell]))?).map_err(Failure::file("write", &file))?;
    }
    Ok(())
}

/// Unpacks the archive away from the workspace and runs the demo there on MuJoCo, drawn for the viewer: only the packed library and the
/// packed program can serve it.
fn try_out(workspace: &Workspace, archive: &Path, name: &str) -> Result<(), Failure> {
    let temporary = std::env::temp_dir();
    let room = tempfile::tempdir().map_err(Failure::file("write into", temporary))?;
    let mut unpack = workspace.command("python3", ["-m", "tarfile", "--extract"]);
    run_command(unpack.arg(archive).arg(room.path()), 0)?;
    let root = room.path().join(name);
    let mut demo = workspace.command(root.join("bin/servobench"), ["run", "--engine", "mujoco", "--rrd"]);
    demo.arg("--out").arg(room.path().join("out"));
    // `cargo run` names folders of the workspace in this variable.
    run_command(demo.env_remove("LD_LIBRARY_PATH").current_dir(room.path()), 0)
}

/// The licence files of `packages`, each different text once, under the names of those that carry it.
fn licence_texts<'a>(packages: impl Iterator<Item = &'a Package>) -> String {
    let mut listing = String::from("Crates that the programs contain or are built with:\n\n");
    let mut texts: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for package in packages {
        let licence = package.license.as_deref().unwrap_or("see below");
        let _ = writeln!(listing, "{} {}: {licence}", package.name, package.version);
        for file in licence_files(package) {
            // Some crates carry pictures of their licences; only text is copied.
            if let Ok(text) = fs::read_to_string(&file) {
                texts.entry(text).or_default().push(package.name.clone());
            }
        }
    }
    for (text, names) in texts {
        let _ = write!(listing, "\n{:=<80}\n{}\n\n{}\n", "", names.join(", "), text.trim_end());
    }
    listing
}

fn licence_files(package: &Package) -> Vec<PathBuf> {
    let Some(folder) = package.manifest_path.parent() else { return Vec::new() };
    let entries = fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    let is_licence = |path: &PathBuf| {
        let name = path.file_name().unwrap_or_default().to_string_lossy().to_uppercase();
        path.is_file() && ["LICEN", "COPYING", "NOTICE"].iter().any(|start| name.starts_with(start))
    };
    let mut files: Vec<PathBuf> = entries.filter(is_licence).collect();
    files.sort();
    files
}

fn copy_into(file: &Path, folder: &Path) -> Result<(), Failure> {
    copy(file, &folder.join(file.file_name().unwrap_or(file.as_os_str())))
}

/// Copies a file with its mode; makes the folders that it needs.
fn copy(from: &Path, to: &Path) -> Result<(), Failure> {
    if let Some(parent) = to.parent() {
        fs::create_dir_all(parent).map_err(Failure::file("create", parent))?;
    }
    fs::copy(from, to).map(drop).map_err(Failure::file("copy", from))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_that_two_crates_share_is_printed_once_under_both_names() {
        let room = tempfile::tempdir().unwrap();
        let packages = ["alpha", "beta"].map(|name| {
            let folder = room.path().join(name);
            fs::create_dir(&folder).unwrap();
            fs::write(folder.join("LICENSE-MIT"), "do as you like").unwrap();
            fs::write(folder.join("README.md"), "not a licence").unwrap();
            Package {
                name: name.into(),
                version: "1.2.3".into(),
                license: Some("MIT".into()),
                manifest_path: folder.join("Cargo.toml"),
                ..Package::default()
            }
        });
        let text = licence_texts(packages.iter());
        assert!(text.contains("alpha 1.2.3: MIT\nbeta 1.2.3: MIT\n"), "{text}");
        assert_eq!(text.matches("do as you like").count(), 1, "{text}");
        assert!(text.contains("alpha, beta\n"), "{text}");
        assert!(!text.contains("not a licence"), "{text}");
    }
}
