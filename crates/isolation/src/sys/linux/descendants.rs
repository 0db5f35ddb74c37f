//! The child processes of a process, and theirs.
use rustix::process::Pid;
use std::collections::HashMap;

/// A process as listed in `/proc` (proc_pid_stat(5)).
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Process {
    pub(crate) id: i32,
    /// The name of its program, 15 bytes of it.
    pub(crate) name: String,
    parent: i32,
    /// True if it has ended, and its parent has not collected its status yet.
    has_ended: bool,
}

/// All running descendants of `of`, in the order of their ids.
pub(crate) fn descendants(of: Pid) -> Vec<Process> {
    let of = of.as_raw_pid();
    let entries = std::fs::read_dir("/proc").into_iter().flatten().flatten();
    let ids = entries.filter_map(|entry| entry.file_name().to_str()?.parse::<i32>().ok());
    let all: Vec<Process> = ids.filter_map(process).collect();
    let parents: HashMap<i32, i32> = all.iter().map(|process| (process.id, process.parent)).collect();
    let is_below = |process: &Process| {
        // At most as many steps as there are processes: entries read one after the other may form a circle.
        let mut above = process.parent;
        for _ in 0..parents.len() {
            if above == of {
                return true;
            }
            let Some(next) = parents.get(&above) else { return false };
            above = *next;
        }
        false
    };
    let mut below: Vec<Process> =
        all.iter().filter(|process| !process.has_ended && is_below(process)).cloned().collect();
    below.sort_by_key(|process| process.id);
    below
}

fn process(id: i32) -> Option<Process> {
    of_stat(id, &String::from_utf8_lossy(&std::fs::read(format!("/proc/{id}/stat")).ok()?))
}

/// `4711 (a name) S 1 …`: the name may contain any character.
fn of_stat(id: i32, stat: &str) -> Option<Process> {
    let (before, after) = stat.rsplit_once(')')?;
    let (_, name) = before.split_once('(')?;
    let mut words = after.split_whitespace();
    let state = words.next()?;
    Some(Process { id, name: name.into(), parent: words.next()?.parse().ok()?, has_ended: matches!(state, "Z" | "X") })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::process::{Command, Stdio};

    #[test]
    fn names_may_have_any_character() {
        let process = of_stat(7, "7 (a) b (c) S 42 7 7 0").unwrap();
        assert_eq!((process.name.as_str(), process.parent, process.has_ended), ("a) b (c", 42, false));
        assert!(of_stat(7, "7 (x) Z 1").unwrap().has_ended);
        assert_eq!(of_stat(7, ""), None);
    }

    #[test]
    fn children_of_children_are_found() {
        let script = "sleep 60 & echo $!; wait";
        let mut child = Command::new("sh").args(["-c", script]).stdout(Stdio::piped()).spawn().unwrap();
        let mut line = String::new();
        std::io::BufRead::read_line(&mut std::io::BufReader::new(child.stdout.take().unwrap()), &mut line).unwrap();
        let grandchild: i32 = line.trim().parse().unwrap();
        let this = rustix::process::getpid();
        let found = descendants(this);
        let ids: Vec<i32> = found.iter().map(|process| process.id).collect();
        assert!(ids.contains(&i32::try_from(child.id()).unwrap()) && ids.contains(&grandchild), "{found:?}");
        assert!(!ids.contains(&this.as_raw_pid()));
        rustix::process::kill_process(Pid::from_raw(grandchild).unwrap(), rustix::process::Signal::KILL).unwrap();
        child.wait().unwrap();
    }
}
