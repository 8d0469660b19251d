//! Whether every package that is linked, or used for building or testing, may be
//! used under licences that `deny.toml` allows.
//!
//! It reads the same list as `cargo deny` and needs nothing installed.

use crate::{Result, cargo};

/// Fails if the licence of some package is not covered.
pub(crate) fn check(manifest: &str) -> Result {
    let allowed = allowed(manifest);
    let mut tree = cargo(&["tree", "--workspace", "--target", "all", "--edges", "normal,build,dev"]);
    tree.args(["--prefix", "none", "--format", "{p}|{l}"]);
    let output = match tree.output() {
        Ok(output) if output.status.success() => output,
        Ok(output) => {
            eprintln!("{}", String::from_utf8_lossy(&output.stderr));
            return Err(1);
        }
        Err(error) => {
            eprintln!("error: cannot be started: {error}");
            return Err(1);
        }
    };
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let mut packages: Vec<&str> = text.lines().map(|line| line.trim_end_matches(" (*)")).collect();
    packages.sort_unstable();
    packages.dedup();
    let refused =
        packages.iter().filter_map(|line| line.split_once('|')).filter(|(_, licence)| !admits(licence, &allowed));
    let refused: Vec<_> = refused.collect();
    for (package, licence) in &refused {
        eprintln!("error: {package}: `{licence}` is not covered by the licences that deny.toml allows");
    }
    println!("{} packages, {} licences allowed", packages.len(), allowed.len());
    if refused.is_empty() { Ok(()) } else { Err(1) }
}

/// The list `allow` of `deny.toml`.
fn allowed(manifest: &str) -> Vec<&str> {
    let list = manifest.split("\nallow = [").nth(1).and_then(|rest| rest.split(']').next()).unwrap_or_default();
    list.split('"').skip(1).step_by(2).collect()
}

/// Whether an SPDX expression can be met by allowed licences. `AND` binds tighter than `OR`; an old `/` is an `OR`.
fn admits(expression: &str, allowed: &[&str]) -> bool {
    let spaced = expression.replace('/', " OR ").replace('(', " ( ").replace(')', " ) ");
    let words: Vec<&str> = spaced.split_whitespace().collect();
    let mut rest = words.as_slice();
    let met = any(&mut rest, allowed);
    met && rest.is_empty()
}

fn any(rest: &mut &[&str], allowed: &[&str]) -> bool {
    let mut met = all(rest, allowed);
    while let [first, others @ ..] = *rest
        && *first == "OR"
    {
        *rest = others;
        met |= all(rest, allowed);
    }
    met
}

fn all(rest: &mut &[&str], allowed: &[&str]) -> bool {
    let mut met = one(rest, allowed);
    while let [first, others @ ..] = *rest
        && *first == "AND"
    {
        *rest = others;
        met &= one(rest, allowed);
    }
    met
}

fn one(rest: &mut &[&str], allowed: &[&str]) -> bool {
    match *rest {
        ["(", others @ ..] => {
            *rest = others;
            let met = any(rest, allowed);
            *rest = rest.strip_prefix(&[")"]).unwrap_or(rest);
            met
        }
        [licence, "WITH", exception, others @ ..] => {
            *rest = others;
            allowed.contains(&format!("{licence} WITH {exception}").as_str())
        }
        [licence, others @ ..] => {
            *rest = others;
            allowed.contains(licence)
        }
        [] => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn expressions_of_licences() {
        let allowed = allowed("[licenses]\nallow = [\n    \"MIT\",\n    \"Zlib\",\n    \"A WITH x\",\n]\n");
        assert_eq!(allowed, ["MIT", "Zlib", "A WITH x"]);
        for covered in ["MIT", "GPL OR MIT", "GPL/MIT", "(MIT OR GPL) AND Zlib", "A WITH x OR GPL", "GPL AND A OR MIT"]
        {
            assert!(admits(covered, &allowed), "{covered}");
        }
        for not in ["", "GPL", "MIT AND GPL", "(MIT OR GPL) AND GPL", "A", "A WITH y", "MIT) GPL"] {
            assert!(!admits(not, &allowed), "{not}");
        }
    }
}
