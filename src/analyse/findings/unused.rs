//! U0505: inputs, names and helpers that nothing uses.
//!
//! An input that no result depends on still costs its place in the generated
//! signature, and more often than not its name is a misprint's victim.

use super::{Analysis, Run};
use crate::diag::{Diagnostic, Span, codes};
use crate::program::{InputSet, Program};

fn warning(kind: &str, name: &str, span: Span, label: &str) -> Diagnostic {
    Diagnostic::warning(codes::UNUSED_INPUT, format!("the {kind} `{name}` is never used")).at(span, label)
}

/// The codes that are found here, and how.
pub(in crate::analyse) const ANALYSIS: Analysis =
    Analysis { codes: &[codes::UNUSED_INPUT], run: Run::Program(findings) };

/// Looks for unused inputs, then for unused names, then for unused helpers.
fn findings(program: &Program) -> Vec<Diagnostic> {
    let mut found = inputs(program);
    found.extend(names(program));
    found.extend(helpers(program));
    found
}

fn inputs(program: &Program) -> Vec<Diagnostic> {
    // The functions of a table may share one list of parameters.
    let idle = if program.function.is_some() { InputSet::default() } else { program.idle() };
    let unused = program.input_ids().filter(|(id, _)| idle.contains(*id));
    let describe = |name: &str, span: Span| {
        warning("input", name, span, "no case and no default depends on it")
            .help("remove it, or check the spelling where it was meant to be used")
    };
    let unused = unused.map(|(_, input)| describe(&input.name, input.span));
    unused.chain(program.written.unused_fetches.iter().map(|name| describe(&name.value, name.span))).collect()
}

/// Names that lead nowhere. Those of a table of functions are for all of them, so there one cannot tell.
fn names(program: &Program) -> impl Iterator<Item = Diagnostic> {
    program.written.unused_names.iter().map(|name| {
        warning("name", &name.value, name.span, "no case, default, assumption or symmetry leads here")
            .help("remove it, or check the spelling where it was meant to be used")
    })
}

/// Helpers that nothing calls but helpers that nothing calls.
fn helpers(program: &Program) -> impl Iterator<Item = Diagnostic> {
    program.written.unused_helpers.iter().map(|helper| {
        let message = format!("the helper `{}` is never used", helper.value);
        Diagnostic::note(codes::UNUSED_INPUT, message)
            .at(helper.span, "nothing that is computed calls it")
            .help("remove it, or check the spelling where it was meant to be called")
    })
}

#[cfg(test)]
mod tests {
    use crate::analyse::found;

    #[test]
    fn unused_helpers_are_found() {
        let text = r#"Table(language: 1, name: "t", inputs: {"x": Range(from: 0, to: 1)},
            helpers: {"used(a)": "inner(a) + 1", "inner(a)": "a * a", "lost(a)": "also_lost(a)", "also_lost(a)": "a",
                      "limit(a)": "a"},
            functions: {
                "f": Function(parameters: ["x"], value: "used(x)"),
                "g": Function(parameters: ["x"], value: "x", error: (times: 4, scale: "limit(x)")),
            })"#;
        let table = crate::table::Table::parse(crate::diag::Source::new("t.ron", text));
        let programs = table.and_then(|table| crate::program::Program::check_all(&table));
        let programs = programs.unwrap_or_else(|e| panic!("{e}"));
        let found: Vec<_> = programs.iter().flat_map(super::findings).map(|d| d.message).collect();
        assert_eq!(found, ["the helper `lost` is never used", "the helper `also_lost` is never used"]);
    }

    #[test]
    fn unused_declarations_are_found() {
        let found = found(
            r#"Table(language: 1, name: "t", hit_policy: First,
                inputs: {"s": Bool(), "x": Range(from: 0, to: 1), "spare": Bool(), "f": Bool(fetched: (cost: 1))},
                names: {"a": "x + b", "b": "x * 2", "lost": "also_lost * 2", "also_lost": "x", "assumed": "s"},
                assume: {"A": "assumed || !spare"},
                output: Number(),
                cases: [Case(id: 1, when: "s", value: "a")],
                default: 0)"#,
        );
        assert_eq!(
            found,
            [
                "U0505 the input `spare` is never used",
                "U0505 the input `f` is never used",
                "U0505 the name `lost` is never used",
                "U0505 the name `also_lost` is never used",
                "U0503 no case claims 2 of the 4 states; they get the default",
            ]
        );
    }
}
