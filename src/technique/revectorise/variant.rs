//! The variants of revectorisation, by name.

use std::fmt;

use crate::diag::Failure;
use crate::program::Program;
use crate::technique::tables::{self, BuiltIn};

/// A way to turn a shadow map into the visibility of the light.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Variant {
    /// One depth test per fragment: jagged where texels are large.
    Hard,
    /// Percentage-closer filtering: the mean of n × n depth tests.
    Pcf,
    /// Silhouette revectorisation by the table `smsr`: the staircase becomes a line.
    Smsr,
    /// Revectorised soft silhouettes by the table `rsmss`: the line, antialiased.
    Rsmss,
    /// The mean of n × n results of [`Variant::Rsmss`].
    Rpcf,
    /// The filtered formulation without cases that the authors published later.
    CaseFree,
}

impl Variant {
    /// All of them, the cheapest first.
    pub const ALL: [Variant; 6] =
        [Variant::Hard, Variant::Pcf, Variant::Smsr, Variant::Rsmss, Variant::Rpcf, Variant::CaseFree];

    /// Its name on the command line and in files.
    pub fn name(self) -> &'static str {
        match self {
            Variant::Hard => "hard",
            Variant::Pcf => "pcf",
            Variant::Smsr => "smsr",
            Variant::Rsmss => "rsmss",
            Variant::Rpcf => "rpcf",
            Variant::CaseFree => "casefree",
        }
    }

    /// The variant with a name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|variant| variant.name() == name)
    }

    /// The table that it evaluates, if it evaluates one.
    pub fn table(self) -> Option<&'static BuiltIn> {
        match self {
            Variant::Smsr => Some(&tables::SMSR),
            Variant::Rsmss | Variant::Rpcf => Some(&tables::RSMSS),
            Variant::Hard | Variant::Pcf | Variant::CaseFree => None,
        }
    }
}

impl Variant {
    /// The program of its table, if it evaluates one.
    ///
    /// # Errors
    /// Never for the tables that come with Umbrage, which are tested.
    pub fn program(self) -> Result<Option<&'static Program>, Failure> {
        self.table().map(BuiltIn::program).transpose()
    }
}

impl fmt::Display for Variant {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
