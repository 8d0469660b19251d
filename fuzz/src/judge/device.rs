//! Random tables on a graphics adapter: a plan does there what the reference says, as far as WGSL lets it.

use std::sync::OnceLock;

use umbrage::diff::{self, Effort, Report};
use umbrage::eval::Columns;
use umbrage::gpu::{AdapterChoice, Gpu};
use umbrage::plan::{Plan, Shape};
use umbrage::points::random::Random;
use umbrage::program::Program;
use umbrage::prove::Proved;

use super::{Court, plans, points};

/// Plans of a program that are tried, of all that suit it: drivers take long to compile one.
const PLANS: usize = 2;

/// Most states of a program that is tried in every language; the others are tried at points.
const STATES: usize = 64;

/// The adapter: a software rasteriser, so that a run says the same everywhere.
fn adapter() -> Option<&'static Gpu> {
    static ADAPTER: OnceLock<Option<Gpu>> = OnceLock::new();
    ADAPTER.get_or_init(|| Gpu::open(&AdapterChoice::Software).ok()).as_ref()
}

/// Tries some plans of a program.
pub(crate) fn judge(court: &mut Court<'_>, program: &Program, random: &mut Random) {
    let Some(gpu) = court.part("device: open", |_| adapter()).flatten() else {
        // A machine without a driver tries the rest.
        let required = std::env::var_os("UMBRAGE_REQUIRE_ADAPTER").is_some();
        court.expect(!required, "device: there is no software adapter", String::new);
        return court.count("programs without an adapter", 1);
    };
    let mut shapes: Vec<Shape> = Shape::ALL.to_vec();
    for _ in 0..PLANS {
        let shape = shapes.swap_remove(random.below(shapes.len()));
        let Ok(proved) = Plan::proved(program, shape) else { continue };
        let points = points::choose(program, random);
        court.part(&format!("device: {shape}"), |court| run(court, gpu, &proved, points));
    }
}

fn run(court: &mut Court<'_>, gpu: &Gpu, proved: &Proved<'_>, points: Vec<umbrage::points::Point>) {
    let program = proved.plan().program;
    let one = std::slice::from_ref(proved);
    // What reads GLSL for us knows no lists.
    let small = program.states.count() <= STATES && !program.output.has_list();
    let result = if small {
        diff::plans(program, one, gpu, Effort { grid: 2, random: 2, lines: 1 }, |_| {})
    } else {
        let columns = match Columns::<f32>::from_rows(program, points) {
            Ok(columns) => columns,
            Err(error) => return court.fault("device: points do not fit", error.to_string()),
        };
        diff::at(program, one, gpu, &columns).map(|runs| Report {
            table: program.name.clone(),
            states: None,
            points: columns.len(),
            runs,
            refused: Vec::new(),
        })
    };
    let report = match result {
        Ok(report) => report,
        Err(failure) => {
            let first = failure.diagnostics.first().map_or(String::new(), |one| plans::alike(&one.message));
            return court.fault(format!("device: fails: {first}"), failure.to_string());
        }
    };
    let shape = proved.plan().shape;
    court.count("kernels run on a device", report.runs.len());
    for run in &report.runs {
        court.count("points on a device", report.points - run.excluded);
        court.count("points on a device that differ as WGSL admits", run.admissible);
        court.count("points on a device that differ by the order of sums", run.reordered);
        court.expect(run.offending == 0, &format!("device: {shape} gives something else"), || {
            let offenders: Vec<String> =
                run.offenders.iter().map(|one| format!("at {}: {}", one.inputs, one.reason)).collect();
            format!(
                "{} of {} points, {:?}, {:?}\n{}",
                run.offending,
                report.points,
                run.entry,
                run.language,
                offenders.join("\n")
            )
        });
    }
}
