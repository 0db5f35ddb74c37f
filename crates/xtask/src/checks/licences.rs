//! Licences of everything that is compiled into the product or needed to build it.
use super::metadata::{Metadata, Package};
use spdx::{Expression, ParseMode};

/// Licences under which a dependency may be used: permissive ones, and the MPL, which ends at the file. The CDLA is for
/// data: the web's root certificates.
const ALLOWED: [&str; 15] = [
    "0BSD",
    "Apache-2.0",
    "Apache-2.0 WITH LLVM-exception",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "BSL-1.0",
    "CC0-1.0",
    "CDLA-Permissive-2.0",
    "ISC",
    "MIT",
    "MIT-0",
    "MPL-2.0",
    "Unicode-3.0",
    "Unlicense",
    "Zlib",
];

/// One line per dependency whose licence is not allowed, not stated or not readable.
pub(super) fn findings(metadata: &Metadata) -> Vec<String> {
    let all = metadata.closure(metadata.members());
    let others = all.into_iter().filter(|package| !metadata.is_member(package));
    others.filter_map(finding).collect()
}

fn finding(package: &Package) -> Option<String> {
    let Package { name, version, license, .. } = package;
    let Some(license) = license else {
        return Some(format!("dependency `{name}` {version} states no licence expression"));
    };
    match Expression::parse_mode(license, ParseMode::LAX) {
        Ok(expression) if expression.evaluate(|one| ALLOWED.contains(&one.to_string().as_str())) => None,
        Ok(_) => {
            Some(format!("dependency `{name}` {version} has the licence `{license}`; allowed: {}", ALLOWED.join(", ")))
        }
        Err(error) => {
            let reason = error.reason;
            Some(format!("dependency `{name}` {version} has the licence `{license}`: {reason}"))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::metadata::example::metadata;
    use super::*;

    fn verdict(licence: Option<&str>) -> Vec<String> {
        let arrows = [("servobench-base", "middle", None), ("middle", "foreign", None)];
        let others = [("middle", Some("MIT")), ("foreign", licence)];
        findings(&metadata(&["servobench-base"], &others, &arrows))
    }

    #[test]
    fn permissive_expressions_pass() {
        for licence in [
            "MIT",
            "MIT OR Apache-2.0",
            "MIT/Apache-2.0",
            "(MIT OR GPL-3.0-only) AND Unicode-3.0",
            "Apache-2.0 WITH LLVM-exception OR GPL-2.0-only",
        ] {
            assert!(verdict(Some(licence)).is_empty(), "{licence}");
        }
    }

    #[test]
    fn copyleft_is_found_however_deep() {
        for licence in ["GPL-3.0-only", "MIT AND LGPL-2.1-only", "AGPL-3.0-or-later OR SSPL-1.0"] {
            let found = verdict(Some(licence));
            assert_eq!(found.len(), 1, "{licence}");
            assert!(found[0].contains("`foreign` 1.0.0") && found[0].contains(licence), "{found:?}");
        }
    }

    #[test]
    fn an_exception_is_allowed_only_where_it_is_listed() {
        assert_eq!(verdict(Some("MIT WITH LLVM-exception")).len(), 1);
    }

    #[test]
    fn no_licence_and_nonsense_are_found() {
        assert!(verdict(None)[0].contains("states no licence"));
        assert!(verdict(Some("Do What You Like"))[0].contains("`Do What You Like`:"));
    }
}
