//! The tables that come with Umbrage: one list, each read at most once in a process, whatever directory that runs in.

use std::sync::OnceLock;

use crate::diag::{Diagnostic, Failure, Source, codes};
use crate::eval::{Column, Columns};
use crate::program::{Input, Program, Real};
use crate::table::Table;

/// A table that comes with Umbrage.
#[derive(Debug)]
pub struct BuiltIn {
    /// The table's name.
    pub name: &'static str,
    path: &'static str,
    programs: OnceLock<Result<Vec<Program>, Failure>>,
}

/// The built-in tables by the stems of their files, which are the tables' names, after the files of data beside them.
macro_rules! built_in {
    ([$($data:literal),*] $($(#[$doc:meta])* $table:ident = $name:literal;)*) => {
        $($(#[$doc])* pub static $table: BuiltIn = BuiltIn::new($name, concat!("tables/", $name, ".ron"));)*

        /// Every table that comes with Umbrage.
        pub static ALL: &[&BuiltIn] = &[$(&$table),*];

        /// The text of each of them, and of what they name, by path.
        static TEXTS: &[(&str, &str)] = &[
            $((concat!("tables/", $name, ".ron"), include_str!(concat!("../../tables/", $name, ".ron"))),)*
            $((concat!("tables/", $data), include_str!(concat!("../../tables/", $data))),)*
        ];
    };
}

built_in! {
    [
        "shade_g20.csv", "noise_permutation.csv",
        "ltc_ggx_a.csv", "ltc_ggx_b.csv", "ltc_ggx_c.csv", "ltc_ggx_d.csv", "ltc_ggx_albedo.csv", "ltc_ggx_fresnel.csv"
    ]
    /// Silhouette revectorisation.
    SMSR = "smsr";
    /// Revectorised soft silhouettes.
    RSMSS = "rsmss";
    /// Moments of directions over pieces of the sphere.
    DOUBLE_PRODUCT = "double_product";
    /// Linear approximations of spherical Gaussians.
    SPHERICAL_GAUSSIAN = "spherical_gaussian";
    /// The part of a quadrilateral above the horizon.
    HORIZON_CLIP = "horizon_clip";
    /// The points that an edge adds to a clipped polygon.
    CLIP_STEP = "clip_step";
    /// The edges of a mesh that belong to its silhouette.
    EDGE_SILHOUETTE = "edge_silhouette";
    /// The silhouettes of a box.
    BOX_SILHOUETTE = "box_silhouette";
    /// The light that arrives from a polygon, edge by edge.
    EDGE_INTEGRAL = "edge_integral";
    /// Ways to look for the discontinuities of an edge.
    SEARCH_PLAN = "search_plan";
    /// Configurations of triangles.
    TRIANGLE_CONFIGURATION = "triangle_configuration";
    /// Visible parts of triangles.
    TRIANGLE_REGION = "triangle_region";
    /// Visible parts of triangles with curves of several points.
    TRIANGLE_RAYS = "triangle_rays";
    /// Searches for closest points.
    CLOSEST_POINT_SETUP = "closest_point_setup";
    /// Searches for closest points that are worth beginning.
    CLOSEST_POINT_START = "closest_point_start";
    /// Steps of a search for a closest point.
    CLOSEST_POINT_STEP = "closest_point_step";
    /// Diagonals of quadrilaterals.
    QUAD_DIAGONAL = "quad_diagonal";
    /// Form factors that have closed forms.
    CLOSED_FORMS = "closed_forms";
    /// The matrices of linearly transformed cosines.
    LTC_MATRIX = "ltc_matrix";
    /// The albedos of linearly transformed cosines.
    LTC_ALBEDO = "ltc_albedo";
    /// Places in those two, and what is read there put together.
    LTC = "ltc";
    /// Choices of convolution shadows.
    POLICIES = "policies";
    /// Cases of a slab.
    SLAB = "slab";
    /// Points spread evenly along ellipses.
    ELLIPSE = "ellipse";
    /// Unit kernels and their phases.
    KERNELS = "kernels";
    /// Distant Gaussian lights as blurs, and their shadows in closed form.
    LIGHT_KERNEL = "light_kernel";
    /// Light in a slab of matter.
    SHADE = "shade";
    /// Random numbers.
    PCG = "pcg";
    /// Patterns of space.
    NOISE = "noise";
}

impl BuiltIn {
    const fn new(name: &'static str, path: &'static str) -> Self {
        Self { name, path, programs: OnceLock::new() }
    }

    /// All programs of the table: one, or one per function.
    ///
    /// # Errors
    /// Never for the tables of this module, which are tested.
    pub fn programs(&'static self) -> Result<&'static [Program], Failure> {
        let text = TEXTS.iter().find(|(path, _)| *path == self.path).map_or("", |(_, text)| *text);
        let read = || Program::check_all(&Table::parse_among(Source::new(self.path, text), TEXTS)?);
        self.programs.get_or_init(read).as_deref().map_err(Clone::clone)
    }

    /// The program of a table of cases.
    ///
    /// # Errors
    /// When the table has none.
    pub fn program(&'static self) -> Result<&'static Program, Failure> {
        self.programs()?.first().ok_or_else(|| self.lacks("no cases".to_owned()))
    }

    /// A function of a table of functions.
    ///
    /// # Errors
    /// When there is no such function.
    pub fn function(&'static self, name: &str) -> Result<&'static Program, Failure> {
        let named = |program: &&Program| program.function.as_ref().is_some_and(|function| function.name == name);
        self.programs()?.iter().find(named).ok_or_else(|| self.lacks(format!("no function `{name}`")))
    }

    fn lacks(&self, what: String) -> Failure {
        Failure::bare(self.path, Diagnostic::error(codes::NOT_APPLICABLE, format!("the table has {what}")))
    }
}

/// Points of a program as columns of numbers, each with the name of its input.
///
/// # Errors
/// When the program has other inputs.
pub fn columns<T: Real, const N: usize>(
    program: &Program,
    names: [&str; N],
    mut numbers: [Vec<T>; N],
) -> Result<Columns<T>, Failure> {
    let wrong = |message: String| Failure::bare("tables", Diagnostic::error(codes::NOT_APPLICABLE, message));
    let column = |input: &Input| {
        let place = names.iter().position(|name| *name == input.name)?;
        Some(Column::Numbers { values: std::mem::take(&mut numbers[place]), present: None })
    };
    let columns: Option<Vec<Column<T>>> = program.inputs.iter().map(column).collect();
    let columns = columns.ok_or_else(|| wrong(format!("`{}` has other parameters than {names:?}", program.name)))?;
    Columns::from_columns(program, columns).map_err(|error| wrong(format!("`{}`: {error}", program.name)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_table_is_read_and_has_its_name() {
        for table in ALL {
            let programs = table.programs().unwrap_or_else(|e| panic!("{e}"));
            assert!(
                !programs.is_empty() && programs.iter().all(|program| program.name.starts_with(table.name)),
                "{}",
                table.name
            );
        }
        assert!(SMSR.function("moments").is_err());
    }
}
