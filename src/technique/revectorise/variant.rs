//! The techniques by name.

use std::fmt;

/// A way to turn a shadow map into the visibility of the light.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Technique {
    /// One depth test per fragment: jagged where texels are large.
    Hard,
    /// Percentage-closer filtering: the mean of n × n depth tests.
    Pcf,
    /// Silhouette revectorisation by the table `smsr`: the staircase becomes a line.
    Smsr,
    /// Revectorised soft silhouettes by the table `rsmss`: the line, antialiased.
    Rsmss,
    /// The mean of n × n results of [`Technique::Rsmss`].
    Rpcf,
    /// The filtered formulation without cases that the authors published later.
    CaseFree,
    /// The true shadow, antialiased: rays towards the light, no shadow map.
    Reference,
}

impl Technique {
    /// All of them, the cheapest first.
    pub const ALL: [Technique; 7] = [
        Technique::Hard,
        Technique::Pcf,
        Technique::Smsr,
        Technique::Rsmss,
        Technique::Rpcf,
        Technique::CaseFree,
        Technique::Reference,
    ];

    /// Its name on the command line and in files.
    pub fn name(self) -> &'static str {
        match self {
            Technique::Hard => "hard",
            Technique::Pcf => "pcf",
            Technique::Smsr => "smsr",
            Technique::Rsmss => "rsmss",
            Technique::Rpcf => "rpcf",
            Technique::CaseFree => "casefree",
            Technique::Reference => "reference",
        }
    }

    /// The technique with a name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|technique| technique.name() == name)
    }

    /// The table that it evaluates, if it does: its name.
    pub fn table(self) -> Option<&'static str> {
        match self {
            Technique::Smsr => Some("smsr"),
            Technique::Rsmss | Technique::Rpcf => Some("rsmss"),
            Technique::Hard | Technique::Pcf | Technique::CaseFree | Technique::Reference => None,
        }
    }
}

impl fmt::Display for Technique {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
