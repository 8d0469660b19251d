//! Form factors of polygons by the table `edge_integral`: edges as columns, evaluated together.

use std::f64::consts::TAU;

use super::scalar::{Scalar, Vector, area, middle};
use crate::diag::{Diagnostic, Failure, codes};
use crate::eval::Batch;
use crate::program::Program;
use crate::technique::tables::{EDGE_INTEGRAL, columns};

/// Numbers of an edge: its start, its end, and the normal at the point.
const EDGE: [&str; 9] = ["ux", "uy", "uz", "vx", "vy", "vz", "nx", "ny", "nz"];
/// Numbers of a polygon that is small for its distance: its middle, its normal, and the normal at the point.
const SMALL: [&str; 9] = ["cx", "cy", "cz", "ax", "ay", "az", "nx", "ny", "nz"];

/// Polygons whose form factors are wanted, each a part of some sum.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Sums<T> {
    edges: [Vec<T>; 9],
    /// For each polygon with edges the sum that it belongs to, and its number of edges.
    polygons: Vec<(usize, usize)>,
    far: [Vec<T>; 9],
    /// For each polygon without, the sum that it belongs to.
    far_polygons: Vec<usize>,
    count: usize,
}

impl<T> Default for Sums<T> {
    fn default() -> Self {
        Self {
            edges: std::array::from_fn(|_| Vec::new()),
            polygons: Vec::new(),
            far: std::array::from_fn(|_| Vec::new()),
            far_polygons: Vec::new(),
            count: 0,
        }
    }
}

impl<T: Scalar> Sums<T> {
    /// Begins another sum and returns its number.
    pub(super) fn begin(&mut self) -> usize {
        self.count += 1;
        self.count - 1
    }

    /// Adds a polygon to a sum, as seen from a point with a normal, none of it below the horizon.
    pub(super) fn add(&mut self, sum: usize, corners: &[Vector<T>], normal: Vector<T>) {
        let next = corners.iter().cycle().skip(1);
        for (from, to) in corners.iter().zip(next) {
            push(&mut self.edges, [*from, *to, normal]);
        }
        self.polygons.push((sum, corners.len()));
    }

    /// Adds a polygon that is small for its distance.
    pub(super) fn add_far(&mut self, sum: usize, corners: &[Vector<T>], normal: Vector<T>) {
        push(&mut self.far, [middle(corners), area(corners), normal]);
        self.far_polygons.push(sum);
    }
}

fn push<T: Copy>(columns: &mut [Vec<T>; 9], rows: [Vector<T>; 3]) {
    for (column, number) in columns.iter_mut().zip(rows.as_flattened()) {
        column.push(*number);
    }
}

/// The functions of the table, ready to be evaluated.
#[derive(Debug)]
pub(super) struct Integrals<T> {
    term: Batch<'static, T>,
    small: Batch<'static, T>,
    programs: [&'static Program; 2],
}

impl<T: Scalar> Integrals<T> {
    /// By the table that comes with Umbrage.
    ///
    /// # Errors
    /// Never for that table, which is tested.
    pub(super) fn new() -> Result<Self, Failure> {
        let programs = [EDGE_INTEGRAL.function(T::TERM)?, EDGE_INTEGRAL.function("small")?];
        Ok(Self { term: Batch::new(programs[0]), small: Batch::new(programs[1]), programs })
    }

    /// The form factor of every sum.
    ///
    /// # Errors
    /// Never for the table that comes with Umbrage.
    pub(super) fn evaluate(&mut self, sums: Sums<T>) -> Result<Vec<f64>, Failure> {
        let mut totals = vec![0.0; sums.count];
        let terms = values(&mut self.term, self.programs[0], EDGE, sums.edges)?;
        let mut terms = terms.into_iter();
        for (sum, edges) in sums.polygons {
            // A polygon at a time: for a light that shines from both sides each is as bright as it is large.
            let total = terms.by_ref().take(edges).fold(T::from_f64(0.0), |total, term| total + term);
            totals[sum] += total.to_f64().abs() / TAU;
        }
        let small = values(&mut self.small, self.programs[1], SMALL, sums.far)?;
        for (sum, value) in sums.far_polygons.into_iter().zip(small) {
            totals[sum] += value.to_f64().abs();
        }
        Ok(totals)
    }
}

/// A function of one number at some points, whose columns have the names of its parameters.
///
/// # Errors
/// When it has other parameters.
pub(super) fn values<T: Scalar, const N: usize>(
    batch: &mut Batch<'static, T>,
    program: &Program,
    names: [&str; N],
    numbers: [Vec<T>; N],
) -> Result<Vec<T>, Failure> {
    let columns = columns(program, names, numbers)?;
    let missing = |_| {
        let message = format!("a parameter of `{}` has no value", program.name);
        Failure::bare("tables", Diagnostic::error(codes::NEEDS_FETCH, message))
    };
    Ok(batch.evaluate(&columns).map_err(missing)?.values(0).to_vec())
}
