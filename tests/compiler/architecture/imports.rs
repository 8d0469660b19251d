//! What a file of the library names: modules of this crate and other crates, from its tokens.
//!
//! Comments, strings and everything under `#[cfg(test)]` are no use of anything. A re-export (`pub use`) of what
//! stands below is a table of contents, not a dependency, and is left out.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use proc_macro2::{Delimiter, TokenStream, TokenTree};

/// A module of the library and what its file names.
#[derive(Debug)]
pub(crate) struct Module {
    /// The path below `src`, with `/`.
    pub(crate) file: String,
    /// Paths within the crate, from its root: `["plan", "shapes", "orbit", "plan"]`.
    pub(crate) own: BTreeSet<Vec<String>>,
    /// Paths that begin with another name: `["wgpu", "Buffer"]`, and whatever is local.
    pub(crate) other: BTreeSet<Vec<String>>,
    /// Names that the module hands on (`pub use`), and the paths from the root of the crate that they stand for.
    exports: BTreeMap<String, Vec<String>>,
}

/// All modules of the crate whose root is `src/lib.rs`, by their paths; tests left out.
pub(crate) fn modules(src: &Path) -> BTreeMap<Vec<String>, Module> {
    let mut all = BTreeMap::new();
    let mut pending = vec![(Vec::new(), src.join("lib.rs"))];
    while let Some((path, file)) = pending.pop() {
        let text = std::fs::read_to_string(&file).unwrap_or_else(|e| panic!("{}: {e}", file.display()));
        let tokens: TokenStream = text.parse().unwrap_or_else(|e| panic!("{}: {e}", file.display()));
        let mut reader = Reader { module: path.clone(), ..Reader::default() };
        reader.items(tokens);
        let folder = if file.ends_with("lib.rs") || file.ends_with("mod.rs") {
            file.parent().expect("below src").to_owned()
        } else {
            file.with_extension("")
        };
        for name in &reader.declared {
            let candidates: [PathBuf; 2] = [folder.join(format!("{name}.rs")), folder.join(name).join("mod.rs")];
            let found = candidates.into_iter().find(|candidate| candidate.exists());
            let found = found.unwrap_or_else(|| panic!("{}: no file for `mod {name}`", file.display()));
            pending.push((path.iter().cloned().chain([name.clone()]).collect(), found));
        }
        let exports = reader.exports.iter().map(|(name, named)| (name.clone(), rooted(&path, &reader.declared, named)));
        let exports: BTreeMap<_, _> = exports.filter_map(|(name, named)| Some((name, named?))).collect();
        // `child::item` without a `use` is a path of this crate, too.
        let (mut own, mut other) = (BTreeSet::new(), BTreeSet::new());
        for named in reader.paths {
            match rooted(&path, &reader.declared, &named) {
                Some(inside) => own.insert(inside),
                None => other.insert(named),
            };
        }
        let shown = file.strip_prefix(src).expect("below src").to_string_lossy().replace('\\', "/");
        all.insert(path, Module { file: shown, own, other, exports });
    }
    all
}

/// A path from the root of the crate; nothing for one that leads elsewhere.
fn rooted(module: &[String], declared: &BTreeSet<String>, named: &[String]) -> Option<Vec<String>> {
    if named[0] == "crate" {
        return Some(named[1..].to_vec());
    }
    declared.contains(&named[0]).then(|| [module, named].concat())
}

/// The module in which what a path names is defined: names that modules hand on are followed.
pub(crate) fn home<'a>(all: &'a BTreeMap<Vec<String>, Module>, path: &[String]) -> &'a [String] {
    let mut path = path.to_vec();
    loop {
        let longest = (0..=path.len()).rev().find_map(|n| all.get_key_value(&path[..n]));
        let (module, found) = longest.expect("the root is a module");
        match path.get(module.len()).and_then(|name| found.exports.get(name)) {
            Some(further) => path = further.iter().chain(&path[module.len() + 1..]).cloned().collect(),
            None => return module,
        }
    }
}

#[derive(Default)]
struct Reader {
    module: Vec<String>,
    /// Names of modules that have files of their own.
    declared: BTreeSet<String>,
    paths: BTreeSet<Vec<String>>,
    exports: BTreeMap<String, Vec<String>>,
}

impl Reader {
    fn items(&mut self, stream: TokenStream) {
        let tokens: Vec<TokenTree> = stream.into_iter().collect();
        let (mut at, mut public) = (0, false);
        while at < tokens.len() {
            match &tokens[at] {
                TokenTree::Punct(punct) if punct.as_char() == '#' => {
                    // An attribute; what only tests have is skipped with its item.
                    let inner = matches!(tokens.get(at + 1), Some(TokenTree::Punct(p)) if p.as_char() == '!');
                    let group = tokens.get(at + 1 + usize::from(inner));
                    at += 2 + usize::from(inner);
                    if group.is_some_and(|group| only_tests(&group.to_string())) {
                        at = after_item(&tokens, at);
                    }
                    continue;
                }
                TokenTree::Group(group) => self.items(group.stream()),
                TokenTree::Ident(word) if word == "pub" => {
                    public = true;
                    // `pub(in crate::x)` names no dependency.
                    let scope = matches!(tokens.get(at + 1), Some(TokenTree::Group(g)) if g.delimiter() == Delimiter::Parenthesis);
                    at += 1 + usize::from(scope);
                    continue;
                }
                TokenTree::Ident(word) if word == "mod" => {
                    if let (Some(TokenTree::Ident(name)), Some(TokenTree::Punct(_))) =
                        (tokens.get(at + 1), tokens.get(at + 2))
                    {
                        self.declared.insert(name.to_string());
                    }
                    at += 2;
                }
                TokenTree::Ident(word) if word == "use" => {
                    let end = (at..tokens.len()).find(|i| is(&tokens[*i], ';')).unwrap_or(tokens.len());
                    self.tree(&tokens[at + 1..end], &[], public);
                    at = end;
                }
                TokenTree::Ident(_) => {
                    let (path, end) = path(&tokens, at);
                    if path.len() > 1 {
                        let path = self.absolute(path);
                        self.paths.insert(path);
                    }
                    at = end;
                    public = false;
                    continue;
                }
                _ => {}
            }
            public = false;
            at += 1;
        }
    }

    /// The tree of a `use`.
    fn tree(&mut self, tokens: &[TokenTree], before: &[String], public: bool) {
        for branch in tokens.split(|token| is(token, ',')) {
            let (mut named, mut alias) = (before.to_vec(), None);
            let mut words = branch.iter();
            let mut whole = true;
            while let Some(token) = words.next() {
                match token {
                    TokenTree::Ident(word) if word == "as" => alias = words.next().map(ToString::to_string),
                    TokenTree::Ident(word) if word == "self" && !named.is_empty() => {}
                    TokenTree::Ident(word) => named.push(word.to_string()),
                    TokenTree::Group(group) => {
                        self.tree(&group.stream().into_iter().collect::<Vec<_>>(), &named, public);
                        whole = false;
                    }
                    TokenTree::Punct(_) | TokenTree::Literal(_) => {}
                }
            }
            if !whole || named.is_empty() {
                continue;
            }
            let named = self.absolute(named);
            if public {
                let name = alias.or_else(|| named.last().cloned()).expect("a path has names");
                self.exports.insert(name, named.clone());
            }
            let below = self.declared.contains(&named[0]) || named[1..].starts_with(&self.module);
            if !(public && below) {
                self.paths.insert(named);
            }
        }
    }

    /// `self` and `super` resolved.
    fn absolute(&self, mut named: Vec<String>) -> Vec<String> {
        if !matches!(named[0].as_str(), "self" | "super") {
            return named;
        }
        let mut module = self.module.clone();
        while let Some(first) = named.first() {
            match first.as_str() {
                "self" => {}
                "super" => drop(module.pop()),
                _ => break,
            }
            named.remove(0);
        }
        [vec!["crate".to_owned()], module, named].concat()
    }
}

fn is(token: &TokenTree, sign: char) -> bool {
    matches!(token, TokenTree::Punct(punct) if punct.as_char() == sign)
}

/// The path that begins at a token, and the first token behind it.
fn path(tokens: &[TokenTree], mut at: usize) -> (Vec<String>, usize) {
    let mut names = Vec::new();
    while let Some(TokenTree::Ident(word)) = tokens.get(at) {
        names.push(word.to_string());
        let colons = tokens.get(at + 1).is_some_and(|t| is(t, ':')) && tokens.get(at + 2).is_some_and(|t| is(t, ':'));
        if !colons {
            return (names, at + 1);
        }
        at += 3;
    }
    (names, at)
}

fn only_tests(attribute: &str) -> bool {
    let squeezed: String = attribute.chars().filter(|c| !c.is_whitespace()).collect();
    ["[cfg(test)]", "[cfg(doctest)]", "[test]"].contains(&squeezed.as_str()) || squeezed.starts_with("[cfg(all(test,")
}

/// The end of the item that begins at a token: behind its `;` or its braces.
fn after_item(tokens: &[TokenTree], at: usize) -> usize {
    let end = (at..tokens.len()).find(|i| {
        is(&tokens[*i], ';') || matches!(&tokens[*i], TokenTree::Group(g) if g.delimiter() == Delimiter::Brace)
    });
    end.map_or(tokens.len(), |end| end + 1)
}
