//! Convolution shadows, measured: kernels, phases and smear against an exact blur; kernels, split lights, slopes, slabs and
//! coverage against many sharp lights; time and memory. What is printed is in `docs/convolution.md`.
//!
//! ```console
//! $ cargo bench --bench convolution
//! $ cargo bench --bench convolution -- blurs split --plots plots
//! ```

mod blurs;
mod cost;
mod pictures;

use std::fs;
use std::path::PathBuf;

use umbrage::diag::Failure;
use umbrage::picture::plot;

/// A measurement: its name, and what runs it.
type Part = (&'static str, fn(&Plots) -> Result<(), Failure>);

const PARTS: [Part; 8] = [
    ("blurs", blurs::blurs),
    ("kernels", pictures::kernels),
    ("split", pictures::split),
    ("slopes", pictures::slopes),
    ("slabs", pictures::slabs),
    ("samples", cost::samples),
    ("cost", cost::cost),
    ("memory", cost::memory),
];

/// The place of plots, if any are wanted.
struct Plots(Option<PathBuf>);

impl Plots {
    /// Writes a plot.
    fn lines(&self, name: &str, title: &str, [x, y]: [(&str, plot::Scale); 2], series: &[plot::Series]) {
        let Some(directory) = &self.0 else { return };
        let axis = |(label, scale): (&str, plot::Scale)| plot::Axis { label: label.to_owned(), scale };
        let frame = plot::Frame { title: title.to_owned(), x: axis(x), y: axis(y), size: (560, 360) };
        let path = directory.join(name).with_extension("svg");
        let written = fs::create_dir_all(directory).and_then(|()| fs::write(&path, plot::lines(&frame, series)));
        written.unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    }
}

/// Points of a plot with a name.
fn series(name: &str, points: Vec<(f64, f64)>) -> plot::Series {
    plot::Series { name: name.to_owned(), points }
}

fn main() -> Result<(), Failure> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    // `cargo test` runs benchmarks too, only to see whether they run.
    if !arguments.iter().any(|argument| argument == "--bench") {
        return Ok(());
    }
    let plots = arguments.iter().position(|argument| argument == "--plots").map(|at| at + 1);
    let directory = plots.and_then(|at| arguments.get(at)).map(PathBuf::from);
    let named = |name: &str| arguments.iter().any(|argument| argument == name);
    let all = !PARTS.iter().any(|(name, _)| named(name));
    for (name, run) in PARTS.iter().filter(|(name, _)| all || named(name)) {
        println!("## {name}\n");
        run(&Plots(directory.clone()))?;
        println!();
    }
    Ok(())
}
