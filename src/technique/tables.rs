//! The tables that come with Umbrage: one list, each read at most once in a process.

use std::sync::OnceLock;

use crate::diag::{Diagnostic, Failure, Source, codes};
use crate::program::Program;
use crate::table::Table;

/// A table that comes with Umbrage.
#[derive(Debug)]
pub struct BuiltIn {
    /// The table's name.
    pub name: &'static str,
    path: &'static str,
    text: &'static str,
    programs: OnceLock<Result<Vec<Program>, Failure>>,
}

/// A built-in table by the stem of its file, which is the table's name.
macro_rules! built_in {
    ($name:literal) => {
        BuiltIn::new($name, concat!("tables/", $name, ".ron"), include_str!(concat!("../../tables/", $name, ".ron")))
    };
}

/// Silhouette revectorisation.
pub static SMSR: BuiltIn = built_in!("smsr");
/// Revectorised soft silhouettes.
pub static RSMSS: BuiltIn = built_in!("rsmss");
/// Moments of directions over pieces of the sphere.
pub static DOUBLE_PRODUCT: BuiltIn = built_in!("double_product");
/// Linear approximations of spherical Gaussians.
pub static SPHERICAL_GAUSSIAN: BuiltIn = built_in!("spherical_gaussian");
/// The part of a quadrilateral above the horizon.
pub static HORIZON_CLIP: BuiltIn = built_in!("horizon_clip");
/// The points that an edge adds to a clipped polygon.
pub static CLIP_STEP: BuiltIn = built_in!("clip_step");
/// The edges of a mesh that belong to its silhouette.
pub static EDGE_SILHOUETTE: BuiltIn = built_in!("edge_silhouette");
/// The silhouettes of a box.
pub static BOX_SILHOUETTE: BuiltIn = built_in!("box_silhouette");
/// The light that arrives from a polygon, edge by edge.
pub static EDGE_INTEGRAL: BuiltIn = built_in!("edge_integral");
/// Form factors that have closed forms.
pub static CLOSED_FORMS: BuiltIn = built_in!("closed_forms");

impl BuiltIn {
    const fn new(name: &'static str, path: &'static str, text: &'static str) -> Self {
        Self { name, path, text, programs: OnceLock::new() }
    }

    /// All programs of the table: one, or one per function.
    ///
    /// # Errors
    /// Never for the tables of this module, which are tested.
    pub fn programs(&'static self) -> Result<&'static [Program], Failure> {
        let read = || Program::check_all(&Table::parse(Source::new(self.path, self.text))?);
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_table_is_read_and_has_its_name() {
        for table in [&SMSR, &RSMSS, &HORIZON_CLIP, &CLIP_STEP, &EDGE_SILHOUETTE, &BOX_SILHOUETTE] {
            assert_eq!(table.program().unwrap_or_else(|e| panic!("{e}")).name, table.name);
        }
        for table in [&DOUBLE_PRODUCT, &SPHERICAL_GAUSSIAN, &EDGE_INTEGRAL, &CLOSED_FORMS] {
            assert!(table.programs().unwrap_or_else(|e| panic!("{e}")).len() > 1, "{}", table.name);
        }
        assert!(SMSR.function("moments").is_err());
    }
}
