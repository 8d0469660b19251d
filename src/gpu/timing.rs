//! Times on a device: a stopwatch for passes, a protocol that
//! makes times comparable, and what may be said about their differences.
//!
//! ```text
//! let watch = Stopwatch::new(&gpu);
//! let times = interleaved(Protocol { warm_up: 3, rounds: 20 }, shaders.len(), |i| {
//!     watch.time(|encoder, marks| {
//!         let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
//!             label: None,
//!             timestamp_writes: marks.compute(),
//!         });
//!         shaders[i].dispatch(&mut pass);
//!     })
//! })?;
//! if times[0].differs_from(&times[1]) { .. times[0].median() .. }
//! ```
//!
//! A pass that takes less than some hundred microseconds should dispatch its
//! work several times, or the clock's own grain is measured.

use std::fmt;
use std::time::{Duration, Instant};

use super::Gpu;
use crate::diag::Failure;

/// The clock that a time was taken with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Clock {
    /// The device's own timestamps at both ends of the pass.
    Timestamps,
    /// The computer's clock, from submitting to being done: it contains the way there and back.
    Wall,
}

impl fmt::Display for Clock {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Clock::Timestamps => "timestamp queries",
            Clock::Wall => "wall clock",
        })
    }
}

/// Measures single passes on a device.
#[derive(Debug)]
pub struct Stopwatch<'g> {
    gpu: &'g Gpu,
    queries: Option<Queries>,
}

#[derive(Debug)]
struct Queries {
    set: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    back: wgpu::Buffer,
    /// Nanoseconds of one tick.
    period: f64,
}

const BYTES: u64 = 2 * wgpu::QUERY_SIZE as u64;

/// The timestamps that a measured pass puts into its descriptor.
#[derive(Debug)]
pub(crate) struct Marks<'a> {
    set: Option<&'a wgpu::QuerySet>,
}

impl<'a> Marks<'a> {
    /// For a pass that is not measured.
    pub(crate) fn none() -> Self {
        Self { set: None }
    }

    /// For a compute pass.
    pub(crate) fn compute(&self) -> Option<wgpu::ComputePassTimestampWrites<'a>> {
        self.set.map(|query_set| wgpu::ComputePassTimestampWrites {
            query_set,
            beginning_of_pass_write_index: Some(0),
            end_of_pass_write_index: Some(1),
        })
    }

    /// For the first and the last of several compute passes that are measured together.
    #[cfg(feature = "render")]
    pub(crate) fn span(&self) -> [Option<wgpu::ComputePassTimestampWrites<'a>>; 2] {
        [(Some(0), None), (None, Some(1))].map(|(start, end)| {
            self.set.map(|query_set| wgpu::ComputePassTimestampWrites {
                query_set,
                beginning_of_pass_write_index: start,
                end_of_pass_write_index: end,
            })
        })
    }

    /// For a render pass.
    #[cfg(feature = "render")]
    pub(crate) fn render(&self) -> Option<wgpu::RenderPassTimestampWrites<'a>> {
        self.set.map(|query_set| wgpu::RenderPassTimestampWrites {
            query_set,
            beginning_of_pass_write_index: Some(0),
            end_of_pass_write_index: Some(1),
        })
    }
}

impl<'g> Stopwatch<'g> {
    /// With timestamps if the device has them, else with the wall clock.
    ///
    /// Software rasterisers count as having none. Mesa's (22.3) takes both timestamps of a
    /// compute pass after the pass, so that every pass takes some microseconds.
    pub fn new(gpu: &'g Gpu) -> Self {
        if gpu.is_software() || !gpu.device.features().contains(wgpu::Features::TIMESTAMP_QUERY) {
            return Self::wall(gpu);
        }
        let buffer = |usage| {
            gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("timestamps"),
                size: BYTES,
                usage,
                mapped_at_creation: false,
            })
        };
        let queries = Queries {
            set: gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("timestamps"),
                ty: wgpu::QueryType::Timestamp,
                count: 2,
            }),
            resolved: buffer(wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC),
            back: buffer(wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST),
            period: f64::from(gpu.queue.get_timestamp_period()),
        };
        Self { gpu, queries: Some(queries) }
    }

    /// With the wall clock.
    pub fn wall(gpu: &'g Gpu) -> Self {
        Self { gpu, queries: None }
    }

    /// The clock that times are taken with.
    pub fn clock(&self) -> Clock {
        if self.queries.is_some() { Clock::Timestamps } else { Clock::Wall }
    }

    /// Submits what `record` records and measures the pass in it that carries the marks.
    ///
    /// # Errors
    /// When the device fails.
    pub(crate) fn time(&self, record: impl FnOnce(&mut wgpu::CommandEncoder, &Marks<'_>)) -> Result<Duration, Failure> {
        let gpu = self.gpu;
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let Some(queries) = &self.queries else {
            record(&mut encoder, &Marks::none());
            let commands = encoder.finish();
            let start = Instant::now();
            gpu.queue.submit([commands]);
            gpu.wait()?;
            return Ok(start.elapsed());
        };
        record(&mut encoder, &Marks { set: Some(&queries.set) });
        encoder.resolve_query_set(&queries.set, 0..2, &queries.resolved, 0);
        encoder.copy_buffer_to_buffer(&queries.resolved, 0, &queries.back, 0, BYTES);
        gpu.queue.submit([encoder.finish()]);
        let ticks = gpu.read_back(&queries.back, |bytes| {
            let [start, end] = [0, 8].map(|at| bytes[at..].first_chunk().map_or(0, |b| u64::from_le_bytes(*b)));
            // A driver may restart its counter between the two.
            end.saturating_sub(start)
        })?;
        Ok(Duration::from_nanos((ticks as f64 * queries.period) as u64))
    }
}

/// The number of measurements.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Protocol {
    /// Rounds before the first that counts: clocks rise, caches fill, pipelines are compiled.
    pub warm_up: usize,
    /// Rounds that count.
    pub rounds: usize,
}

/// Measures several subjects in turn, each once a round, so that what slows
/// the machine down for a while slows all of them down. Every round starts
/// with another subject, so that none always follows the same one.
///
/// # Errors
/// With the first error of `measure`.
pub fn interleaved<E>(
    protocol: Protocol,
    subjects: usize,
    mut measure: impl FnMut(usize) -> Result<Duration, E>,
) -> Result<Vec<Times>, E> {
    let mut times = vec![Vec::with_capacity(protocol.rounds); subjects];
    for round in 0..protocol.warm_up + protocol.rounds {
        for step in 0..subjects {
            let subject = (round + step) % subjects;
            let time = measure(subject)?;
            if round >= protocol.warm_up {
                times[subject].push(time);
            }
        }
    }
    Ok(times.into_iter().map(Times::new).collect())
}

/// Several measurements of the same thing.
#[derive(Debug, Clone, PartialEq)]
pub struct Times {
    /// In seconds, ascending.
    sorted: Vec<f64>,
}

impl Times {
    /// Of these measurements.
    pub fn new(times: impl IntoIterator<Item = Duration>) -> Self {
        let mut sorted: Vec<f64> = times.into_iter().map(|time| time.as_secs_f64()).collect();
        sorted.sort_by(f64::total_cmp);
        Self { sorted }
    }

    /// Their number.
    pub fn count(&self) -> usize {
        self.sorted.len()
    }

    /// The value below which the given share of the measurements lies, in seconds; NaN without any.
    pub fn quantile(&self, share: f64) -> f64 {
        let Some(last) = self.sorted.len().checked_sub(1) else { return f64::NAN };
        let place = share.clamp(0.0, 1.0) * last as f64;
        let below = place.floor() as usize;
        let above = (below + 1).min(last);
        self.sorted[below] + (self.sorted[above] - self.sorted[below]) * (place - below as f64)
    }

    /// The median, in seconds.
    pub fn median(&self) -> f64 {
        self.quantile(0.5)
    }

    /// The middle half's width relative to the median.
    pub fn spread(&self) -> f64 {
        (self.quantile(0.75) - self.quantile(0.25)) / self.median()
    }

    /// The uncertainty of the median, in seconds: about half the width of its 95 %
    /// confidence interval (the notch of a box plot, McGill, Tukey and Larsen 1978).
    pub fn uncertainty(&self) -> f64 {
        1.57 * (self.quantile(0.75) - self.quantile(0.25)) / (self.sorted.len() as f64).sqrt()
    }

    /// Returns whether two medians differ by more than noise.
    pub fn differs_from(&self, other: &Times) -> bool {
        (self.median() - other.median()).abs() > self.uncertainty() + other.uncertainty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn times(milliseconds: &[u64]) -> Times {
        Times::new(milliseconds.iter().map(|ms| Duration::from_millis(*ms)))
    }

    #[test]
    fn quantiles_lie_between_measurements() {
        let times = times(&[4, 1, 3, 2]);
        assert!((times.median() - 0.0025).abs() < 1e-12);
        assert!((times.quantile(0.0) - 0.001).abs() < 1e-12);
        assert!((times.quantile(1.0) - 0.004).abs() < 1e-12);
        assert!(Times::new([]).median().is_nan());
    }

    #[test]
    fn overlapping_measurements_do_not_differ() {
        assert!(!times(&[10, 11, 12, 13, 14]).differs_from(&times(&[11, 12, 13, 14, 15])));
        assert!(times(&[10, 10, 11, 11, 11]).differs_from(&times(&[20, 20, 21, 21, 21])));
    }

    #[test]
    fn every_round_starts_with_another_subject() {
        let mut order = Vec::new();
        let protocol = Protocol { warm_up: 1, rounds: 2 };
        let times = interleaved(protocol, 3, |subject| {
            order.push(subject);
            Ok::<_, ()>(Duration::from_secs(subject as u64))
        });
        assert_eq!(order, [0, 1, 2, 1, 2, 0, 2, 0, 1]);
        let medians: Vec<f64> = times.iter().flatten().map(Times::median).collect();
        assert_eq!(medians, [0.0, 1.0, 2.0]);
    }
}
