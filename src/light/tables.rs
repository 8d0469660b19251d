//! The tables that the demonstration evaluates, over columns.

use glam::DVec3;

use super::Lobe;
use super::cells::{Cell, Edge};
use crate::diag::{Diagnostic, Failure, Source, codes};
#[cfg(feature = "gpu")]
use crate::emit::harness::Entry;
use crate::eval::{Batch, Columns};
#[cfg(feature = "gpu")]
use crate::gpu::{Gpu, Kernel, Language};
#[cfg(feature = "gpu")]
use crate::plan::{Plan, Shape};
use crate::program::{Program, Value};
use crate::table::Table;

/// What the function of moments calls its numbers: ∫∫ ω, then ∫∫ ω ω.
const MOMENTS: [&str; 9] = ["mx", "my", "mz", "mxx", "mxy", "myy", "mxz", "myz", "mzz"];

/// The functions that are evaluated.
#[derive(Debug)]
pub struct Tables {
    moments: Program,
    /// Where each of [`MOMENTS`] is among the numbers that the function returns.
    order: [usize; 9],
    alpha: Program,
    beta: Program,
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

fn function(source: &'static str, text: &'static str, name: &str) -> Result<Program, Failure> {
    let all = Program::check_all(&Table::parse(Source::new(source, text))?)?;
    let named = |program: &Program| program.function.as_ref().is_some_and(|function| function.name == name);
    all.into_iter().find(named).ok_or_else(|| {
        Failure::bare(source, Diagnostic::error(codes::NOT_APPLICABLE, format!("the table has no function `{name}`")))
    })
}

impl Tables {
    /// The tables that come with Umbrage.
    ///
    /// # Errors
    /// Never for these tables, which are tested.
    pub fn new() -> Result<Self, Failure> {
        let double = ("tables/double_product.ron", include_str!("../../tables/double_product.ron"));
        let gaussian = ("tables/spherical_gaussian.ron", include_str!("../../tables/spherical_gaussian.ron"));
        let moments = function(double.0, double.1, "moments")?;
        let names: Vec<String> = match &moments.output {
            crate::program::Output::Record(names) => names.iter().map(|name| name.to_ascii_lowercase()).collect(),
            _ => Vec::new(),
        };
        let mut order = [0; 9];
        for (place, wanted) in order.iter_mut().zip(MOMENTS) {
            let Some(index) = names.iter().position(|name| name == wanted) else {
                let message = format!("`moments` returns no `{wanted}`");
                return Err(Failure::bare(double.0, Diagnostic::error(codes::NOT_APPLICABLE, message)));
            };
            *place = index;
        }
        let alpha = function(gaussian.0, gaussian.1, "alpha")?;
        let beta = function(gaussian.0, gaussian.1, "beta")?;
        Ok(Self { moments, order, alpha, beta })
    }

    /// Points of a program from one row of numbers each, in the order of its inputs.
    fn columns<const N: usize>(
        program: &Program,
        names: [&str; N],
        rows: impl Iterator<Item = [f64; N]>,
    ) -> Result<Columns<f32>, Failure> {
        let place = |name: &str| {
            program.input(name).ok_or_else(|| {
                let message = format!("`{}` has no parameter `{name}`", program.name);
                Failure::bare("tables", Diagnostic::error(codes::NOT_APPLICABLE, message))
            })
        };
        let places = names.iter().map(|name| place(name)).collect::<Result<Vec<_>, _>>()?;
        let mut columns = Columns::new(program);
        let mut point: Vec<Option<Value>> = vec![None; program.inputs.len()];
        for row in rows {
            for (place, number) in places.iter().zip(row) {
                point[place.index()] = Some(Value::Number(number));
            }
            columns
                .push(&point)
                .map_err(|error| Failure::bare("tables", Diagnostic::error(codes::BAD_COLUMN, format!("{error:?}"))))?;
        }
        Ok(columns)
    }

    /// The linear approximations of all lobes in all cells, cell by cell.
    pub(super) fn lines(
        &self,
        machine: &mut Machine<'_, '_>,
        cells: &[Cell],
        lobes: &[Lobe],
    ) -> Result<Vec<Line>, Failure> {
        // The largest value is 1; colours are applied later.
        let rows = cells
            .iter()
            .flat_map(|cell| lobes.iter().zip(&cell.ranges).map(|(lobe, (a, b))| [1.0, lobe.sharpness, *a, *b]));
        let columns = Self::columns(&self.alpha, ["mu", "lambda", "a", "b"], rows)?;
        let alpha = machine.evaluate(Which::Alpha, &columns)?;
        let beta = machine.evaluate(Which::Beta, &columns)?;
        let wide = |column: &[f32]| column.iter().map(|v| f64::from(*v)).collect::<Vec<f64>>();
        Ok(wide(&alpha[0]).into_iter().zip(wide(&beta[0])).collect())
    }

    /// The moments of all edges.
    pub(super) fn moments(&self, machine: &mut Machine<'_, '_>, edges: &[Edge]) -> Result<Vec<Moments>, Failure> {
        let names = ["phi0", "phi1", "theta0", "theta_a", "theta_b"];
        let rows = edges.iter().map(|edge| {
            let [a, b] = edge.ends;
            [a.x, b.x, edge.theta, a.y, b.y]
        });
        let columns = Self::columns(&self.moments, names, rows)?;
        let results = machine.evaluate(Which::Moments, &columns)?;
        let number = |which: usize, edge: usize| f64::from(results[self.order[which]][edge]);
        Ok((0..edges.len())
            .map(|edge| Moments {
                first: DVec3::new(number(0, edge), number(1, edge), number(2, edge)),
                second: std::array::from_fn(|i| number(3 + i, edge)),
            })
            .collect())
    }

    #[cfg(feature = "gpu")]
    fn program(&self, which: Which) -> &Program {
        match which {
            Which::Moments => &self.moments,
            Which::Alpha => &self.alpha,
            Which::Beta => &self.beta,
        }
    }

    /// The functions as shaders on a device.
    ///
    /// # Errors
    /// When the device refuses them.
    #[cfg(feature = "gpu")]
    pub fn on<'t>(&'t self, gpu: &'t Gpu) -> Result<Shaders<'t>, Failure> {
        let kernel = |which: Which| {
            let proved = Plan::proved(self.program(which), Shape::Ladder)?;
            Kernel::new(gpu, &proved, Entry::Levels, Language::Wgsl)
        };
        Ok(Shaders { moments: kernel(Which::Moments)?, alpha: kernel(Which::Alpha)?, beta: kernel(Which::Beta)? })
    }
}

/// One of the functions.
#[derive(Debug, Clone, Copy)]
enum Which {
    Moments,
    Alpha,
    Beta,
}

/// The functions as shaders.
#[cfg(feature = "gpu")]
#[derive(Debug)]
pub struct Shaders<'t> {
    moments: Kernel<'t, 't>,
    alpha: Kernel<'t, 't>,
    beta: Kernel<'t, 't>,
}

/// What evaluates the tables.
#[derive(Debug)]
pub enum Executor<'t> {
    /// The batch interpreter.
    Interpreter,
    /// Shaders made from the tables.
    #[cfg(feature = "gpu")]
    Shaders(Box<Shaders<'t>>),
    /// What is not there, as no device is.
    #[cfg(not(feature = "gpu"))]
    Shaders(std::convert::Infallible, std::marker::PhantomData<&'t ()>),
}

/// An executor at work: batch interpreters keep what they have specialised.
pub(super) enum Machine<'a, 't> {
    /// Moments, alpha, beta.
    Batches(Box<[Batch<'t, f32>; 3]>),
    #[cfg(feature = "gpu")]
    Shaders(&'a Shaders<'t>),
    #[cfg(not(feature = "gpu"))]
    Shaders(std::convert::Infallible, std::marker::PhantomData<&'a ()>),
}

impl<'t> Executor<'t> {
    pub(super) fn machine<'a>(&'a self, tables: &'t Tables) -> Machine<'a, 't> {
        match self {
            Executor::Interpreter => {
                Machine::Batches(Box::new([&tables.moments, &tables.alpha, &tables.beta].map(Batch::new)))
            }
            #[cfg(feature = "gpu")]
            Executor::Shaders(shaders) => Machine::Shaders(shaders),
            #[cfg(not(feature = "gpu"))]
            Executor::Shaders(never, _) => match *never {},
        }
    }
}

impl Machine<'_, '_> {
    /// One column per number that the function returns.
    fn evaluate(&mut self, which: Which, columns: &Columns<f32>) -> Result<Vec<Vec<f32>>, Failure> {
        match self {
            Machine::Batches(batches) => {
                let results = batches[which as usize].evaluate(columns).map_err(|_| missing())?;
                Ok((0..results.components()).map(|component| results.values(component).to_vec()).collect())
            }
            #[cfg(feature = "gpu")]
            Machine::Shaders(shaders) => {
                let kernel = match which {
                    Which::Moments => &shaders.moments,
                    Which::Alpha => &shaders.alpha,
                    Which::Beta => &shaders.beta,
                };
                Ok(kernel.run(columns)?.values)
            }
            #[cfg(not(feature = "gpu"))]
            Machine::Shaders(never, _) => match *never {},
        }
    }
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
