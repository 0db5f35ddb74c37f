#![expect(
    unsafe_code,
    reason = "rustix calls what changes namespaces unsafe for the sake of one that is not used here"
)]
//! A PID namespace: who is in it sees no process outside, and all in it end with its first process (pid_namespaces(7)).
use rustix::process::{getgid, getuid};
use rustix::thread::{CapabilitySet, CapabilitySets, UnshareFlags, set_capabilities, unshare_unsafe};
use std::fs;
use std::io;

/// From now on what this process forks is in a PID namespace of its own, if the system allows that: whether it does.
///
/// Who may make one at once does so. Everybody else needs a user namespace around it (user_namespaces(7)), in which user and group
/// stay what they are; some systems forbid that, and it cannot be had by a process with several threads.
pub(crate) fn enter() -> bool {
    // SAFETY: file descriptors stay shared.
    if unsafe { unshare_unsafe(UnshareFlags::NEWPID) }.is_ok() {
        return true;
    }
    let (user, group) = (getuid().as_raw(), getgid().as_raw());
    // SAFETY: as above.
    if unsafe { unshare_unsafe(UnshareFlags::NEWUSER | UnshareFlags::NEWPID) }.is_err() {
        return false;
    }
    // Without a map files would belong to nobody: what can be done in the new namespace is given up in any case.
    map(user, group).ok();
    let none = CapabilitySets {
        effective: CapabilitySet::empty(),
        permitted: CapabilitySet::empty(),
        inheritable: CapabilitySet::empty(),
    };
    set_capabilities(None, none).ok();
    true
}

fn map(user: u32, group: u32) -> io::Result<()> {
    fs::write("/proc/self/setgroups", "deny")?;
    fs::write("/proc/self/gid_map", format!("{group} {group} 1"))?;
    fs::write("/proc/self/uid_map", format!("{user} {user} 1"))
}
