//! What is tried out: for each target, how a case of it is made, and how it is judged.
//!
//! A new target is a line of [`ALL`] and its two functions.

use std::sync::OnceLock;

use umbrage::diag::Source;
use umbrage::eval::{Batch, Columns, Interpreter};
use umbrage::points::random::Random;
use umbrage::profile;
use umbrage::program::Program;
use umbrage::scene::Scene;
use umbrage::table::Table;
use umbrage::tuned::{Auto, Tuned};

use crate::choices::Choices;
use crate::corpus::{Family, files};
use crate::judge::tables::Depth;
use crate::judge::{Court, device, failures, tables};
use crate::mutate::mutated;
use crate::{command, tables as random};

/// What is judged: files with their names, the first one the one that is read.
#[derive(Debug, Clone)]
pub(crate) struct Case {
    pub(crate) files: Vec<(String, Vec<u8>)>,
    /// What is chosen at random while it is judged follows from this.
    pub(crate) seed: u64,
}

impl Case {
    fn of(name: &str, bytes: Vec<u8>, seed: u64) -> Self {
        Self { files: vec![(name.to_owned(), bytes)], seed }
    }

    /// The text of the first file.
    fn text(&self) -> Option<&str> {
        std::str::from_utf8(&self.files.first()?.1).ok()
    }
}

/// Something to try out.
pub(crate) struct Target {
    /// Its name on the command line.
    pub(crate) name: &'static str,
    /// What it is, in a few words.
    pub(crate) about: &'static str,
    /// Its share of the time.
    pub(crate) share: u32,
    /// What its cases are called in counts.
    pub(crate) cases: &'static str,
    /// Makes a case.
    pub(crate) make: fn(&mut Choices<'_>) -> Case,
    /// Judges one.
    pub(crate) judge: fn(&mut Court<'_>, &Case),
}

/// Every target, in the order in which they are tried.
pub(crate) const ALL: &[Target] = &[
    Target {
        name: "tables",
        about: "random well-formed tables",
        share: 60,
        cases: "random tables",
        make: well_formed,
        judge: table,
    },
    Target {
        name: "devices",
        about: "random well-formed tables on a software adapter",
        share: 6,
        cases: "random tables",
        make: well_formed,
        judge: on_a_device,
    },
    Target {
        name: "ron",
        about: "tables made wrong",
        share: 8,
        cases: "files",
        make: |c| of_file(c, Family::Ron, "t.ron"),
        judge: anything,
    },
    Target {
        name: "expressions",
        about: "expressions made wrong",
        share: 6,
        cases: "files",
        make: expression,
        judge: anything,
    },
    Target {
        name: "csv",
        about: "rows of inputs",
        share: 3,
        cases: "files",
        make: |c| of_file(c, Family::Csv, "rows.csv"),
        judge: rows,
    },
    Target {
        name: "json",
        about: "rows of inputs",
        share: 3,
        cases: "files",
        make: |c| of_file(c, Family::Json, "rows.json"),
        judge: rows,
    },
    Target {
        name: "captures",
        about: "rows of inputs, binary",
        share: 2,
        cases: "files",
        make: |c| of_file(c, Family::Capture, "rows.bin"),
        judge: rows,
    },
    Target {
        name: "profiles",
        about: "counts of states",
        share: 2,
        cases: "files",
        make: |c| of_file(c, Family::Profile, "p.ron"),
        judge: counts,
    },
    Target {
        name: "tuned",
        about: "choices of the tuner",
        share: 2,
        cases: "files",
        make: |c| of_file(c, Family::Tuned, "tuned.ron"),
        judge: tuned,
    },
    Target {
        name: "scenes",
        about: "scenes",
        share: 4,
        cases: "files",
        make: |c| of_file(c, Family::Scene, "s.ron"),
        judge: scene,
    },
    Target { name: "obj", about: "meshes", share: 3, cases: "files", make: |c| mesh(c, Family::Obj), judge: scene },
    Target { name: "gltf", about: "meshes", share: 4, cases: "files", make: |c| mesh(c, Family::Gltf), judge: scene },
    Target {
        name: "glb",
        about: "meshes, binary",
        share: 2,
        cases: "files",
        make: |c| mesh(c, Family::Glb),
        judge: scene,
    },
    Target {
        name: "commands",
        about: "the command, on any of these files",
        share: 5,
        cases: "commands",
        make: command::make,
        judge: command::judge,
    },
];

/// The target with a name.
pub(crate) fn named(name: &str) -> Option<&'static Target> {
    ALL.iter().find(|target| target.name == name)
}

fn well_formed(choices: &mut Choices<'_>) -> Case {
    let seed = choices.seed();
    let random::Written { text, beside } = random::table(choices);
    let mut case = Case::of("t.ron", text.into_bytes(), seed);
    case.files.extend(beside.into_iter().map(|(name, text)| (name, text.into_bytes())));
    case
}

/// What cannot be read is judged among the `tables`.
fn on_a_device(court: &mut Court<'_>, case: &Case) {
    let name = court.directory.join("t.ron").to_string_lossy().into_owned();
    let source = Source::new(name, case.text().unwrap_or_default().to_owned());
    let Ok(programs) = Table::parse(source).and_then(|table| Program::check_all(&table)) else {
        return court.count("refused", 1);
    };
    let mut random = Random::new(case.seed);
    for program in &programs {
        device::judge(court, program, &mut random);
    }
}

/// A file to begin with, made wrong.
pub(crate) fn of_file(choices: &mut Choices<'_>, family: Family, name: &str) -> Case {
    let all = files(family);
    let seed = choices.seed();
    let file = choices.below(all.len());
    let bytes = mutated(choices, all.get(file).map_or(&[][..], Vec::as_slice), all);
    Case::of(name, bytes, seed)
}

/// A table around an expression.
fn expression(choices: &mut Choices<'_>) -> Case {
    let case = of_file(choices, Family::Expression, "t.ron");
    let text = String::from_utf8_lossy(&case.files[0].1).replace(['"', '\\'], "");
    let condition = choices.either();
    let (when, value) = if condition { (text.trim(), "x") } else { ("b", text.trim()) };
    let table = HOST.replace(PLACE, &format!(r#"when: "{when}", value: "{value}""#));
    Case::of("t.ron", table.into_bytes(), case.seed)
}

/// A table around expressions, and the one that rows are of.
const HOST: &str = include_str!("../corpus/ron/yard.ron");
/// Where an expression is put into it.
const PLACE: &str = r#"when: "b || m == none", value: "z * y + k""#;

fn table(court: &mut Court<'_>, case: &Case) {
    match case.text() {
        Some(text) => tables::judge(court, text, Depth::WellFormed, case.seed),
        None => court.fault("a random table is no text", String::new()),
    }
}

fn anything(court: &mut Court<'_>, case: &Case) {
    match case.text() {
        Some(text) => tables::judge(court, text, Depth::Anything, case.seed),
        // Read as the command does, which says where it is no text.
        None => {
            let path = court.directory.join("t.ron");
            match court.part("read", |_| Program::read_all(&path)) {
                Some(Ok(_)) => court.fault("a table that is no text is read", String::new()),
                Some(Err(failure)) => failures::refusal(court, "table", &failure),
                None => {}
            }
        }
    }
}

/// The table whose rows, captures, profiles and choices are read.
fn host() -> &'static Program {
    static PROGRAM: OnceLock<Program> = OnceLock::new();
    PROGRAM.get_or_init(|| {
        let table = Table::parse(Source::new("yard.ron", HOST));
        table.and_then(|table| Program::check(&table)).unwrap_or_else(|failure| panic!("{failure}"))
    })
}

/// Rows are refused, or can be evaluated and written again.
fn rows(court: &mut Court<'_>, case: &Case) {
    let program = host();
    let path = court.directory.join(&case.files[0].0);
    let columns = match court.part("read", |_| umbrage::cli::read_rows(program, &path)) {
        Some(Ok(columns)) => columns,
        Some(Err(failure)) => return failures::refusal(court, "rows", &failure),
        None => return,
    };
    court.count("rows", columns.len());
    court.part("evaluate", |court| {
        let all = Batch::<f32>::new(program).evaluate(&columns);
        let mut one = Interpreter::<f32>::new(program);
        for row in 0..columns.len().min(20) {
            let point = columns.point(row);
            for (input, value) in program.inputs.iter().zip(&point) {
                let fits = value.is_none_or(|value| input.parse(&input.show(value)).is_ok() || beside(input, value));
                court.expect(fits, "rows: a value is read that is none of its input", || {
                    format!("{} {value:?}", input.name)
                });
            }
            let outcome = one.evaluate(&point);
            court.expect(outcome.is_ok() || all.is_err(), "rows: evaluated together, but not by themselves", || {
                format!("{point:?}")
            });
        }
    });
    court.part("write", |court| {
        let mut bytes = Vec::new();
        let written = umbrage::capture::write(program, &columns, &mut bytes);
        let again = umbrage::capture::parse(program, &bytes);
        let same = |other: &Columns<f32>| (0..columns.len()).all(|row| columns.point(row) == other.point(row));
        let kept = written.is_ok()
            && again.as_ref().is_ok_and(|again| again.columns.len() == columns.len() && same(&again.columns));
        court.expect(kept, "captures: what was written is not read again", || format!("{written:?} {:?}", again.err()));
    });
}

/// Returns whether a number is that of a range once it was rounded to `f32`.
fn beside(input: &umbrage::program::Input, value: umbrage::program::Value) -> bool {
    match (&input.domain, value) {
        (umbrage::program::Domain::Continuous { lo, hi, .. }, umbrage::program::Value::Number(number)) => {
            (*lo as f32..=*hi as f32).contains(&(number as f32))
        }
        (_, _) => false,
    }
}

fn counts(court: &mut Court<'_>, case: &Case) {
    let program = host();
    let path = court.directory.join(&case.files[0].0);
    let profile = match court.part("read", |_| profile::read(&path)) {
        Some(Ok(profile)) => profile,
        Some(Err(failure)) => return failures::refusal(court, "profile", &failure),
        None => return,
    };
    court.count("profiles read", 1);
    court.part("write", |court| {
        let text = profile::to_ron(&profile);
        let written = std::fs::write(&path, &text).is_ok();
        match profile::read(&path) {
            Ok(again) => {
                court.expect(profile::to_ron(&again) == text, "profiles: change when written again", || text.clone())
            }
            Err(failure) => {
                court.expect(!written, "profiles: what was written is not read again", || failure.to_string())
            }
        }
    });
    court.part("fit", |court| match profile::fit(program, profile, "p.ron") {
        Ok(fitted) => {
            fitted.excluded(program);
            match fitted.weights(program, "p.ron") {
                Ok(weights) => {
                    let options = umbrage::plan::PlanOptions {
                        shape: umbrage::plan::Shape::Ordered,
                        weights: Some(&weights),
                        assume: false,
                    };
                    let plan = umbrage::plan::Plan::proved(program, options);
                    court.expect(plan.is_ok(), "profiles: a plan for one is not proved", || {
                        plan.err().map_or(String::new(), |f| f.to_string())
                    });
                }
                Err(failure) => failures::refusal(court, "profile", &failure),
            }
        }
        Err(failure) => failures::refusal(court, "profile", &failure),
    });
}

fn tuned(court: &mut Court<'_>, case: &Case) {
    let path = court.directory.join(&case.files[0].0);
    let tuned = match court.part("read", |_| Tuned::read(&path)) {
        Some(Ok(Some(tuned))) => tuned,
        Some(Ok(None)) => return court.fault("tuned: a file that is there is not", String::new()),
        Some(Err(failure)) => return failures::refusal(court, "tuned", &failure),
        None => return,
    };
    court.count("choices read", tuned.tables.len());
    court.part("use", |court| {
        Auto::of(host(), Some(&tuned));
        let text = tuned.to_ron();
        let written = std::fs::write(&path, &text).is_ok();
        let again = Tuned::read(&path);
        let same = again.as_ref().is_ok_and(|again| again.as_ref().is_some_and(|again| again.to_ron() == text));
        court.expect(!written || same, "tuned: what was written is not read again", || text.clone());
    });
}

/// A mesh, in a scene that shows it.
fn mesh(choices: &mut Choices<'_>, family: Family) -> Case {
    let (_, ending) = family.place();
    let name = format!("m.{ending}");
    let case = of_file(choices, family, &name);
    let size = *choices.pick(&["", ", size: 2"]);
    let scene = format!(
        "Scene(camera: (eye: (3, 2, 5), target: (0, 0, 0)), light: Directional(direction: (0.3, -1, 0.2)), \
         objects: [(shape: Mesh(file: \"{name}\"{size}))])"
    );
    let mut files = vec![("s.ron".to_owned(), scene.into_bytes())];
    files.extend(case.files);
    Case { files, seed: case.seed }
}

fn scene(court: &mut Court<'_>, case: &Case) {
    let path = court.directory.join(&case.files[0].0);
    let scene = match court.part("read", |_| Scene::open(&path.to_string_lossy())) {
        Some(Ok(scene)) => scene,
        Some(Err(failure)) => return failures::refusal(court, "scene", &failure),
        None => return,
    };
    court.count("scenes read", 1);
    court.part("look", |court| {
        let finite = scene.triangles().all(|(_, triangle)| {
            triangle.corners.iter().all(|corner| corner.is_finite())
                && triangle.normals.iter().all(|normal| normal.is_finite())
        });
        court.expect(finite, "scenes: a triangle is not finite", String::new);
    });
}
