use super::*;
use crate::samples;
use std::fs;

fn suite() -> Suite {
    Suite::new(
        Digest::of(b"suite"),
        vec!["run".into(), "a b.toml".into()],
        "/µ".into(),
        None,
        vec!["jerk.exact".into()],
    )
}

fn finished() -> Vec<Finished> {
    let runs = [samples::jerk(), samples::missed(), samples::broken()].into_iter().enumerate();
    runs.map(|(index, result)| Finished { index, seconds: 0.25, result }).collect()
}

/// The journal at `path`, and every record in it.
fn resumed(path: &Path) -> Result<(Journal, Suite, Vec<Finished>), JournalError> {
    let mut all = Vec::new();
    let (journal, suite) = Journal::resume(path.to_owned(), |one, _| all.push(one))?;
    Ok((journal, suite, all))
}

/// A journal of three runs, and its bytes.
fn written(path: &Path) -> Vec<u8> {
    let mut journal = Journal::create(path.to_owned(), &suite()).unwrap();
    for one in finished() {
        journal.append(&one).unwrap();
    }
    fs::read(path).unwrap()
}

#[test]
fn it_reads_back_and_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("results.journal");
    written(&path);
    let (mut journal, read_suite, before) = resumed(&path).unwrap();
    assert_eq!((read_suite, &before), (suite(), &finished()));
    let again = Finished { index: 1, seconds: 3.0, result: samples::kept() };
    let place = journal.append(&again).unwrap();
    assert_eq!(journal.at(place).unwrap(), again);
    assert_eq!(resumed(&path).unwrap().2, [before, vec![again]].concat());
}

/// A record is read from its place, and later records are still written to the end.
#[test]
fn a_record_is_read_from_its_place() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("results.journal");
    written(&path);
    let mut places = Vec::new();
    let (mut journal, _) = Journal::resume(path.clone(), |one, place| places.push((one, place))).unwrap();
    for round in 0..2 {
        for (one, place) in places.iter().rev() {
            assert_eq!(&journal.at(*place).unwrap(), one, "{round}");
        }
        let next = Finished { index: 3 + round, ..finished().remove(0) };
        places.push((next.clone(), journal.append(&next).unwrap()));
    }
    assert_eq!(resumed(&path).unwrap().2.len(), 5);
    // A bit of it flips on the disk.
    let mut bytes = fs::read(&path).unwrap();
    let end = bytes.len() - 20;
    bytes[end] ^= 1;
    fs::write(&path, bytes).unwrap();
    let why = journal.at(places[4].1).unwrap_err().to_string();
    assert!(why.contains("has changed since it was written"), "{why}");
    journal.at(places[3].1).unwrap();
}

#[cfg(unix)]
#[test]
fn a_link_in_its_place_is_replaced_and_not_followed() {
    let folder = tempfile::tempdir().unwrap();
    let (link, victim) = (folder.path().join("results.journal"), folder.path().join("victim"));
    fs::write(&victim, "victim").unwrap();
    std::os::unix::fs::symlink(&victim, &link).unwrap();
    written(&link);
    assert!(!link.is_symlink());
    assert_eq!(fs::read(victim).unwrap(), b"victim");
}

/// After any byte at which a write stops, the records before it are there, and later ones follow.
#[test]
fn a_journal_that_is_cut_off_keeps_what_is_whole() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("results.journal");
    let whole = written(&path);
    let ends: Vec<usize> = (1..=whole.len()).filter(|end| whole[end - 1] == b'\n').collect();
    assert_eq!(ends.len(), 4);
    for length in (0..whole.len()).step_by(7).chain(ends.iter().flat_map(|end| end - 1..=(end + 1).min(whole.len()))) {
        let records = ends.iter().filter(|end| **end <= length).count();
        fs::write(&path, &whole[..length]).unwrap();
        let Ok((mut journal, _, before)) = resumed(&path) else {
            assert_eq!(records, 0, "{length}");
            continue;
        };
        assert_eq!(before, finished()[..records - 1], "{length}");
        journal.append(&finished()[2]).unwrap();
        assert_eq!(resumed(&path).unwrap().2.last(), finished().last(), "{length}");
    }
}

/// One flipped bit anywhere costs only the record that contains it.
#[test]
fn a_damaged_record_is_one_that_is_not_there() {
    let whole = written(&tempfile::tempdir().unwrap().path().join("results.journal"));
    let first = whole.iter().position(|byte| *byte == b'\n').unwrap();
    for at in (0..whole.len()).step_by(5) {
        let mut damaged = whole.clone();
        damaged[at] ^= 4;
        let mut records = Vec::new();
        let suite = read(&damaged[..], Path::new("x"), |one, _| records.push(one));
        if at <= first {
            assert!(matches!(suite, Err(JournalError::NoSuite(_))), "{at}");
        } else {
            suite.unwrap();
            assert!(!records.is_empty() && records.len() < 3, "{at}: {}", records.len());
            assert!(records.iter().all(|record| finished().contains(record)), "{at}");
        }
    }
}

/// The sender of a folder may have written anything into its journal.
#[test]
fn a_journal_that_leads_outside_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("results.journal");
    let names = ["../a.parquet", "/etc/passwd", "b/a.parquet", "..", "", "a\\b.parquet", "results.json", "a.toml"];
    let mut told = 0;
    for name in names {
        for of_recording in [true, false] {
            let mut journal = Journal::create(path.clone(), &suite()).unwrap();
            let mut hostile = finished().remove(0);
            if of_recording {
                hostile.result.recording = Some(name.into());
            } else {
                hostile.result.files.push(name.into());
            }
            journal.append(&hostile).unwrap();
            journal.append(&finished()[1]).unwrap();
            let refusal = Journal::resume(path.clone(), |_, _| told += 1).unwrap_err();
            assert!(matches!(&refusal, JournalError::Outside { name: found, .. } if found == name), "{refusal}");
        }
    }
    assert_eq!(told, 0);
    for stem in ["../a", "/a", "a/b"] {
        Journal::create(path.clone(), &Suite { stems: vec![stem.into()], ..suite() }).unwrap();
        assert!(matches!(resumed(&path), Err(JournalError::Outside { .. })), "{stem}");
    }
}

/// Records would be appended to the target of the link.
#[cfg(unix)]
#[test]
fn a_journal_that_is_a_link_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let (link, other) = (folder.path().join("results.journal"), folder.path().join("other"));
    let before = written(&other);
    std::os::unix::fs::symlink(&other, &link).unwrap();
    let refusal = resumed(&link).unwrap_err().to_string();
    assert!(refusal.contains("is a link to another file"), "{refusal}");
    assert_eq!(fs::read(other).unwrap(), before);
}

#[test]
fn a_later_version_is_refused_by_its_number() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("results.journal");
    Journal::create(path.clone(), &Suite { version: 2, ..suite() }).unwrap();
    let refusal = resumed(&path).unwrap_err().to_string();
    assert!(refusal.ends_with("has version 2, newer than this build, which reads version 1"), "{refusal}");
}
