//! Names in an archive.
use crate::error::ArchiveProblem;
use std::collections::HashMap;

/// Names that can all be created within one folder.
#[derive(Debug, Default)]
pub(super) struct Names {
    all: Vec<String>,
    /// Files and folders, including those in between, without a slash at the end.
    known: HashMap<String, Kind>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    File(usize),
    Folder,
}

impl Names {
    /// Adds the name of the next entry; one that ends with a slash is a folder.
    ///
    /// # Errors
    /// The name is not a relative path downwards, or exists already.
    pub(super) fn add(&mut self, name: String) -> Result<(), ArchiveProblem> {
        let refuse = |why| Err(ArchiveProblem::Name { entry: name.escape_debug().to_string(), why });
        if let Some(why) = mistake(&name) {
            return refuse(why);
        }
        let path = direct(&name);
        let kind = if name.ends_with('/') { Kind::Folder } else { Kind::File(self.all.len()) };
        if path.is_empty() {
            // The folder itself.
            self.all.push(name);
            return Ok(());
        }
        for (end, _) in path.match_indices('/') {
            if let Kind::File(_) = self.known.entry(path[..end].to_owned()).or_insert(Kind::Folder) {
                return refuse("has a file of the archive as a folder");
            }
        }
        if let Some(known) = self.known.insert(path.clone(), kind)
            && (kind, known) != (Kind::Folder, Kind::Folder)
        {
            return refuse("is there twice");
        }
        self.all.push(if kind == Kind::Folder { path + "/" } else { path });
        Ok(())
    }

    /// The path of an entry, without detours.
    pub(super) fn name(&self, index: usize) -> &str {
        &self.all[index]
    }

    /// The index of a file's entry.
    pub(super) fn index(&self, file: &str) -> Option<usize> {
        match self.known.get(file)? {
            Kind::File(index) => Some(*index),
            Kind::Folder => None,
        }
    }

    pub(super) fn files(&self) -> impl Iterator<Item = &str> {
        self.all.iter().map(String::as_str).filter(|name| !name.ends_with('/'))
    }
}

/// The direct path of a name, without a slash at its end: `./x` is `x`.
fn direct(name: &str) -> String {
    let parts = name.split('/').filter(|part| !matches!(*part, "" | "."));
    parts.collect::<Vec<_>>().join("/")
}

/// Most parts of a name. All its prefixes are stored.
const DEEPEST: usize = 32;

/// The mistake in a name by itself.
fn mistake(name: &str) -> Option<&'static str> {
    if name.chars().any(char::is_control) {
        return Some("has control characters");
    }
    if name.contains('\\') {
        return Some("has a backslash; the standard separates folders by `/`");
    }
    if name.starts_with('/') || name.as_bytes().get(1) == Some(&b':') {
        return Some("is absolute");
    }
    let path = name.strip_suffix('/').unwrap_or(name);
    if name.ends_with("/.") || name == "." {
        return Some("is that of a folder, without a slash behind it");
    }
    if path.split('/').count() > DEEPEST {
        return Some("has more than 32 folders in each other");
    }
    path.split('/').find_map(|part| match part {
        "" => Some("has a folder without a name"),
        ".." => Some("leads out of its folder"),
        // The limit of most file systems.
        _ if part.len() > 255 => Some("has a part of more than 255 bytes"),
        _ => None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refusal(names: &[&str]) -> Option<&'static str> {
        let mut known = Names::default();
        names.iter().find_map(|name| match known.add((*name).to_owned()) {
            Err(ArchiveProblem::Name { why, .. }) => Some(why),
            _ => None,
        })
    }

    #[test]
    fn what_leads_out_is_refused() {
        for name in [
            "../a",
            "a/../../b",
            "a/..",
            "..",
            ".",
            "a/.",
            "./../a",
            "/a",
            "//a",
            "C:/a",
            "c:a",
            "a//b",
            "",
            "/",
            "a\\..\\b",
            "a\0b",
            "a\nb",
        ] {
            assert!(refusal(&[name]).is_some(), "{name:?}");
        }
        for name in ["a", "a/b/c", "a/", "..a", "a..", ".hidden", "a b/ü.xml", "...", "./a", "a/./b", "./", "./a/"] {
            assert_eq!(refusal(&[name]), None, "{name:?}");
        }
        assert_eq!(refusal(&[&"x".repeat(256)]), Some("has a part of more than 255 bytes"));
    }

    #[test]
    fn a_file_is_no_folder_and_nothing_is_there_twice() {
        assert_eq!(refusal(&["a", "a/b"]), Some("has a file of the archive as a folder"));
        assert_eq!(refusal(&["a/b", "a"]), Some("is there twice"));
        assert_eq!(refusal(&["a/", "a"]), Some("is there twice"));
        assert_eq!(refusal(&["a", "a/"]), Some("is there twice"));
        assert_eq!(refusal(&["a/b", "./a/./b"]), Some("is there twice"));
        assert_eq!(refusal(&["./a", "a/b"]), Some("has a file of the archive as a folder"));
        assert_eq!(refusal(&["a/b", "a/", "a/c"]), None, "folders may be named or not");
    }
}
