//! The code shapes, one file each, and the one list of them.
//!
//! A shape made of the steps that there are is a new file here, which ends in a [`Definition`], and its
//! line in the list below: names, reports, tests, documents and the proof go by that.

mod chain;
mod coefficients;
mod gather;
mod ladder;
mod orbit;
mod switch;
mod tree;

use std::fmt;

use super::Plan;
use super::builder::Result;
use super::setting::Setting;
use crate::program::MAX_WRITTEN;

/// A code shape, as its file declares it.
pub(super) struct Definition {
    /// The name on the command line and in file names.
    name: &'static str,
    /// A line that describes it.
    summary: &'static str,
    /// True if its code reads a buffer of the host, which holds the lookup.
    reads_buffer: bool,
    /// True if it chooses by the key, so that it does not suit functions without discrete inputs.
    needs_key: bool,
    /// True if the constants that states choose between go into that buffer, and not into the code.
    holds_data: bool,
    /// Plans a program.
    plan: for<'p> fn(&Setting<'p, '_>) -> Result<Plan<'p>>,
}

/// Declares the shapes, in the order of reports.
macro_rules! shapes {
    ($($(#[$doc:meta])* $shape:ident = $definition:path,)*) => {
        /// The code shapes that can be asked for.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Shape {
            $($(#[$doc])* $shape,)*
        }

        impl Shape {
            /// Every shape, in the order of reports.
            pub const ALL: [Shape; [$(Shape::$shape),*].len()] = [$(Shape::$shape),*];

            fn definition(self) -> &'static Definition {
                match self {
                    $(Shape::$shape => &$definition,)*
                }
            }
        }
    };
}

shapes! {
    /// The chain of guards, as written.
    Ladder = ladder::SHAPE,
    /// The chain of guards in the best order.
    Ordered = chain::ORDERED,
    /// A few tests, then chains.
    Nested = chain::NESTED,
    /// All fetches first.
    Gathered = gather::SHAPE,
    /// A decision graph.
    Tree = tree::SHAPE,
    /// A lookup in constants, then a `switch`.
    Switch = switch::CONSTANTS,
    /// A lookup in a buffer, then a `switch`.
    SwitchBuffer = switch::BUFFER,
    /// Coefficients from a buffer.
    Coefficients = coefficients::SHAPE,
    /// Representatives of symmetric states.
    Orbit = orbit::SHAPE,
}

impl Shape {
    /// The name on the command line and in file names.
    pub fn name(self) -> &'static str {
        self.definition().name
    }

    /// A line that describes the code.
    pub fn summary(self) -> &'static str {
        self.definition().summary
    }

    /// Returns whether its code reads a buffer of the host, which holds the lookup.
    pub fn reads_buffer(self) -> bool {
        self.definition().reads_buffer
    }

    /// The shape with a name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|shape| shape.name() == name)
    }

    /// Plans a program.
    ///
    /// # Errors
    /// With the reason, where the shape does not suit the program.
    pub(super) fn plan<'p>(self, setting: &Setting<'p, '_>) -> Result<Plan<'p>> {
        let definition = self.definition();
        if definition.needs_key && setting.program.function.is_some() && setting.program.states.count() == 1 {
            return Err("it has no discrete inputs to choose by; use `ladder`".to_owned());
        }
        if !definition.holds_data && setting.program.is_data() {
            return Err(format!(
                "its states choose between more than {MAX_WRITTEN} constants, which would all be written out; use \
                 `coefficients`, which reads them from a buffer"
            ));
        }
        (definition.plan)(setting)
    }
}

impl fmt::Display for Shape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_and_documented() {
        let document = include_str!("../../../docs/tuning.md");
        for shape in Shape::ALL {
            assert_eq!(Shape::from_name(shape.name()), Some(shape));
            let name = format!("`{shape}`");
            assert!(document.contains(&name), "docs/tuning.md does not mention {name}");
        }
    }
}
