//! Several jobs at once, results in the order of the jobs.
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

/// Does `work` for every item on at most `workers` threads; which thread does what has no influence on the results.
pub fn for_each_in_parallel<T, R, F>(items: &[T], workers: usize, work: F) -> Vec<R>
where
    T: Sync,
    R: Send,
    F: Fn(usize, &T) -> R + Sync,
{
    let next = AtomicUsize::new(0);
    let done = Mutex::new(Vec::with_capacity(items.len()));
    thread::scope(|scope| {
        for _ in 0..workers.clamp(1, items.len().max(1)) {
            scope.spawn(|| {
                while let index = next.fetch_add(1, Ordering::Relaxed)
                    && let Some(item) = items.get(index)
                {
                    let result = work(index, item);
                    done.lock().unwrap_or_else(std::sync::PoisonError::into_inner).push((index, result));
                }
            });
        }
    });
    let mut done = done.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    done.sort_unstable_by_key(|(index, _)| *index);
    done.into_iter().map(|(_, result)| result).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_stand_in_the_order_of_the_jobs_whatever_the_number_of_workers() {
        let items: Vec<u32> = (0..100).collect();
        for workers in [0, 1, 2, 7, 200] {
            let squares = for_each_in_parallel(&items, workers, |index, item| (index, item * item));
            assert!(squares.iter().enumerate().all(|(i, (index, square))| i == *index && *square == items[i].pow(2)));
        }
        assert!(for_each_in_parallel(&[] as &[u32], 3, |_, item| *item).is_empty());
    }
}
