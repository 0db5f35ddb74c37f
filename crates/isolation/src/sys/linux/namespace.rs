#![expect(
    unsafe_code,
    reason = "rustix calls what changes namespaces unsafe for the sake of one that is not used here"
)]
//! A PID namespace: a process in it sees no process outside, and all in it end with its first process (pid_namespaces(7)).
use rustix::process::{getgid, getuid};
use rustix::thread::{CapabilitySet, CapabilitySets, UnshareFlags, set_capabilities, unshare_unsafe};
use std::fs;
use std::io;

/// Puts later child processes into a separate PID namespace, if the system allows that; returns true if it did.
///
/// A privileged process does so directly. Others need a user namespace around it (user_namespaces(7)), in which user and group stay
/// unchanged; some systems forbid that, and a process with several threads cannot do it.
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
    // Without a map files would have no owner: capabilities in the new namespace are dropped in any case.
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
