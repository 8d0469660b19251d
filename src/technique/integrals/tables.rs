//! The tables that the demonstration evaluates, over columns.

use glam::DVec3;

use super::Lobe;
use super::cells::{Cell, Edge};
use crate::diag::{Diagnostic, Failure, codes};
use crate::eval::{Batch, Columns, Results};
use crate::program::Program;
use crate::technique::Inputs;
use crate::technique::tables::{DOUBLE_PRODUCT, SPHERICAL_GAUSSIAN, columns};

/// The names of the numbers of the function of moments: ∫∫ ω, then ∫∫ ω ω.
const MOMENTS: [&str; 9] = ["mx", "my", "mz", "mxx", "mxy", "myy", "mxz", "myz", "mzz"];

/// The functions that are evaluated.
#[derive(Debug)]
pub struct Tables {
    moments: &'static Program,
    /// The index of each of [`MOMENTS`] among the numbers that the function returns.
    order: [usize; 9],
    alpha: &'static Program,
    beta: &'static Program,
    #[cfg(feature = "gpu")]
    interval: &'static Program,
}

/// The integrals of direction, and of direction times direction, over the area that belongs to an edge.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Moments {
    /// x, y, z
    pub first: DVec3,
    /// xx, xy, yy, xz, yz, zz
    pub second: [f64; 6],
}

/// A lobe in a cell as `alpha + beta * (axis . direction)`.
type Line = (f64, f64);

impl Tables {
    /// The tables that come with Umbrage.
    ///
    /// # Errors
    /// Never for these tables, which are tested.
    pub fn new() -> Result<Self, Failure> {
        let (double, gaussian) = (&DOUBLE_PRODUCT, &SPHERICAL_GAUSSIAN);
        let moments = double.function("moments")?;
        let numbers = moments.output.components();
        let mut order = [0; 9];
        for (place, wanted) in order.iter_mut().zip(MOMENTS) {
            let Some(index) = numbers.iter().position(|number| number.name.eq_ignore_ascii_case(wanted)) else {
                let message = format!("`moments` returns no `{wanted}`");
                return Err(Failure::bare(double.name, Diagnostic::error(codes::NOT_APPLICABLE, message)));
            };
            *place = index;
        }
        let alpha = gaussian.function("alpha")?;
        let beta = gaussian.function("beta")?;
        #[cfg(feature = "gpu")]
        let interval = gaussian.function("interval")?;
        Ok(Self {
            moments,
            order,
            alpha,
            beta,
            #[cfg(feature = "gpu")]
            interval,
        })
    }

    /// Points of a program from one row of numbers each, in the order of these names.
    fn columns<const N: usize>(
        program: &Program,
        names: [&str; N],
        rows: impl Iterator<Item = [f64; N]>,
    ) -> Result<Columns<f32>, Failure> {
        let mut numbers: [Vec<f32>; N] = std::array::from_fn(|_| Vec::with_capacity(rows.size_hint().0));
        for row in rows {
            numbers.iter_mut().zip(row).for_each(|(column, number)| column.push(number as f32));
        }
        columns(program, names, numbers)
    }

    /// No inputs yet, of moments, alpha and beta.
    pub(super) fn nothing<'p>(&self) -> Vec<Inputs<'p>> {
        let none = |program| Inputs { program, columns: Columns::new(program), pixels: Vec::new() };
        [self.moments, self.alpha, self.beta].map(none).into()
    }

    /// The inputs of alpha and beta: of all lobes in all cells, cell by cell.
    pub(super) fn line_inputs(&self, cells: &[Cell], lobes: &[Lobe]) -> Result<Columns<f32>, Failure> {
        // The largest value is 1; colours are applied later.
        let rows = cells
            .iter()
            .flat_map(|cell| lobes.iter().zip(&cell.ranges).map(|(lobe, (a, b))| [1.0, lobe.sharpness, *a, *b]));
        Self::columns(self.alpha, ["mu", "lambda", "a", "b"], rows)
    }

    /// The linear approximations at such inputs.
    pub(super) fn lines(
        &self,
        interpreters: &mut Interpreters<'_>,
        columns: &Columns<f32>,
    ) -> Result<Vec<Line>, Failure> {
        let alpha = evaluate(&mut interpreters.alpha, columns)?;
        let beta = evaluate(&mut interpreters.beta, columns)?;
        let lines = alpha.values(0).iter().zip(beta.values(0));
        Ok(lines.map(|(alpha, beta)| (f64::from(*alpha), f64::from(*beta))).collect())
    }

    /// The inputs of the moments of all edges.
    pub(super) fn moment_inputs(&self, edges: &[Edge]) -> Result<Columns<f32>, Failure> {
        let names = ["phi0", "phi1", "theta0", "theta_a", "theta_b"];
        let rows = edges.iter().map(|edge| {
            let [a, b] = edge.ends;
            [a.x, b.x, edge.theta, a.y, b.y]
        });
        Self::columns(self.moments, names, rows)
    }

    /// The moments at such inputs.
    pub(super) fn moments(
        &self,
        interpreters: &mut Interpreters<'_>,
        columns: &Columns<f32>,
    ) -> Result<Vec<Moments>, Failure> {
        let results = evaluate(&mut interpreters.moments, columns)?;
        let number = |which: usize, edge: usize| f64::from(results.values(self.order[which])[edge]);
        Ok((0..columns.len())
            .map(|edge| Moments {
                first: DVec3::new(number(0, edge), number(1, edge), number(2, edge)),
                second: std::array::from_fn(|i| number(3 + i, edge)),
            })
            .collect())
    }

    /// The moments of pieces.
    #[cfg(feature = "gpu")]
    pub(super) fn moments_of_pieces(&self) -> &Program {
        self.moments
    }

    /// The functions of a shader that divides the directions by itself.
    #[cfg(feature = "gpu")]
    pub(super) fn for_shaders(&self) -> [&Program; 4] {
        [self.moments, self.alpha, self.beta, self.interval]
    }

    /// Interpreters for the functions.
    pub(super) fn interpreters(&self) -> Interpreters<'_> {
        Interpreters { moments: Batch::new(self.moments), alpha: Batch::new(self.alpha), beta: Batch::new(self.beta) }
    }
}

/// Interpreters for the functions, which keep what they have specialised.
#[derive(Debug)]
pub(super) struct Interpreters<'t> {
    moments: Batch<'t, f32>,
    alpha: Batch<'t, f32>,
    beta: Batch<'t, f32>,
}

fn evaluate(batch: &mut Batch<'_, f32>, columns: &Columns<f32>) -> Result<Results<f32>, Failure> {
    batch.evaluate(columns).map_err(|_| missing())
}

fn missing() -> Failure {
    Failure::bare("tables", Diagnostic::error(codes::NEEDS_FETCH, "a parameter of a function has no value"))
}

impl Moments {
    /// The vector M n.
    pub fn times(&self, n: DVec3) -> DVec3 {
        let [xx, xy, yy, xz, yz, zz] = self.second;
        DVec3::new(xx * n.x + xy * n.y + xz * n.z, xy * n.x + yy * n.y + yz * n.z, xz * n.x + yz * n.y + zz * n.z)
    }
}
