//! Memory of the machine, as far as this process may use it.
use rustix::process::{Resource, getrlimit};
use std::fs::read_to_string;
use std::path::{Path, PathBuf};

/// Bounds of control groups above this are unlimited: cgroup v1 writes the largest multiple of a page.
const NO_BOUND: u64 = 1 << 62;

/// Keeps `kept` bytes of freed memory for later requests, in pieces of up to `piece` bytes; otherwise it goes back to the system, and is
/// faulted in again page by page.
pub fn keep_freed_memory(kept: i32, piece: i32) {
    #[cfg(target_env = "gnu")]
    #[expect(unsafe_code, reason = "the allocator of the C library has no other door")]
    // SAFETY: it sets two numbers of the allocator. A rejected one leaves it unchanged.
    unsafe {
        libc::mallopt(libc::M_MMAP_THRESHOLD, piece);
        libc::mallopt(libc::M_TRIM_THRESHOLD, kept);
    }
    #[cfg(not(target_env = "gnu"))]
    let _ = (kept, piece);
}

/// Memory that this process and its children may take together (B): that of the machine, of its control groups, and its own limits
/// (`RLIMIT_AS`, `RLIMIT_DATA`), whichever is least; `None` where none is known.
#[must_use]
pub fn memory_of_machine() -> Option<u64> {
    let of_groups = read_to_string("/proc/self/cgroup").ok();
    let of_groups = of_groups.map(|groups| of_control_groups(&groups, Path::new("/sys/fs/cgroup")));
    let ram = read_to_string("/proc/meminfo").ok().and_then(|text| ram(&text));
    let own = [Resource::As, Resource::Data].into_iter().filter_map(|resource| getrlimit(resource).current);
    ram.into_iter().chain(of_groups.flatten()).chain(own).min()
}

/// `MemTotal` of proc_meminfo(5).
fn ram(meminfo: &str) -> Option<u64> {
    let line = meminfo.lines().find_map(|line| line.strip_prefix("MemTotal:"))?;
    let kilobytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kilobytes * 1024)
}

/// The least bound of the groups in `groups` (cgroup(7), `/proc/PID/cgroup`) and of all groups that contain them, mounted at `root`.
///
/// In a container the path may be one of the host, of which the container sees the end only: then the bound is at `root`.
fn of_control_groups(groups: &str, root: &Path) -> Option<u64> {
    groups
        .lines()
        .filter_map(|line| {
            let mut parts = line.splitn(3, ':').skip(1);
            let (controllers, path) = (parts.next()?, parts.next()?);
            let (root, file) = match controllers {
                "" => (root.to_owned(), "memory.max"),
                some if some.split(',').any(|one| one == "memory") => (root.join("memory"), "memory.limit_in_bytes"),
                _ => return None,
            };
            let group: PathBuf = root.join(path.trim_start_matches('/'));
            let all = group.ancestors().take_while(|folder| folder.starts_with(&root));
            all.filter_map(|folder| bound(&folder.join(file))).min()
        })
        .min()
}

/// The bound in `file`; `None` where it is unlimited.
fn bound(file: &Path) -> Option<u64> {
    read_to_string(file).ok()?.trim().parse().ok().filter(|bound| *bound < NO_BOUND)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn ram_is_the_total_of_the_machine() {
        assert_eq!(ram("MemTotal:       16384 kB\nMemFree: 1 kB\n"), Some(1 << 24));
        assert_eq!(ram("MemFree: 1 kB\n"), None);
        assert!(memory_of_machine().is_some_and(|bytes| bytes > 1 << 24));
    }

    #[test]
    fn the_least_bound_of_a_group_and_of_those_above_it_counts() {
        let root = tempfile::tempdir().unwrap();
        let group = root.path().join("user.slice/suite.scope");
        fs::create_dir_all(&group).unwrap();
        let bounds = |own: &str, above: &str| {
            fs::write(group.join("memory.max"), own).unwrap();
            fs::write(root.path().join("user.slice/memory.max"), above).unwrap();
            of_control_groups("0::/user.slice/suite.scope\n", root.path())
        };
        assert_eq!(bounds("3000\n", "max\n"), Some(3000));
        assert_eq!(bounds("3000\n", "2000\n"), Some(2000));
        assert_eq!(bounds("max\n", "max\n"), None);
    }

    #[test]
    fn groups_of_version_1_count_too() {
        let root = tempfile::tempdir().unwrap();
        let group = root.path().join("memory/docker/abc");
        fs::create_dir_all(&group).unwrap();
        fs::write(root.path().join("memory/memory.limit_in_bytes"), "9223372036854771712\n").unwrap();
        fs::write(group.join("memory.limit_in_bytes"), "536870912\n").unwrap();
        let groups = "5:cpu,cpuacct:/docker/abc\n4:memory:/docker/abc\n0::/\n";
        assert_eq!(of_control_groups(groups, root.path()), Some(536_870_912));
        // The container sees its own group as the root.
        fs::write(root.path().join("memory/memory.limit_in_bytes"), "1000\n").unwrap();
        assert_eq!(of_control_groups("4:memory:/not/seen/here\n", root.path()), Some(1000));
    }
}
