//! The texts of the last pass, and the tables in them: those that the build
//! script compiled, until the file of one changes.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use umbrage::build::{self, Options, Request};
use umbrage::emit::Target;
use umbrage::plan::Shape;
use umbrage::technique::revectorise::Variant;

/// The plans to choose from. The build script makes the same.
pub(crate) const PLANS: [Shape; 5] = [Shape::Ladder, Shape::Ordered, Shape::Gathered, Shape::Switch, Shape::Tree];

/// The cases of the tables, by name, as the build script left them in Rust.
mod built {
    include!(concat!(env!("OUT_DIR"), "/rsmss/ladder.rs"));
    include!(concat!(env!("OUT_DIR"), "/smsr/ladder.rs"));
}

/// The WGSL of a table that the build script compiled.
macro_rules! compiled {
    ($table:literal, $plan:literal) => {
        Some(include_str!(concat!(env!("OUT_DIR"), "/", $table, "/", $plan, ".wgsl")))
    };
}

/// The search along silhouettes of a technique, as the build script left it.
macro_rules! skeleton {
    ($name:literal) => {
        include_str!(concat!(env!("OUT_DIR"), "/skeletons/", $name, ".wgsl"))
    };
}

const LIGHT: &str = include_str!("wgsl/light.wgsl");
/// What a table that counts asks of its host, `TABLE` standing for its name.
const HITS: &str = include_str!("wgsl/hits.wgsl");

/// A table, in all plans.
#[derive(Debug, Clone)]
pub(crate) struct Table {
    /// Its WGSL by plan, for the plans that suit it. The first one suits every table.
    modules: [Option<String>; PLANS.len()],
    /// The first plan as WGSL that counts which line gives each result.
    counting: String,
    /// What its cases are called.
    pub(crate) cases: BTreeMap<u32, String>,
    /// Whether it was read while the program runs.
    pub(crate) reloaded: bool,
}

impl Table {
    fn built(modules: [Option<&str>; PLANS.len()], counting: &str, cases: &[(u32, &str)]) -> Self {
        let cases = cases.iter().map(|(id, name)| (*id, (*name).to_owned())).collect();
        let modules = modules.map(|text| text.map(str::to_owned));
        Self { modules, counting: counting.to_owned(), cases, reloaded: false }
    }

    /// The number of its lines, as its text says.
    pub(crate) fn lines(&self) -> Option<usize> {
        let (_, rest) = self.counting.split_once("_HITS: u32 = ")?;
        rest.split_once("u;")?.0.parse().ok()
    }

    /// Whether a plan suits it.
    pub(crate) fn suits(&self, plan: usize) -> bool {
        self.modules[plan].is_some()
    }

    /// Checks, proves and compiles the table in a file, as the build script does.
    ///
    /// Also returns the table's name; the error is all that is wrong, as it is meant to be read.
    fn compile(path: &Path) -> Result<(String, Self), String> {
        let targets = vec![Target::Wgsl, Target::WgslCounting];
        let options = Options { shapes: PLANS.to_vec(), targets, auto: false, ..Options::default() };
        let batch = build::run(&Request { paths: vec![path.to_owned()], options, ..Request::default() });
        let (false, Some((programs, built))) = (batch.failed(), batch.tables.first()) else {
            let messages: Vec<String> = batch.messages.iter().map(ToString::to_string).collect();
            return Err(messages.join("\n"));
        };
        let module = |plan: Shape, target: Target| {
            let path = Path::new(&built.table).join(format!("{plan}.{}", target.extension()));
            let file = built.files.iter().find(|file| file.path == path)?;
            Some(String::from_utf8_lossy(&file.contents).into_owned())
        };
        let rows = programs.iter().flat_map(|program| &program.rows);
        let cases = rows.map(|row| (row.id, row.doc.clone())).collect();
        let counting = module(PLANS[0], Target::WgslCounting).unwrap_or_default();
        let table = Self { modules: PLANS.map(|plan| module(plan, Target::Wgsl)), counting, cases, reloaded: true };
        Ok((built.table.clone(), table))
    }
}

/// The tables in use, by name.
#[derive(Debug, Clone)]
pub(crate) struct Tables(BTreeMap<String, Table>);

impl Tables {
    /// Those that the build script compiled.
    pub(crate) fn built() -> Self {
        let rsmss = [
            compiled!("rsmss", "ladder"),
            compiled!("rsmss", "ordered"),
            compiled!("rsmss", "gathered"),
            compiled!("rsmss", "switch"),
            compiled!("rsmss", "tree"),
        ];
        // It fetches nothing that could be gathered.
        let smsr = [
            compiled!("smsr", "ladder"),
            compiled!("smsr", "ordered"),
            None,
            compiled!("smsr", "switch"),
            compiled!("smsr", "tree"),
        ];
        let counting = |table: Option<&'static str>| table.unwrap_or_default();
        let rsmss = Table::built(rsmss, counting(compiled!("rsmss", "ladder.counting")), &built::rsmss::RSMSS_CASES);
        let smsr = Table::built(smsr, counting(compiled!("smsr", "ladder.counting")), &built::smsr::SMSR_CASES);
        Self(BTreeMap::from([("rsmss".to_owned(), rsmss), ("smsr".to_owned(), smsr)]))
    }

    /// These, but with the one in a file; and its name.
    pub(crate) fn with(&self, path: &Path) -> Result<(Self, String), String> {
        let (name, table) = Table::compile(path)?;
        let mut tables = self.clone();
        match tables.0.get_mut(&name) {
            Some(place) => *place = table,
            None => return Err(format!("error: {} is the table `{name}`; here are rsmss and smsr", path.display())),
        }
        Ok((tables, name))
    }

    /// The table of a technique, if it has one.
    pub(crate) fn of(&self, technique: Variant) -> Option<&Table> {
        self.0.get(technique.table()?.name)
    }

    /// A plan where it suits the table of a technique, the first one elsewhere.
    pub(crate) fn suitable(&self, technique: Variant, plan: usize) -> usize {
        if self.of(technique).is_some_and(|table| table.suits(plan)) { plan } else { 0 }
    }

    /// The WGSL of the last pass.
    pub(crate) fn text(&self, technique: Variant, plan: usize, hits: bool) -> String {
        let table = self.of(technique);
        let host = match technique.table().filter(|_| hits) {
            Some(table) => HITS.replace("TABLE", table.name),
            None => String::new(),
        };
        let module = |table: &Table| if hits { Some(table.counting.clone()) } else { table.modules[plan].clone() };
        let table = table.and_then(module).unwrap_or_default();
        let skeleton = match technique {
            Variant::Hard => skeleton!("hard"),
            Variant::Smsr => skeleton!("smsr"),
            Variant::Rsmss => skeleton!("rsmss"),
            Variant::Rpcf => skeleton!("rpcf"),
            _ => skeleton!("pcf"),
        };
        [skeleton, &table, LIGHT, &host].concat()
    }
}

/// Files of tables, looked at now and then.
#[derive(Debug)]
pub(crate) struct Watch(Vec<(PathBuf, Option<SystemTime>)>);

impl Watch {
    /// The file that is asked for, or those that the build script read, where they still are.
    pub(crate) fn new(table: Option<&Path>) -> Self {
        let tables = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tables");
        let paths = match table {
            Some(path) => vec![path.to_owned()],
            None => ["rsmss.ron", "smsr.ron"].iter().map(|name| tables.join(name)).collect(),
        };
        Self(paths.into_iter().map(|path| (path.clone(), changed(&path))).collect())
    }

    /// The files that changed since this was last asked.
    pub(crate) fn changed(&mut self) -> Vec<PathBuf> {
        let mut news = Vec::new();
        for (path, known) in &mut self.0 {
            // A file that is being replaced may not be there for a moment.
            if let Some(now) = changed(path)
                && *known != Some(now)
            {
                *known = Some(now);
                news.push(path.clone());
            }
        }
        news
    }
}

fn changed(path: &Path) -> Option<SystemTime> {
    std::fs::metadata(path).ok()?.modified().ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::TECHNIQUES;

    #[test]
    fn tables_compiled_here_are_those_of_the_build_script() {
        let built = Tables::built();
        for name in ["rsmss", "smsr"] {
            let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tables").join(name).with_extension("ron");
            let (read, found) = built.with(&path).unwrap_or_else(|e| panic!("{e}"));
            assert_eq!(found, name);
            let (built, read) = (&built.0[name], &read.0[name]);
            assert_eq!(built.cases, read.cases);
            assert!(read.reloaded && !built.reloaded);
            assert!(built.counting.contains(&format!("{name}_hit(0u);")), "{name} counts");
            // The header names the options, which are others.
            let body = |text: &Option<String>| {
                text.as_deref().and_then(|text| text.split_once("\n\n")).map(|(_, body)| body.to_owned())
            };
            assert_eq!(body(&Some(built.counting.clone())), body(&Some(read.counting.clone())));
            for (plan, (built, read)) in PLANS.iter().zip(built.modules.iter().zip(&read.modules)) {
                assert!(body(built) == body(read), "{name}, {}", plan.name());
            }
        }
    }

    #[test]
    fn only_techniques_with_a_table_search() {
        for technique in TECHNIQUES {
            let text = Tables::built().text(technique, 0, false);
            assert!(!text.contains("_hit("), "{technique} counts unasked");
            assert_eq!(text.contains("fn table_key"), technique.table().is_some(), "{technique}");
        }
    }
}
