use std::time::{Duration, Instant};

/// For how long a workload is repeated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Budget {
    /// At least so many runs after the first, which only warms up.
    pub runs: usize,
    /// At least so many seconds.
    pub seconds: f64,
}

impl Default for Budget {
    /// Five runs and one second.
    fn default() -> Self {
        Self {
            runs: 5,
            seconds: 1.0,
        }
    }
}

/// A workload that is over in no time is still not repeated more often than this.
const MOST_RUNS: usize = 2_000;

/// What a workload took, run by run, milliseconds.
#[derive(Clone, Debug, Default)]
pub(crate) struct Times {
    /// The whole, sorted.
    pub total: Vec<f64>,
    /// Its parts by name, each sorted.
    pub parts: Vec<(&'static str, Vec<f64>)>,
}

/// One run: what it took, and its parts.
pub(crate) struct Run<const N: usize> {
    pub total: Duration,
    pub parts: [(&'static str, Duration); N],
}

impl From<Duration> for Run<0> {
    fn from(total: Duration) -> Self {
        Self { total, parts: [] }
    }
}

/// Repeats `work` within the budget; the first run is not counted.
pub(crate) fn repeat<const N: usize, E>(
    budget: &Budget,
    mut work: impl FnMut() -> Result<Run<N>, E>,
) -> Result<Times, E> {
    work()?;
    let started = Instant::now();
    let mut times = Times::default();
    while times.total.len() < budget.runs.max(1)
        || (started.elapsed().as_secs_f64() < budget.seconds && times.total.len() < MOST_RUNS)
    {
        let run = work()?;
        times.total.push(ms(run.total));
        times.parts.resize_with(N, Default::default);
        for (all, (name, one)) in times.parts.iter_mut().zip(run.parts) {
            all.0 = name;
            all.1.push(ms(one));
        }
    }
    let parts = times.parts.iter_mut().map(|(_, all)| all);
    for all in parts.chain([&mut times.total]) {
        all.sort_by(f64::total_cmp);
    }
    Ok(times)
}

/// The time `work` takes; what it makes is dropped afterwards.
pub(crate) fn timed<T>(work: impl FnOnce() -> T) -> Duration {
    let started = Instant::now();
    let made = std::hint::black_box(work());
    let took = started.elapsed();
    drop(made);
    took
}

fn ms(d: Duration) -> f64 {
    d.as_secs_f64() * 1e3
}

/// The middle of sorted values; the mean of the two in the middle where they are even in number.
pub(crate) fn median(sorted: &[f64]) -> f64 {
    let n = sorted.len();
    match n {
        0 => f64::NAN,
        _ => 0.5 * (sorted[(n - 1) / 2] + sorted[n / 2]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_run_is_not_counted() {
        let mut n = 0;
        let budget = Budget {
            runs: 3,
            seconds: 0.0,
        };
        let times = repeat(&budget, || {
            n += 1;
            let part = Duration::from_millis(n);
            Ok::<_, ()>(Run {
                total: 2 * part,
                parts: [("half_ms", part)],
            })
        })
        .unwrap();
        assert_eq!(times.total, [4.0, 6.0, 8.0]);
        assert_eq!(times.parts, [("half_ms", vec![2.0, 3.0, 4.0])]);
        assert_eq!(median(&times.total), 6.0);
        assert_eq!(median(&[1.0, 2.0]), 1.5);
    }
}
