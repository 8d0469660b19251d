//! Reads the tables that a table imports, and those that they import; and says of a mistake in one where it is imported.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::library::Library;
use super::{ConstantValue, Table, data, names, read};
use crate::diag::{Diagnostic, Failure, Source, Span, codes};
use crate::text::file::shown;
use crate::text::reach::{OutOfReach, beside, plain};
use crate::text::tokens;

/// Most tables in a chain of imports.
const MAX_CHAIN: usize = 8;

/// The tables read so far, by path, each with the length of the longest chain of imports that it begins.
type Known = HashMap<PathBuf, (Arc<Table>, usize)>;

/// Reads what a table imports, each file once. A mistake in an imported table is reported there.
pub(super) fn resolve(table: Table, library: Library) -> Result<Table, Failure> {
    let own = plain(Path::new(&table.source.name));
    Ok(follow(table, &[own], &mut Known::new(), library)?.0)
}

/// Reads what a table at the end of a chain of imports imports, and counts the tables of the longest chain from it on.
fn follow(mut table: Table, chain: &[PathBuf], known: &mut Known, library: Library) -> Result<(Table, usize), Failure> {
    let source = table.source.clone();
    for constant in &mut table.constants {
        if let ConstantValue::File(path, read) = &mut constant.value {
            *read = Some(Arc::new(data::file(&source, path, library)?));
        }
    }
    let fail = |diagnostic| Failure::new(source.clone(), diagnostic);
    let mut imports = std::mem::take(&mut table.imports);
    let mut longest = 1;
    for (index, import) in imports.iter().enumerate() {
        names::check_inner(&import.alias.value, "an imported table", import.alias.span).map_err(fail)?;
        if let Some(first) = imports[..index].iter().find(|other| other.alias.value == import.alias.value) {
            let message = format!("two imported tables are called `{}`", import.alias.value);
            let error = Diagnostic::error(codes::DUPLICATE, message).at(import.alias.span, "again");
            return Err(fail(error.at(first.alias.span, "first here")));
        }
    }
    for import in &mut imports {
        let error = |message: String, label: &str| {
            Diagnostic::error(codes::IMPORT, message).at(import.path.span, label.to_owned())
        };
        let folder = Path::new(&source.name).parent().unwrap_or(Path::new(""));
        let path = beside(folder, &import.path.value).map_err(|OutOfReach| {
            let message = format!("`{}` {}", import.path.value.escape_debug(), OutOfReach::WHAT);
            fail(error(message, "imported here").help(OutOfReach::HELP))
        })?;
        let name = shown(&path);
        if chain.contains(&path) {
            let shown = chain.iter().chain([&path]).map(|p| shown(p));
            let message = format!("the imports form a circle: {}", shown.collect::<Vec<_>>().join(" -> "));
            return Err(fail(error(message, "leads back").help("move what both need into a table of its own")));
        }
        let length = known.get(&path).map_or(1, |(_, length)| *length);
        if chain.len() + length > MAX_CHAIN {
            return Err(fail(error(format!("more than {MAX_CHAIN} tables import each other"), "one too many")));
        }
        if let Some((read, length)) = known.get(&path) {
            import.table = Some(read.clone());
            longest = longest.max(1 + length);
            continue;
        }
        let text = library.read(&path).map_err(|failure| {
            let reason = failure.diagnostics.first().map_or(String::new(), |d| d.message.clone());
            fail(
                error(format!("the imported table `{name}` {reason}"), "imported here")
                    .help("paths are relative to the file that imports"),
            )
        })?;
        let imported = Source::new(&*name, text);
        let read = read::table(&imported).map_err(|diagnostics| Failure { source: imported, diagnostics })?;
        let chain: Vec<PathBuf> = chain.iter().chain([&path]).cloned().collect();
        let (read, length) = follow(read, &chain, known, library)?;
        let read = Arc::new(read);
        known.insert(path, (read.clone(), length));
        import.table = Some(read);
        longest = longest.max(1 + length);
    }
    table.imports = imports;
    Ok((table, longest))
}

/// The diagnostics of a failure as one sees them who looks at a single text: the first mistake in an imported
/// table is said where that is imported.
pub fn seen_from(source: &Source, failure: Failure) -> Vec<Diagnostic> {
    if failure.source.name == source.name {
        return failure.diagnostics;
    }
    let place = tokens::tokens(&source.text).into_iter().find_map(|token| {
        let (_, inner, _) = tokens::quoted(token.text);
        let named = token.kind == tokens::Kind::Text && !inner.is_empty() && failure.source.name.ends_with(inner);
        let start = (token.text.as_ptr() as usize).saturating_sub(source.text.as_ptr() as usize);
        named.then(|| Span::new(start, start + token.text.len()))
    });
    let first = failure.diagnostics.first();
    let (code, message) = first.map_or((codes::IMPORT, ""), |first| (first.code, first.message.as_str()));
    let line = first.and_then(|first| first.labels.first()).map_or(1, |label| failure.source.line(label.span.start));
    let error = Diagnostic::error(code, format!("{}:{line}: {message}", failure.source.name));
    vec![error.at(place.unwrap_or_default(), "imported here")]
}
