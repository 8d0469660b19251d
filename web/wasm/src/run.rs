//! A table on the graphics device of the page: what is handed to it, and what is said of what comes back.
//!
//! The points are the pixels of a picture over two inputs. The page hands the words to WebGPU or
//! WebGL 2, and the words of the results back; the jury of `umbrage diff` judges them.

use serde_json::json;
use umbrage::atlas::{Scale, colour, spread};
use umbrage::diag::{Diagnostic, Failure, codes};
use umbrage::emit::kernel::columns::{Entry, Layout, WORKGROUP, buffer_name, wgsl_columns};
use umbrage::emit::kernel::fragments::{TEXELS, WORDS_PER_PASS, glsl_es_columns};
use umbrage::emit::lookup_words;
use umbrage::eval::{Batch, Columns, Results};
use umbrage::jury::{Jury, Outputs, Verdict, words};
use umbrage::plan::{KeyLayout, Plan};
use umbrage::program::{InputId, Program};

use crate::code::proved;
use crate::decision;
use crate::message::Message;

/// Largest side of a picture.
const MAX_SIDE: usize = 512;

/// A picture to be made: its points, and how they are handed over.
struct Picture {
    columns: Columns<f32>,
    entry: Entry,
}

impl Picture {
    fn of(program: &Program, message: &Message) -> Result<Self, Failure> {
        let side = message.number("side").clamp(1, MAX_SIDE) as u32;
        let mut point = decision::point(program, &message.json["point"])?;
        // Everything is given, as the host of a shader would be ready to give it.
        for (place, input) in point.iter_mut().zip(&program.inputs) {
            place.get_or_insert(decision::least(input));
        }
        let axis = |name: &str| program.input(message.text(name));
        let (across, down): (Option<InputId>, Option<InputId>) = (axis("across"), axis("down"));
        let pixels = (0..side).flat_map(|y| (0..side).map(move |x| (x, y)));
        let points = pixels.map(|(x, y)| spread(program, &point, [(across, x), (down, y)], side));
        let columns = Columns::from_rows(program, points).map_err(|error| {
            Failure::new(program.source.clone(), Diagnostic::error(codes::BAD_VALUE, error.to_string()))
        })?;
        let entry = if KeyLayout::new(program).is_ok() { Entry::Key } else { Entry::Levels };
        Ok(Self { columns, entry })
    }

    /// The colours of results, and the case of each, in bytes and words.
    fn colours(program: &Program, results: &Results<f32>) -> (Vec<u8>, Vec<u32>) {
        let scale = Scale::of(program);
        let mut pixels = Vec::with_capacity(4 * results.len());
        let mut cases = Vec::with_capacity(results.len());
        for point in 0..results.len() {
            let outcome = results.outcome(point);
            let [r, g, b] = colour(&program.output.read(&program.output.numbers(&outcome.values)), &scale);
            pixels.extend([r, g, b, 255]);
            cases.push(outcome.row.map_or(u32::MAX, |row| program.rows[row].id));
        }
        (pixels, cases)
    }
}

/// The shaders and the words for a picture, and the interpreter's picture.
pub(crate) fn run(program: &Program, message: &Message) -> Result<Message, Failure> {
    let proved = proved(program, message)?;
    let Picture { columns, entry } = Picture::of(program, message)?;
    let expected = Batch::new(program).evaluate(&columns).map_err(|missing| {
        let name = &program.inputs[missing.input.index()].name;
        Failure::new(program.source.clone(), Diagnostic::error(codes::NEEDS_FETCH, format!("`{name}` is absent")))
    })?;
    let (pixels, cases) = Picture::colours(program, &expected);
    let layout = Layout::new(program, entry);
    let plan: &Plan<'_> = proved.plan();
    let all = 0..columns.len();
    let names: Vec<_> = ["plain", "fetched", "lookup", "width"].map(|name| buffer_name(program, name)).into();
    let passes = (0..layout.out).step_by(WORDS_PER_PASS).map(|first| glsl_es_columns(&proved, entry, first));
    let answer = json!({
        "rows": columns.len(),
        "out": layout.out,
        "workgroup": WORKGROUP,
        "wgsl": wgsl_columns(&proved, entry),
        "passes": passes.collect::<Vec<_>>(),
        "texels": TEXELS,
        "uniforms": names,
        "plan": plan.shape.name(),
    });
    let mut answer = Message::of(answer)
        .with("pixels", &pixels)
        .with_words("cases", &cases)
        .with_words("plain", &words::plain_words(program, &plan.key, entry, &columns, all.clone()));
    if layout.fetched > 0 {
        answer = answer.with_words("fetched", &words::fetched_words(program, &columns, all));
    }
    if let Some(lookup) = lookup_words(plan) {
        answer = answer.with_words("lookup", &lookup);
    }
    Ok(answer)
}

/// The verdict on the words that came back, pixel by pixel, and their picture.
pub(crate) fn judge(program: &Program, message: &Message) -> Result<Message, Failure> {
    let proved = proved(program, message)?;
    let Picture { columns, entry } = Picture::of(program, message)?;
    let layout = Layout::new(program, entry);
    let results = message.words();
    if results.len() != layout.out * columns.len() {
        return Ok(Message::error("the device gave fewer results than there are points"));
    }
    let mut outputs = Outputs { values: vec![Vec::new(); layout.values], ..Outputs::default() };
    words::read(program, &layout, &results, &mut outputs);
    let mut jury = Jury::new(&proved);
    let verdicts = jury.hear(&columns, &outputs);
    let scale = Scale::of(program);
    let mut pixels = Vec::with_capacity(4 * columns.len());
    for point in 0..columns.len() {
        let values: Vec<f32> = outputs.values.iter().map(|component| component[point]).collect();
        let [r, g, b] = colour(&program.output.read(&program.output.numbers(&values)), &scale);
        pixels.extend([r, g, b, 255]);
    }
    let mark = |verdict: &Verdict| match verdict {
        Verdict::Equal => 0,
        Verdict::Admissible => 1,
        Verdict::Reordered => 2,
        Verdict::Offending => 3,
        Verdict::Excluded => 4,
    };
    let marks: Vec<u8> = verdicts.iter().map(mark).collect();
    let run = &jury.run;
    let offenders = run.offenders.iter().map(|one| json!({ "inputs": one.inputs, "reason": one.reason }));
    let answer = json!({
        "equal": run.bit_equal, "admissible": run.admissible, "reordered": run.reordered,
        "offending": run.offending, "excluded": run.excluded,
        "worst": if run.worst.is_finite() { json!(run.worst) } else { json!(null) },
        "offenders": offenders.collect::<Vec<_>>(),
    });
    Ok(Message::of(answer).with("pixels", &pixels).with("marks", &marks))
}
