//! Allowed dependencies among the crates of the workspace. The table is that of `docs/architecture.md`.
use super::metadata::Metadata;

/// Crates that a crate may depend on, without the prefix `servobench-`.
#[derive(Debug)]
enum May {
    /// On these only.
    On(&'static [&'static str]),
    /// On every crate.
    OnAll,
}

/// The layers, lower ones first; `engine-*` is every engine without a separate line. Dev-dependencies are free: the oracle of a test may
/// come from anywhere.
const PLAN: [(&str, May); 41] = [
    ("features", May::On(&[])),
    ("state-derive", May::On(&[])),
    ("base", May::On(&["state-derive"])),
    ("files", May::On(&[])),
    ("config", May::On(&["base"])),
    ("cia402", May::On(&["base"])),
    ("motion", May::On(&["base", "config"])),
    ("planner", May::On(&["base", "config", "motion"])),
    ("drive", May::On(&["base", "config", "cia402", "motion"])),
    ("fieldbus", May::On(&["base", "config", "cia402", "motion"])),
    ("plcopen", May::On(&["base", "config", "fieldbus", "motion"])),
    ("structured-text", May::On(&["base", "config"])),
    ("fmu-file", May::On(&["config"])),
    ("fmi", May::On(&["base", "config", "files", "fmu-file"])),
    ("plant", May::On(&["base", "config", "fmu-file"])),
    ("linear", May::On(&["base"])),
    ("stability", May::On(&["base", "drive", "linear", "plant"])),
    ("sweep", May::On(&["base", "config"])),
    ("advise", May::On(&["motion", "sweep"])),
    ("engine-*", May::On(&["base", "files", "plant"])),
    ("isolation", May::On(&[])),
    ("engine-fmu", May::On(&["base", "plant", "fmi", "isolation"])),
    ("coupling", May::On(&["base", "config"])),
    ("trace", May::On(&["base", "files"])),
    ("signals", May::On(&["base", "plant", "trace"])),
    ("metrics", May::On(&["base", "config", "signals", "trace"])),
    (
        "scenario",
        May::On(&[
            "base", "config", "cia402", "motion", "planner", "drive", "fieldbus", "fmu-file", "plant", "plcopen",
            "coupling", "signals", "metrics", "files", "sweep",
        ]),
    ),
    (
        "sim",
        May::On(&[
            "base",
            "config",
            "cia402",
            "motion",
            "planner",
            "drive",
            "fieldbus",
            "plcopen",
            "plant",
            "linear",
            "stability",
            "fmi",
            "coupling",
            "trace",
            "signals",
            "metrics",
            "scenario",
        ]),
    ),
    (
        "fmu",
        May::On(&[
            "base", "config", "cia402", "motion", "planner", "plcopen", "drive", "plant", "files", "fmi", "signals",
            "scenario", "sim",
        ]),
    ),
    (
        "servobench",
        May::On(&[
            "base",
            "config",
            "drive",
            "engine-rapier",
            "fmu-file",
            "metrics",
            "motion",
            "planner",
            "plant",
            "plcopen",
            "scenario",
            "signals",
            "sim",
            "stability",
            "sweep",
            "trace",
        ]),
    ),
    (
        "suite",
        May::On(&[
            "base",
            "config",
            "files",
            "isolation",
            "planner",
            "plant",
            "servobench",
            "sim",
            "scenario",
            "trace",
            "metrics",
        ]),
    ),
    ("results", May::On(&["base", "files", "trace", "metrics"])),
    (
        "report",
        May::On(&[
            "base", "config", "cia402", "fieldbus", "motion", "planner", "fmi", "signals", "trace", "metrics",
            "results", "sweep", "advise",
        ]),
    ),
    ("view-request", May::On(&["base", "plant", "metrics"])),
    (
        "view",
        May::On(&["base", "plant", "signals", "trace", "metrics", "results", "isolation", "view-request", "features"]),
    ),
    ("cli", May::OnAll),
    ("tests", May::OnAll),
    ("bare-metal", May::On(&["base", "cia402", "motion", "fieldbus", "plcopen"])),
    ("fuzz", May::On(&[])),
    ("testkit", May::On(&[])),
    ("xtask", May::On(&["fuzz", "testkit"])),
];

/// One line per dependency that the plan does not allow.
pub(super) fn findings(metadata: &Metadata) -> Vec<String> {
    let mut findings = Vec::new();
    for from in metadata.members() {
        let Some(plan) = plan(&from.name) else {
            findings.push(format!("crate `{}` is not in the plan of crates", from.name));
            continue;
        };
        let May::On(allowed) = plan else { continue };
        for to in metadata.needs(from).into_iter().filter(|to| metadata.is_member(to)) {
            if !allowed.contains(&short(&to.name)) {
                let list = if allowed.is_empty() { "none".into() } else { allowed.join(", ") };
                let (from, to) = (&from.name, &to.name);
                findings.push(format!("crate `{from}` must not depend on `{to}`; allowed: {list}"));
            }
        }
    }
    findings
}

fn plan(package: &str) -> Option<&'static May> {
    let of_family = |name: &str| name.strip_suffix('*').is_some_and(|family| short(package).starts_with(family));
    let own = PLAN.iter().find(|(name, _)| *name == short(package));
    own.or_else(|| PLAN.iter().find(|(name, _)| of_family(name))).map(|(_, may)| may)
}

fn short(package: &str) -> &str {
    package.strip_prefix("servobench-").unwrap_or(package)
}

#[cfg(test)]
mod tests {
    use super::super::metadata::example::metadata;
    use super::*;

    #[test]
    fn an_arrow_against_the_plan_is_found() {
        let members = ["servobench-base", "servobench-plant", "servobench-drive"];
        let arrows = [("servobench-plant", "servobench-base", None), ("servobench-plant", "servobench-drive", None)];
        let found = findings(&metadata(&members, &[], &arrows));
        let wanted = "crate `servobench-plant` must not depend on `servobench-drive`; allowed: base, config, fmu-file";
        assert_eq!(found, [wanted]);
    }

    #[test]
    fn tests_may_depend_on_anything_and_foreign_crates_are_no_arrows() {
        let arrows = [
            ("servobench-plant", "servobench-drive", Some("dev")),
            ("servobench-plant", "libm", None),
            ("servobench-cli", "servobench-plant", None),
        ];
        let members = ["servobench-plant", "servobench-drive", "servobench-cli"];
        let none: [&str; 0] = [];
        assert_eq!(findings(&metadata(&members, &[("libm", Some("MIT"))], &arrows)), none);
    }

    #[test]
    fn a_build_dependency_counts() {
        let arrows = [("servobench-files", "servobench-plant", Some("build"))];
        let found = findings(&metadata(&["servobench-files", "servobench-plant"], &[], &arrows));
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(found[0].ends_with("allowed: none"), "{found:?}");
    }

    #[test]
    fn a_crate_outside_the_plan_is_found() {
        let found = findings(&metadata(&["servobench-utils"], &[], &[]));
        assert_eq!(found, ["crate `servobench-utils` is not in the plan of crates"]);
    }

    /// A new engine needs no line in the plan; one with more dependencies than the others has a separate line.
    #[test]
    fn every_engine_has_the_arrows_of_its_family() {
        let arrow = |to| [("servobench-engine-new", to, None)];
        let found = |to| findings(&metadata(&["servobench-engine-new", to], &[], &arrow(to)));
        let none: [&str; 0] = [];
        assert_eq!(found("servobench-plant"), none);
        assert_eq!(found("servobench-fmi").len(), 1);
        assert!(matches!(plan("servobench-engine-fmu"), Some(May::On(allowed)) if allowed.contains(&"fmi")));
    }

    #[test]
    fn the_plan_names_the_crates_of_the_architecture_page() {
        let page = std::fs::read_to_string("../../docs/architecture.md").unwrap();
        let rows: Vec<&str> = page.lines().filter(|line| line.starts_with("| `")).collect();
        for (name, _) in PLAN.iter().filter(|(name, _)| *name != "tests") {
            let cell = format!("`{name}`");
            assert!(rows.iter().any(|row| row.contains(&cell)), "no row for {cell}");
        }
    }

    #[test]
    fn the_plan_has_no_circle() {
        let mut below: Vec<&str> = Vec::new();
        for (name, may) in &PLAN {
            if let May::On(allowed) = may {
                let is_of = |name: &str, to: &str| {
                    name == to || name.strip_suffix('*').is_some_and(|family| to.starts_with(family))
                };
                let is_below = |to: &&str| below.iter().any(|name| is_of(name, to));
                assert!(allowed.iter().all(is_below), "`{name}` points upward");
            }
            below.push(name);
        }
    }
}
