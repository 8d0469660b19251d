//! The targets, a file for each or for a few that differ in a word, and the one list of them.
//!
//! A target is a new file here, which ends in a [`Definition`], and its line in the list below:
//! the command line, build scripts, host modules, tests and documents go by that.

mod counting;
mod glsl;
mod naga_oil;
mod rust;
mod translated;
mod wesl;
mod wgsl;

use crate::diag::Failure;
use crate::prove::Proved;

/// A function that writes plans into one file and validates it. Rust embeds the files beside it.
type Write = fn(&[Proved<'_>], &[SiblingFile]) -> Result<Vec<u8>, Failure>;

/// A target, as its file declares it.
pub(super) struct Definition {
    /// The name on the command line.
    name: &'static str,
    /// The end of file names, without the leading dot.
    extension: &'static str,
    /// True if it is emitted where no target is named.
    default: bool,
    /// The constant that a Rust module beside it embeds it as, unless it is Rust itself.
    constant: Option<Constant>,
    /// Writes plans into one file, validated.
    write: Write,
}

/// A constant that holds a file.
#[derive(Debug, Clone, Copy)]
struct Constant {
    /// Its documentation.
    doc: &'static str,
    /// Its name.
    name: &'static str,
    /// True if the file is text.
    text: bool,
}

impl Constant {
    const fn text(doc: &'static str, name: &'static str) -> Option<Self> {
        Some(Self { doc, name, text: true })
    }
}

/// A file that lies in the directory of a Rust module, which makes a constant of it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SiblingFile {
    /// Its target, or `None` for the words of a lookup.
    pub target: Option<Target>,
    /// Its name.
    pub file: String,
}

impl SiblingFile {
    /// The constant, unless it is Rust itself.
    fn constant(&self) -> Option<String> {
        let lookup = Constant { doc: "The words of the lookup, little-endian.", name: "LOOKUP", text: false };
        let Constant { doc, name, text } = self.target.map_or(Some(lookup), Target::constant)?;
        let (ty, include) = if text { ("&str", "include_str") } else { ("&[u8]", "include_bytes") };
        Some(format!("/// {doc}\npub const {name}: {ty} = {include}!(\"{}\");", self.file))
    }
}

/// Declares the targets, in the order of reports.
macro_rules! targets {
    ($($(#[$doc:meta])* $target:ident = $definition:path,)*) => {
        /// A language to emit, and in what form.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Target {
            $($(#[$doc])* $target,)*
        }

        impl Target {
            /// Every target, in the order of reports.
            pub const ALL: [Target; [$(Target::$target),*].len()] = [$(Target::$target),*];

            fn definition(self) -> &'static Definition {
                match self {
                    $(Target::$target => &$definition,)*
                }
            }
        }
    };
}

targets! {
    /// WGSL to be pasted or concatenated.
    Wgsl = wgsl::TARGET,
    /// A module of WESL.
    Wesl = wesl::TARGET,
    /// A module of naga_oil.
    NagaOil = naga_oil::TARGET,
    /// A library for GLSL 450.
    Glsl450 = glsl::V450,
    /// WGSL that counts which line of the table gives each result.
    WgslCounting = counting::WGSL,
    /// A library for GLSL 450 that counts them.
    Glsl450Counting = counting::GLSL,
    /// A library for GLSL 330.
    Glsl330 = glsl::V330,
    /// A library for GLSL ES 300.
    GlslEs300 = glsl::ES300,
    /// A Rust module without dependencies.
    Rust = rust::PLAIN,
    /// The same with inputs that `bytemuck` turns into bytes.
    RustBytemuck = rust::BYTEMUCK,
    /// The same with a pipeline for `wgpu`.
    RustWgpu = rust::WGPU,
    /// A SPIR-V compute shader over columns of inputs.
    SpirV = translated::SPIRV,
    /// The same as HLSL.
    Hlsl = translated::HLSL,
    /// The same as MSL.
    Msl = translated::MSL,
}

impl Target {
    /// The targets that are emitted where none is named: one per language.
    pub fn defaults() -> Vec<Self> {
        Self::ALL.into_iter().filter(|target| target.definition().default).collect()
    }

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        self.definition().name
    }

    /// The target with a name; `glsl` is the version 450.
    pub fn from_name(name: &str) -> Option<Self> {
        let name = if name == "glsl" { "glsl450" } else { name };
        Self::ALL.into_iter().find(|target| target.name() == name)
    }

    /// The end of file names, without the leading dot.
    pub fn extension(self) -> &'static str {
        self.definition().extension
    }

    /// The constant that a Rust module beside it embeds it as, unless it is Rust itself.
    fn constant(self) -> Option<Constant> {
        self.definition().constant
    }

    /// Writes plans into one file, validated.
    pub(super) fn write(self, plans: &[Proved<'_>], siblings: &[SiblingFile]) -> Result<Vec<u8>, Failure> {
        if plans.is_empty() {
            return Ok(Vec::new());
        }
        (self.definition().write)(plans, siblings)
    }
}

/// Modules of plans, one after the other.
fn joined(plans: &[Proved<'_>], write: impl Fn(&Proved<'_>) -> String) -> String {
    plans.iter().map(write).collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_extensions_are_unique_and_documented() {
        let document = include_str!("../../../docs/targets.md");
        for target in Target::ALL {
            assert_eq!(Target::from_name(target.name()), Some(target));
            assert!(document.contains(target.name()), "docs/targets.md does not mention `{}`", target.name());
            let alike = Target::ALL.into_iter().filter(|other| other.extension() == target.extension());
            assert_eq!(alike.count(), 1, "two targets write `.{}`", target.extension());
        }
    }
}
