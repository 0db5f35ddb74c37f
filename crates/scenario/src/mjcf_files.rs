//! Files that an MJCF file names: included files, meshes, textures, height fields, other models.
//!
//! The library that compiles such a file opens them itself. Before that, each is checked and hashed here: it has to be a regular file
//! within the root of the scenario. Any attribute that begins with `file` may name a file (`file`, `fileright`, `filename` of URDF), so
//! that unknown elements are covered too. Where the library would search several folders, the candidates in all of them are checked;
//! a file that is in none is reported by the library.
//!
//! Source: MuJoCo documentation, *XML Reference*, `include`, `compiler/meshdir`, `texturedir`, `assetdir`, `strippath`.
use crate::access::{FileAccess, Refused};
use crate::mjcf_size::Size;
use roxmltree::{Document, ParsingOptions};
use servobench_files::{FileRole, XmlBounds, XmlExcess, quoted, with_short_quotes};
use std::collections::{BTreeSet, HashSet};
use std::path::{Path, PathBuf};

/// Largest number of elements of a file: many times those of the largest published models.
const MOST_NODES: u32 = 300_000;
/// Nested elements are bodies of a kinematic chain: the parser recurses into them.
const BOUNDS: XmlBounds = XmlBounds { bytes: 16 << 20, depth: 1000, attributes: 128, attributes_in_all: 1_000_000 };
/// Largest numbers of file names, and of folders that may contain them.
const MOST_NAMES: usize = 10_000;
const MOST_FOLDERS: usize = 16;

/// Attributes of `<compiler>` with a folder for files.
const FOLDERS: [&str; 3] = ["meshdir", "texturedir", "assetdir"];

/// Checks and hashes every file that the MJCF text `xml` at `path` names, and those that these name.
pub(crate) fn look_through(path: &Path, xml: &str, files: &mut FileAccess) -> Result<(), Refused> {
    if files.root().is_none() {
        return Ok(());
    }
    let mut named = Named::default();
    let mut texts: Vec<(PathBuf, std::sync::Arc<str>)> = vec![(path.to_owned(), xml.into())];
    let mut seen: HashSet<PathBuf> = HashSet::new();
    let main = folder_of(path);
    while let Some((path, xml)) = texts.pop() {
        let models = named.add(&path, &xml)?;
        // An included file is in the folder of the main file, or of the file that includes it.
        for model in models {
            for place in [main.join(&model), folder_of(&path).join(&model)] {
                if files.has_file(&place, FileRole::Mjcf)? && seen.insert(place.clone()) {
                    let text = files.text(&place, FileRole::Mjcf)?;
                    texts.push((place, text));
                }
            }
        }
    }
    named.size.hold(path)?;
    for asset in &named.assets {
        let bare = Path::new(asset).file_name().map(PathBuf::from);
        for name in [Some(PathBuf::from(asset)), bare].into_iter().flatten().collect::<BTreeSet<_>>() {
            for place in named.places(&name) {
                if files.has_file(&place, FileRole::MjcfAsset)? {
                    files.look_through(&place, FileRole::MjcfAsset)?;
                }
            }
        }
    }
    Ok(())
}

fn folder_of(path: &Path) -> PathBuf {
    path.parent().unwrap_or_else(|| Path::new("")).to_owned()
}

/// Named files and the folders that may contain them.
#[derive(Default)]
struct Named {
    assets: BTreeSet<String>,
    /// Folders of the MJCF files.
    own: BTreeSet<PathBuf>,
    /// Folders given for meshes and other assets.
    given: BTreeSet<PathBuf>,
    /// Number of elements that the files create.
    size: Size,
}

impl Named {
    /// Adds the files that `xml` names; returns those that are MJCF.
    fn add(&mut self, path: &Path, xml: &str) -> Result<BTreeSet<String>, Refused> {
        let refuse = |message: String| Err(Refused { message, help: "" });
        if let Err(XmlExcess { what, most, .. }) = BOUNDS.hold(xml) {
            return refuse(format!(
                "`{}`: {what} is more than {most}, the most that is read of an MJCF file",
                path.display()
            ));
        }
        // MJCF has no document type declaration, and one could expand a short text to any length.
        let options = ParsingOptions { allow_dtd: false, nodes_limit: MOST_NODES };
        let document = match Document::parse_with_options(xml, options) {
            Ok(document) => document,
            Err(error) => {
                let why = with_short_quotes(&error.to_string());
                return refuse(format!("`{}` is not well-formed XML: {why}", path.display()));
            }
        };
        self.size.add(&document);
        self.own.insert(folder_of(path));
        let mut models = BTreeSet::new();
        for node in document.descendants().filter(roxmltree::Node::is_element) {
            let is_model = matches!(node.tag_name().name(), "include" | "model");
            for attribute in node.attributes() {
                let (key, value) = (attribute.name(), attribute.value());
                if key.starts_with("file") && !value.is_empty() {
                    if value.contains('\0') || value.len() > 4096 {
                        return refuse(format!(
                            "`{}` names a file `{}`, which cannot be the name of a file",
                            path.display(),
                            quoted(value)
                        ));
                    }
                    if is_model {
                        models.insert(value.to_owned())
                    } else {
                        self.assets.insert(value.to_owned())
                    };
                } else if FOLDERS.contains(&key) {
                    self.given.insert(PathBuf::from(value));
                }
            }
        }
        let folders = self.given.len() + self.own.len();
        for (what, count, most) in
            [("files", self.assets.len() + models.len(), MOST_NAMES), ("folders of files", folders, MOST_FOLDERS)]
        {
            if count > most {
                return refuse(format!("`{}` names {count} {what}, at most {most} are allowed", path.display()));
            }
        }
        Ok(models)
    }

    /// Paths at which a file of this name may be.
    fn places(&self, name: &Path) -> impl Iterator<Item = PathBuf> {
        let beside = self.own.iter().map(move |own| own.join(name));
        let given = self.own.iter().flat_map(move |own| self.given.iter().map(move |given| own.join(given).join(name)));
        beside.chain(given).collect::<BTreeSet<_>>().into_iter()
    }
}
