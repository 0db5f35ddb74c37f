//! Several jobs at once, results in the order of the jobs; a panic affects its own job only.
use servobench::panicked::{Panicked, caught};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;

/// Bounds on concurrent jobs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AtATime {
    /// Jobs, at least one.
    pub jobs: usize,
    /// Memory of all of them together (bytes); a job that needs more runs alone.
    pub memory: u64,
}

/// Jobs in progress and results.
struct Desk<R> {
    next: usize,
    /// Memory of the jobs in progress (bytes).
    memory: u64,
    done: Vec<(usize, Result<R, Panicked>)>,
}

/// Prepares every item, which yields its memory demand (bytes), and does `work` with it, as many at once as `limit` allows. Distribution
/// over threads and timing have no influence on the results. A panic is the result of its item only.
pub fn map_in_parallel<T, P, R>(
    items: &[T],
    limit: AtATime,
    prepare: impl Fn(&T) -> (P, u64) + Sync,
    work: impl Fn(&T, P) -> R + Sync,
) -> Vec<Result<R, Panicked>>
where
    T: Sync,
    R: Send,
{
    let desk = Mutex::new(Desk { next: 0, memory: 0, done: Vec::with_capacity(items.len()) });
    let returned = Condvar::new();
    thread::scope(|scope| {
        let working = || {
            while let Some((index, item)) = next(items, &desk) {
                let prepared = caught(|| prepare(item));
                let (result, memory) = match prepared {
                    Ok((prepared, memory)) => {
                        let memory = granted(memory, &desk, &returned, limit.memory);
                        (caught(|| work(item, prepared)), memory)
                    }
                    Err(panic) => (Err(panic), 0),
                };
                let mut desk = locked(&desk);
                desk.done.push((index, result));
                desk.memory -= memory;
                drop(desk);
                returned.notify_all();
            }
        };
        let others = 1..limit.jobs.min(items.len());
        // Where the system gives no further thread, the existing ones do all; this one exists in any case.
        others.take_while(|_| thread::Builder::new().spawn_scoped(scope, working).is_ok()).for_each(drop);
        working();
    });
    let mut done = desk.into_inner().unwrap_or_else(PoisonError::into_inner).done;
    done.sort_unstable_by_key(|(index, _)| *index);
    done.into_iter().map(|(_, result)| result).collect()
}

/// The next item and its place.
fn next<'a, T, R>(items: &'a [T], desk: &Mutex<Desk<R>>) -> Option<(usize, &'a T)> {
    let mut desk = locked(desk);
    let index = desk.next;
    desk.next += 1;
    Some((index, items.get(index)?))
}

/// Waits until `memory` is free (bytes), at most the whole of `limit`, which a larger demand gets alone.
fn granted<R>(memory: u64, desk: &Mutex<Desk<R>>, returned: &Condvar, limit: u64) -> u64 {
    let memory = memory.min(limit);
    let mut desk = returned
        .wait_while(locked(desk), |desk| desk.memory.saturating_add(memory) > limit)
        .unwrap_or_else(PoisonError::into_inner);
    desk.memory += memory;
    memory
}

/// The lock is never held while foreign code runs: no change can be left incomplete.
fn locked<R>(desk: &Mutex<Desk<R>>) -> MutexGuard<'_, Desk<R>> {
    desk.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Barrier;
    use std::sync::atomic::{AtomicU64, Ordering};

    fn at_a_time(jobs: usize) -> AtATime {
        AtATime { jobs, memory: 100 }
    }

    #[test]
    fn results_stand_in_the_order_of_the_jobs_whatever_the_number_of_workers() {
        let items: Vec<u32> = (0..100).collect();
        let squares: Vec<_> = items.iter().map(|item| Ok(item * item)).collect();
        for workers in [0, 1, 2, 7, 200] {
            assert_eq!(
                map_in_parallel(&items, at_a_time(workers), |_| ((), 1), |item, ()| item * item),
                squares,
                "{workers}"
            );
        }
        assert!(map_in_parallel(&[] as &[u32], at_a_time(3), |_| ((), 1), |item, ()| *item).is_empty());
    }

    #[test]
    fn a_panic_costs_its_own_item_only() {
        let items: Vec<u32> = (0..20).collect();
        let halves = map_in_parallel(
            &items,
            at_a_time(3),
            |item| (*item, 1),
            |_, item| {
                assert!(item % 5 != 0, "no half of {item}");
                item / 2
            },
        );
        for (item, half) in items.iter().zip(halves) {
            let expected =
                if item % 5 == 0 { Err(Panicked { words: format!("no half of {item}") }) } else { Ok(item / 2) };
            assert_eq!(half, expected);
        }
    }

    #[test]
    fn what_cannot_be_made_ready_is_not_worked_on() {
        let ready = |item: &u32| if *item == 1 { panic!("not ready") } else { (*item, 100) };
        let done = map_in_parallel(&[0, 1, 2], at_a_time(2), ready, |_, item| item);
        assert_eq!(done, [Ok(0), Err(Panicked { words: "not ready".into() }), Ok(2)]);
    }

    /// Items of 30, 60 and 250 bytes of 100: never more than 100 are granted at a time, and all are processed.
    #[test]
    fn the_jobs_under_way_share_the_memory() {
        let items: Vec<u64> = [30, 60, 250].into_iter().cycle().take(60).collect();
        let (in_use, most) = (AtomicU64::new(0), AtomicU64::new(0));
        let done = map_in_parallel(
            &items,
            at_a_time(8),
            |item| ((), *item),
            |item, ()| {
                let granted = (*item).min(100);
                let now = in_use.fetch_add(granted, Ordering::SeqCst) + granted;
                most.fetch_max(now, Ordering::SeqCst);
                thread::yield_now();
                in_use.fetch_sub(granted, Ordering::SeqCst);
            },
        );
        assert_eq!(done.len(), 60);
        assert!(most.load(Ordering::SeqCst) <= 100, "{most:?}");
    }

    /// Two items that fit together run together: each waits for the other.
    #[test]
    fn what_fits_runs_at_once() {
        let both = Barrier::new(2);
        let done = map_in_parallel(&[50, 50], at_a_time(2), |item| ((), *item), |_, ()| both.wait().is_leader());
        assert_eq!(done.iter().filter(|leads| **leads == Ok(true)).count(), 1);
    }
}
