//! The slabs of a picture: where each begins and ends.

/// The places at which slabs begin and end. They are numbers of single precision, so that the CPU and every adapter find
/// a surface in the same slab.
#[derive(Debug, Clone, PartialEq)]
pub struct Stack {
    /// Thickness of each.
    pub thickness: f64,
    /// The depth that the edges are relative to.
    base: f64,
    /// The front of each slab, and the end of the last.
    edges: Vec<f32>,
}

impl Stack {
    /// So many slabs from a depth on, which is relative to a base.
    pub fn new(base: f64, front: f64, thickness: f64, count: usize) -> Self {
        let edge = |index: usize| (front + index as f64 * thickness) as f32;
        Self { thickness, base, edges: (0..=count).map(edge).collect() }
    }

    /// The slabs from the nearest surface to the farthest one, which lies before the end of the last.
    pub fn holding(base: f64, (nearest, farthest): (f32, f32), count: usize) -> Self {
        let (front, back) = (f64::from(nearest), f64::from(farthest));
        let depth = (back - front).max(1e-6 * (base + front).abs().max(1.0));
        let mut stack = Self::new(base, front, depth / count as f64, count);
        if let Some(end) = stack.edges.last_mut() {
            *end = end.max(farthest.next_up());
        }
        stack
    }

    /// The number of slabs.
    pub fn count(&self) -> usize {
        self.edges.len() - 1
    }

    /// The depths at which a slab begins and ends, relative to the base; the next one begins exactly there.
    pub fn slab(&self, index: usize) -> (f64, f64) {
        (self.edges[index].into(), self.edges[index + 1].into())
    }

    /// The depth at which a slab begins.
    pub fn depth(&self, index: usize) -> f64 {
        self.base + f64::from(self.edges[index])
    }

    /// The front of each slab, and the end of the last, relative to the base.
    pub fn edges(&self) -> &[f32] {
        &self.edges
    }

    /// The slab that a surface lies in; the first or the last for surfaces before or behind all.
    pub fn slab_of(&self, depth: f32) -> usize {
        let before = self.edges[..self.count()].partition_point(|edge| *edge <= depth);
        before.saturating_sub(1)
    }
}

#[cfg(test)]
mod tests {
    use super::Stack;

    #[test]
    fn slabs_are_half_open_and_hold_the_farthest_surface() {
        let stack = Stack::holding(7.0, (0.0, 1.0), 4);
        assert_eq!(
            [0.0, 0.2499, 0.2501, 0.99, 1.0, 9.0, -1.0].map(|depth| stack.slab_of(depth)),
            [0, 0, 1, 3, 3, 3, 0]
        );
        assert!(stack.slab(3).1 > 1.0 && stack.depth(0) == 7.0);
        assert_eq!(Stack::new(0.0, 0.0, 0.5, 4).slab_of(0.5), 1);
        // A scene without depth has slabs all the same, and one that is deep has some without any.
        assert_eq!(Stack::holding(1e3, (0.5, 0.5), 3).slab_of(0.5), 0);
        let deep = Stack::holding(0.0, (0.0, 1.0), 1 << 20);
        assert_eq!(deep.slab_of(1.0), (1 << 20) - 1);
    }
}
