//! The floors and walls of ARCHITECTURE.md hold: its lists are read from there, and compared with what the files of
//! `src` name.

mod imports;

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use imports::{Module, home};

type Modules = BTreeMap<Vec<String>, Module>;

fn library() -> Modules {
    imports::modules(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"))
}

/// The lines of the first block of code below a heading of ARCHITECTURE.md.
fn listed(heading: &str) -> Vec<String> {
    let text = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("ARCHITECTURE.md")).unwrap();
    let below = text.split_once(&format!("\n### {heading}\n")).map(|(_, below)| below);
    let block = below.and_then(|below| below.split("```").nth(1)).unwrap_or_else(|| panic!("no list of {heading}"));
    block.lines().skip(1).map(|line| line.trim().to_owned()).filter(|line| !line.is_empty()).collect()
}

/// Lines `from -> to: reason`; whoever makes an exception says why.
fn exceptions(heading: &str) -> BTreeSet<(String, String)> {
    let parse = |line: &String| {
        let (edge, reason) = line.split_once(": ")?;
        let (from, to) = edge.split_once(" -> ")?;
        (!reason.trim().is_empty()).then(|| (from.trim().to_owned(), to.trim().to_owned()))
    };
    let lines = listed(heading);
    lines.iter().map(|line| parse(line).unwrap_or_else(|| panic!("no `from -> to: reason`: {line}"))).collect()
}

/// Whether a path lies in what a pattern names, `*` being any one segment.
fn lies_in(path: &[String], pattern: &str) -> bool {
    let segments: Vec<&str> = pattern.split("::").collect();
    segments.len() <= path.len() && segments.iter().zip(path).all(|(segment, name)| *segment == "*" || segment == name)
}

/// Each module with each path within the crate that it names, and the module where that is at home.
fn uses(all: &Modules) -> impl Iterator<Item = (&[String], &[String], &Module)> {
    all.iter()
        .flat_map(move |(path, module)| module.own.iter().map(move |named| (path.as_slice(), home(all, named), module)))
}

/// What was not as listed: uses that nothing allows, and exceptions that nothing uses.
fn settle(mut wrong: BTreeSet<String>, allowed: &BTreeSet<(String, String)>, used: &BTreeSet<(String, String)>) {
    wrong.extend(allowed.difference(used).map(|(from, to)| format!("the exception {from} -> {to} is not needed")));
    assert!(wrong.is_empty(), "ARCHITECTURE.md does not say so:\n{}", wrong.into_iter().collect::<Vec<_>>().join("\n"));
}

/// A module uses what stands on lower floors, and itself.
#[test]
fn nothing_imports_upwards() {
    let all = library();
    let floors = listed("Floors");
    let mut floor = BTreeMap::new();
    for (height, line) in floors.iter().rev().enumerate() {
        line.split_whitespace().for_each(|name| assert!(floor.insert(name, height).is_none(), "{name} stands twice"));
    }
    let top: BTreeSet<&str> = all.keys().filter(|path| path.len() == 1).map(|path| path[0].as_str()).collect();
    assert_eq!(top, floor.keys().copied().collect(), "every module of src/lib.rs stands on a floor");
    let mut wrong = BTreeSet::new();
    for (from, to, module) in uses(&all) {
        let (Some(a), Some(b)) = (from.first(), to.first()) else { continue };
        if a != b && floor[b.as_str()] >= floor[a.as_str()] {
            wrong.insert(format!("{} uses {}, which does not stand below it", module.file, to.join("::")));
        }
    }
    settle(wrong, &BTreeSet::new(), &BTreeSet::new());
}

/// Libraries, and the table as written, are named only where ARCHITECTURE.md says.
#[test]
fn libraries_stay_behind_their_doors() {
    let all = library();
    let mut wrong = BTreeSet::new();
    for line in listed("Doors") {
        let (thing, rooms) = line.split_once(' ').unwrap_or_else(|| panic!("no rooms: {line}"));
        let rooms: Vec<&str> = rooms.split_whitespace().collect();
        let mut entered = BTreeSet::new();
        for (path, module) in &all {
            let names = if thing.contains("::") { &module.own } else { &module.other };
            if !names.iter().any(|named| lies_in(named, thing)) {
                continue;
            }
            if let Some(room) = rooms.iter().find(|room| lies_in(path, room)) {
                entered.insert(*room);
            } else {
                wrong.insert(format!("{} names {thing}", module.file));
            }
        }
        wrong.extend(
            rooms.iter().filter(|room| !entered.contains(*room)).map(|room| format!("{room} does not name {thing}")),
        );
    }
    settle(wrong, &BTreeSet::new(), &BTreeSet::new());
}

/// Two judges of one thing share nothing, even where a floor would let them.
#[test]
fn walls_have_no_doors() {
    let all = library();
    let mut wrong = BTreeSet::new();
    for line in listed("Walls") {
        let (here, there) = line.split_once(" | ").unwrap_or_else(|| panic!("no wall: {line}"));
        for (from, to, module) in uses(&all) {
            if lies_in(from, here.trim()) && there.split_whitespace().any(|other| lies_in(to, other)) {
                wrong.insert(format!("{} uses {}", module.file, to.join("::")));
            }
        }
    }
    settle(wrong, &BTreeSet::new(), &BTreeSet::new());
}

/// Files do not use each other in a circle. What a folder's `mod.rs` declares is there for the files in the folder, so
/// the way from a file to a module that contains it does not count.
#[test]
fn files_do_not_go_round() {
    let all = library();
    let mut edges: BTreeMap<&[String], BTreeSet<&[String]>> = BTreeMap::new();
    for (from, to, _) in uses(&all) {
        if !from.starts_with(to) {
            edges.entry(from).or_default().insert(to);
        }
    }
    let (allowed, mut used) = (exceptions("Circles"), BTreeSet::new());
    let named = |path: &[String]| path.join("::");
    // A listed way is taken out; what still leads back to where it began goes round.
    let split = |path: &String| path.split("::").map(str::to_owned).collect::<Vec<_>>();
    let listed: Vec<_> = allowed.iter().map(|(from, to)| (split(from), split(to))).collect();
    let there: Vec<bool> = listed
        .iter()
        .map(|(from, to)| edges.get_mut(from.as_slice()).is_some_and(|e| e.remove(to.as_slice())))
        .collect();
    let reached = |start: &[String]| {
        let (mut seen, mut pending) = (BTreeSet::new(), vec![start.to_owned()]);
        while let Some(at) = pending.pop() {
            for next in edges.get(at.as_slice()).into_iter().flatten() {
                if seen.insert(next.to_vec()) {
                    pending.push(next.to_vec());
                }
            }
        }
        seen
    };
    for ((from, to), there) in listed.iter().zip(there) {
        if there && reached(to).contains(from) {
            used.insert((named(from), named(to)));
        }
    }
    let reach: BTreeMap<&[String], _> = edges.keys().map(|path| (*path, reached(path))).collect();
    let mut wrong = BTreeSet::new();
    for (from, next) in &edges {
        for to in next {
            if reach.get(to).is_some_and(|back| back.contains(*from)) {
                wrong.insert(format!("{} -> {} is part of a circle", named(from), named(to)));
            }
        }
    }
    settle(wrong, &allowed, &used);
}
