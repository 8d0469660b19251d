//! What comes back from a frame: how long its passes took, and how many pixels
//! took each case. It is read when the device has it, some frames later, so that
//! nothing waits.

use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};
use std::time::Duration;

use crate::gpu::Gpu;

/// Entries of a palette and counts at most: what a case's number may be, and one for the default.
pub(crate) const CASES: usize = 256;
/// Timestamps: at the beginning of the frame, after the camera's pass, at the end.
const MARKS: u32 = 3;
/// Where counts begin behind the timestamps.
const COUNTS: u64 = wgpu::QUERY_RESOLVE_BUFFER_ALIGNMENT;
const BYTES: u64 = COUNTS + 4 * CASES as u64;

// The states of the buffer that is read.
const FREE: u8 = 0;
const PENDING: u8 = 1;
const READY: u8 = 2;

/// What a frame said.
#[derive(Debug, Clone)]
pub(crate) struct Feedback {
    /// Of the camera's pass and of the one for shadows and light, where the device has a clock.
    pub(crate) times: Option<[Duration; 2]>,
    /// Pixels by case, the default last.
    pub(crate) counts: Vec<u32>,
}

/// Takes it from the device.
pub(crate) struct Collector {
    queries: Option<wgpu::QuerySet>,
    resolved: wgpu::Buffer,
    back: wgpu::Buffer,
    state: Arc<AtomicU8>,
    /// Nanoseconds of a tick.
    period: f64,
}

impl Collector {
    pub(crate) fn new(gpu: &Gpu) -> Self {
        let buffer = |label, usage| {
            let descriptor =
                wgpu::BufferDescriptor { label: Some(label), size: BYTES, usage, mapped_at_creation: false };
            gpu.device.create_buffer(&descriptor)
        };
        let clock = gpu.device.features().contains(wgpu::Features::TIMESTAMP_QUERY);
        let queries = clock.then(|| {
            gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("clock"),
                ty: wgpu::QueryType::Timestamp,
                count: MARKS,
            })
        });
        let resolved = buffer("resolved", wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC);
        let back = buffer("feedback", wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ);
        let period = f64::from(gpu.queue.get_timestamp_period());
        Self { queries, resolved, back, state: Arc::new(AtomicU8::new(FREE)), period }
    }

    /// What the camera's pass, and then the last pass, put into their descriptors.
    pub(crate) fn marks(&self, begin: Option<u32>, end: u32) -> Option<wgpu::RenderPassTimestampWrites<'_>> {
        self.queries.as_ref().map(|query_set| wgpu::RenderPassTimestampWrites {
            query_set,
            beginning_of_pass_write_index: begin,
            end_of_pass_write_index: Some(end),
        })
    }

    /// Records the copies of a frame; returns whether [`Self::submitted`] has to follow. Not every frame is asked.
    pub(crate) fn record(&self, encoder: &mut wgpu::CommandEncoder, counts: &wgpu::Buffer) -> bool {
        if self.state.load(Ordering::Acquire) != FREE {
            return false;
        }
        if let Some(queries) = &self.queries {
            encoder.resolve_query_set(queries, 0..MARKS, &self.resolved, 0);
            encoder.copy_buffer_to_buffer(&self.resolved, 0, &self.back, 0, 8 * u64::from(MARKS));
        }
        encoder.copy_buffer_to_buffer(counts, 0, &self.back, COUNTS, BYTES - COUNTS);
        true
    }

    /// Asks for what was recorded, once it is submitted.
    pub(crate) fn submitted(&self) {
        self.state.store(PENDING, Ordering::Release);
        let state = self.state.clone();
        self.back.map_async(wgpu::MapMode::Read, .., move |mapped| {
            state.store(if mapped.is_ok() { READY } else { FREE }, Ordering::Release);
        });
    }

    /// What has arrived since it was last asked.
    pub(crate) fn take(&self, gpu: &Gpu, how: wgpu::PollType) -> Option<Feedback> {
        gpu.device.poll(how).ok()?;
        if self.state.load(Ordering::Acquire) != READY {
            return None;
        }
        let feedback = self.back.get_mapped_range(..).ok().map(|bytes| {
            let marks: Vec<u64> = bytemuck::pod_collect_to_vec(&bytes[..8 * MARKS as usize]);
            let span = |i: usize| {
                let ticks = marks[i + 1].saturating_sub(marks[i]);
                Duration::from_nanos((ticks as f64 * self.period) as u64)
            };
            Feedback {
                times: self.queries.is_some().then(|| [span(0), span(1)]),
                counts: bytemuck::pod_collect_to_vec(&bytes[COUNTS as usize..]),
            }
        });
        self.back.unmap();
        self.state.store(FREE, Ordering::Release);
        feedback
    }
}
