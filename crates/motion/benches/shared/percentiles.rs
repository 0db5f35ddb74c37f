//! Duration of single calls: a control cycle must bear the slow ones too.
use std::hint::black_box;
use std::time::Instant;

/// Number of times that each input is timed, once in each pass over all of them; the fastest counts, so that interruptions by
/// the system are left out.
const PASSES: usize = 3;

/// The columns of [`row`].
pub(crate) fn header(what: &str) {
    println!("{what:<36} {:>9} {:>9} {:>9} {:>9} {:>9}", "median", "90 %", "99 %", "99.9 %", "most");
}

/// Times `call` (ns) on each input.
pub(crate) fn row<I, T>(name: &str, inputs: &[I], mut call: impl FnMut(&I) -> T) {
    let mut times = vec![u128::MAX; inputs.len()];
    for _ in 0..PASSES {
        for (time, input) in times.iter_mut().zip(inputs) {
            let start = Instant::now();
            black_box(call(black_box(input)));
            *time = start.elapsed().as_nanos().min(*time);
        }
    }
    times.sort_unstable();
    let at = |per_mille: usize| times[(times.len() - 1) * per_mille / 1000];
    println!("{name:<36} {:>9} {:>9} {:>9} {:>9} {:>9}", at(500), at(900), at(990), at(999), at(1000));
}
