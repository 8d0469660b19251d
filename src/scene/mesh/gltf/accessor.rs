//! Accessors: numbers out of buffers, each index checked before it is used.

use glam::DVec3;

use super::document::{Accessor, Document, View};
use super::{EXPORT, QUANTISED, broken, get};
use crate::scene::mesh::{Broken, Result};

/// Most elements that are read from one file, however often it names them.
const MAX_ELEMENTS: usize = 100_000_000;

/// Most elements that no buffer holds: zeros, which cost the file nothing.
const MAX_ZEROS: usize = 1_000_000;

/// The meaning of vectors, on which their form depends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Position,
    Normal,
}

/// The form of a number in a buffer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Component {
    fn new(number: u32) -> Result<Self> {
        Ok(match number {
            5120 => Self::I8,
            5121 => Self::U8,
            5122 => Self::I16,
            5123 => Self::U16,
            5125 => Self::U32,
            5126 => Self::F32,
            _ => return Err(broken(format!("has numbers of type {number}, which does not exist"))),
        })
    }

    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }

    fn is_index(self) -> bool {
        match self {
            Self::U8 | Self::U16 | Self::U32 => true,
            Self::I8 | Self::I16 | Self::F32 => false,
        }
    }

    /// The number in the first bytes, which are there.
    fn read(self, bytes: &[u8], normalized: bool) -> f64 {
        let two = || [bytes[0], bytes[1]];
        let four = || [bytes[0], bytes[1], bytes[2], bytes[3]];
        let (number, largest) = match self {
            Self::I8 => (f64::from(bytes[0] as i8), 127.0),
            Self::U8 => (f64::from(bytes[0]), 255.0),
            Self::I16 => (f64::from(i16::from_le_bytes(two())), 32767.0),
            Self::U16 => (f64::from(u16::from_le_bytes(two())), 65535.0),
            Self::U32 => (f64::from(u32::from_le_bytes(four())), 4_294_967_295.0),
            Self::F32 => (f64::from(f32::from_le_bytes(four())), 1.0),
        };
        if normalized { (number / largest).max(-1.0) } else { number }
    }
}

/// Reads accessors of a file.
pub(super) struct Accessors<'a> {
    document: &'a Document,
    buffers: &'a [Vec<u8>],
    quantised: bool,
    left: usize,
}

impl<'a> Accessors<'a> {
    pub(super) fn new(document: &'a Document, buffers: &'a [Vec<u8>]) -> Self {
        let quantised = document.extensions_required.iter().any(|name| name == QUANTISED);
        Self { document, buffers, quantised, left: MAX_ELEMENTS }
    }

    /// The vectors of an accessor.
    pub(super) fn vectors(&mut self, index: usize, kind: Kind) -> Result<Vec<DVec3>> {
        let accessor = get(&self.document.accessors, index, "accessor")?;
        let component = Component::new(accessor.component_type)?;
        let admitted = match component {
            Component::F32 => true,
            Component::I8 | Component::I16 => self.quantised && (kind == Kind::Position || accessor.normalized),
            Component::U8 | Component::U16 => self.quantised && kind == Kind::Position,
            Component::U32 => false,
        };
        if !admitted || accessor.shape != "VEC3" {
            return Err(unsuitable(
                index,
                accessor,
                "vectors",
                &format!("numbers of this type are read where the file requires `{QUANTISED}`"),
            ));
        }
        let numbers = self.numbers(accessor, index, component, 3)?;
        Ok(numbers.chunks_exact(3).map(DVec3::from_slice).collect())
    }

    /// The indices of an accessor.
    pub(super) fn indices(&mut self, index: usize) -> Result<Vec<usize>> {
        let accessor = get(&self.document.accessors, index, "accessor")?;
        let component = Component::new(accessor.component_type)?;
        if !component.is_index() || accessor.normalized || accessor.shape != "SCALAR" {
            return Err(unsuitable(index, accessor, "indices", EXPORT));
        }
        let numbers = self.numbers(accessor, index, component, 1)?;
        Ok(numbers.into_iter().map(|number| number as usize).collect())
    }

    fn numbers(&mut self, accessor: &Accessor, index: usize, component: Component, width: usize) -> Result<Vec<f64>> {
        let many = |most| Broken::new(format!("has more than {most} vertices, normals and indices"), "simplify it");
        self.left = self.left.checked_sub(accessor.count).ok_or_else(|| many(MAX_ELEMENTS))?;
        let normalized = accessor.normalized;
        let mut numbers = match accessor.buffer_view {
            None if accessor.count > MAX_ZEROS => return Err(many(MAX_ZEROS)),
            None => vec![0.0; accessor.count * width],
            Some(view) => {
                let view = get(&self.document.buffer_views, view, "buffer view")?;
                let run = Run { offset: accessor.byte_offset, count: accessor.count, component, width, normalized };
                self.run(view, view.byte_stride, &run, index)?
            }
        };
        let Some(sparse) = &accessor.sparse else { return Ok(numbers) };
        if sparse.count > accessor.count {
            return Err(broken(format!("replaces more numbers than there are (accessor {index})")));
        }
        let (places, values) = (&sparse.indices, &sparse.values);
        let of_places = Component::new(places.component_type)?;
        if !of_places.is_index() {
            return Err(broken(format!("has sparse indices that are no indices (accessor {index})")));
        }
        let (count, offset) = (sparse.count, places.byte_offset);
        let run = Run { offset, count, component: of_places, width: 1, normalized: false };
        let at = self.run(get(&self.document.buffer_views, places.buffer_view, "buffer view")?, None, &run, index)?;
        let run = Run { offset: values.byte_offset, count, component, width, normalized };
        let new = self.run(get(&self.document.buffer_views, values.buffer_view, "buffer view")?, None, &run, index)?;
        for (at, new) in at.into_iter().zip(new.chunks_exact(width)) {
            let start = (at as usize).saturating_mul(width);
            let old = numbers.get_mut(start..start.saturating_add(width));
            let missing = || broken(format!("replaces number {at} of {} (accessor {index})", accessor.count));
            old.ok_or_else(missing)?.copy_from_slice(new);
        }
        Ok(numbers)
    }

    /// Numbers that stand at equal distances in a view.
    fn run(&self, view: &View, stride: Option<usize>, run: &Run, index: usize) -> Result<Vec<f64>> {
        let outside = || broken(format!("has data outside its buffers (accessor {index})"));
        let buffer = get(self.buffers, view.buffer, "buffer")?;
        let end = view.byte_offset.checked_add(view.byte_length).ok_or_else(outside)?;
        let bytes = buffer.get(view.byte_offset..end).and_then(|bytes| bytes.get(run.offset..)).ok_or_else(outside)?;
        let size = run.component.size();
        let stride = stride.unwrap_or(size * run.width);
        if stride < size * run.width {
            return Err(broken(format!("has elements that overlap (accessor {index})")));
        }
        let before_last = run.count.saturating_sub(1).checked_mul(stride).ok_or_else(outside)?;
        let end = before_last.checked_add(size * run.width).ok_or_else(outside)?;
        if run.count > 0 && end > bytes.len() {
            return Err(outside());
        }
        let mut numbers = Vec::with_capacity(run.count * run.width);
        for element in 0..run.count {
            let bytes = &bytes[element * stride..][..size * run.width];
            numbers.extend(bytes.chunks_exact(size).map(|bytes| run.component.read(bytes, run.normalized)));
        }
        Ok(numbers)
    }
}

/// Numbers in a view.
struct Run {
    offset: usize,
    count: usize,
    component: Component,
    width: usize,
    normalized: bool,
}

fn unsuitable(index: usize, accessor: &Accessor, expected: &str, help: &str) -> Broken {
    let (shape, number) = (accessor.shape.escape_default(), accessor.component_type);
    let normalized = if accessor.normalized { ", normalized" } else { "" };
    let what = format!("has {shape} of type {number}{normalized} where {expected} were expected (accessor {index})");
    Broken::new(what, help)
}
