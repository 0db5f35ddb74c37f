//! An exported FMU runs on a machine that has nothing installed: what its library asks the dynamic loader for, and its size.
//!
//! Oracle: the file itself, read by the System V ABI ("Dynamic Section") and the Linux Standard Base ("Symbol Versioning").
use servobench_fmi::Version;
use servobench_fmu::{Part, export, library};
use servobench_scenario::load;
use std::path::Path;

/// The C library and what distributions install with it.
const SYSTEM: [&str; 4] = ["ld-linux-x86-64.so.2", "libc.so.6", "libgcc_s.so.1", "libm.so.6"];

/// The oldest C library that exported FMUs run with, as `docs/fmu.md` promises: of 2021.
const GLIBC: [u32; 2] = [2, 34];

/// Largest FMU (bytes).
const MOST: usize = 10_000_000;

/// Types of sections, and tags of the dynamic section.
const SHT_DYNAMIC: u32 = 6;
const SHT_GNU_VERNEED: u32 = 0x6fff_fffe;
const DT_NEEDED: u64 = 1;
const DT_RPATH: u64 = 15;
const DT_RUNPATH: u64 = 29;

/// A shared object of 64 bits, least byte first.
struct Object(Vec<u8>);

/// A section: where it is, and where its names are.
struct Section {
    start: usize,
    length: usize,
    names: usize,
}

impl Object {
    /// The library that was built with this test.
    fn ours() -> Self {
        let object = Self(library(&std::env::current_exe().unwrap()).unwrap());
        assert_eq!(object.0[..6], *b"\x7fELF\x02\x01");
        object
    }

    fn half(&self, at: usize) -> u16 {
        u16::from_le_bytes(self.0[at..at + 2].try_into().unwrap())
    }

    fn word(&self, at: usize) -> u32 {
        u32::from_le_bytes(self.0[at..at + 4].try_into().unwrap())
    }

    fn long(&self, at: usize) -> u64 {
        u64::from_le_bytes(self.0[at..at + 8].try_into().unwrap())
    }

    fn offset(&self, at: usize) -> usize {
        usize::try_from(self.long(at)).unwrap()
    }

    fn text(&self, at: usize) -> &str {
        let text = self.0[at..].split(|byte| *byte == 0).next().unwrap();
        std::str::from_utf8(text).unwrap()
    }

    fn section(&self, kind: u32) -> Section {
        let header = |index: u16| self.offset(0x28) + usize::from(index) * usize::from(self.half(0x3a));
        let found = (0..self.half(0x3c)).map(header).find(|at| self.word(at + 4) == kind).unwrap();
        let names = header(u16::try_from(self.word(found + 40)).unwrap());
        Section { start: self.offset(found + 24), length: self.offset(found + 32), names: self.offset(names + 24) }
    }

    /// Names in the dynamic section that have one of `tags`.
    fn dynamic(&self, tags: &[u64]) -> Vec<&str> {
        let Section { start, length, names } = self.section(SHT_DYNAMIC);
        let entries = (start..start + length).step_by(16).filter(|at| tags.contains(&self.long(*at)));
        entries.map(|at| self.text(names + self.offset(at + 8))).collect()
    }

    /// Versions of symbols that it asks for, each with its library.
    fn versions(&self) -> Vec<(&str, &str)> {
        let Section { start, names, .. } = self.section(SHT_GNU_VERNEED);
        let name = |at: usize| self.text(names + self.word(at) as usize);
        let (mut all, mut need) = (Vec::new(), start);
        loop {
            let mut version = need + self.word(need + 8) as usize;
            for _ in 0..self.half(need + 2) {
                all.push((name(need + 4), name(version + 8)));
                version += self.word(version + 12) as usize;
            }
            match self.word(need + 12) {
                0 => return all,
                next => need += next as usize,
            }
        }
    }
}

#[test]
fn the_library_needs_what_every_system_has() {
    let object = Object::ours();
    let needed = object.dynamic(&[DT_NEEDED]);
    assert!(needed.contains(&"libc.so.6"), "{needed:?}");
    assert!(needed.iter().all(|name| SYSTEM.contains(name)), "{needed:?}");
    assert_eq!(object.dynamic(&[DT_RPATH, DT_RUNPATH]), [""; 0], "folders of the machine that built it");
}

#[test]
fn the_c_library_need_not_be_newer_than_promised() {
    let object = Object::ours();
    let versions = object.versions();
    let numbers = |(_, version): &(&str, &str)| -> Option<Vec<u32>> {
        let numbers = version.strip_prefix("GLIBC_")?.split('.');
        Some(numbers.map(|number| number.parse().unwrap()).collect())
    };
    let newest = versions.iter().filter_map(numbers).max().unwrap();
    assert!(newest[..] <= GLIBC[..], "{newest:?} in {versions:?}");
    let promise = std::fs::read_to_string("../../docs/fmu.md").unwrap();
    assert!(promise.contains(&format!("glibc {}.{}", GLIBC[0], GLIBC[1])), "docs/fmu.md");
}

#[test]
fn an_fmu_is_small() {
    let library = Object::ours().0;
    let loaded = load(Path::new("../../scenarios/plc/figure-3a.toml")).unwrap();
    for version in [Version::Two, Version::Three] {
        for part in [Part::Axis, Part::Drive, Part::Mechanics] {
            let size = export(&loaded, version, part, &library).unwrap().len();
            assert!(size < MOST, "{version:?}, {part:?}: {size} bytes");
        }
    }
}
