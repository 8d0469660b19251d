//! Plans as arguments: by name, or `auto`, which stands for what was tuned.

use crate::plan::Shape;

/// A plan, as an argument.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum PlanArgument {
    /// One that is named.
    Shape(Shape),
    /// The tuned one, else the default.
    Auto,
}

/// Reads the name of a plan, or `auto`.
pub(super) fn parse_plan(name: &str) -> Result<PlanArgument, String> {
    if name == "auto" {
        return Ok(PlanArgument::Auto);
    }
    super::parse_shape(name).map(PlanArgument::Shape).map_err(|unknown| format!("{unknown}; and auto, the tuned one"))
}

/// The plans that are named, and whether `auto` is among them.
pub(super) fn split(plans: &[PlanArgument]) -> (Vec<Shape>, bool) {
    let shapes = plans.iter().filter_map(|plan| match plan {
        PlanArgument::Shape(shape) => Some(*shape),
        PlanArgument::Auto => None,
    });
    (shapes.collect(), plans.contains(&PlanArgument::Auto))
}
