//! U0506, U0512: declared symmetries that the table does not have everywhere.
//!
//! If a case contradicts its image, one of the two is wrong, and a pair alone
//! does not say which. But the images of the images have a say as well: if most
//! agree, the case in the minority is the one to mend, and the others say how.
//! Symmetries that leave the result alone are asked first; only if they are
//! undecided do those that change it (light and shadow exchanged) vote too.

use std::collections::{BTreeMap, BTreeSet};

use super::{Analysis, Run};
use crate::analyse::sets::Set;
use crate::analyse::sets::space::View;
use crate::analyse::sets::study::{Piece, Study};
use crate::analyse::values::orbit;
use crate::analyse::values::orbit::Orbit;
use crate::analyse::values::point::Point;
use crate::analyse::words;
use crate::diag::{Diagnostic, Span, codes};
use crate::program::{ExprId, InputSet, Program, Symmetry};
use crate::show::{self, Precision};

/// Two pieces of a program that contradict each other under a symmetry.
struct Contradiction {
    symmetry: usize,
    rows: (Option<usize>, Option<usize>),
    set: Set,
}

/// A case, or the default, and the line that gives its value, or the default.
type Place = (Option<usize>, Option<usize>);

/// A line that disagrees with most of its images.
struct Odd {
    point: Point,
    votes: (usize, usize),
    along: Vec<usize>,
    /// The lines that most images follow.
    against: BTreeSet<Place>,
}

/// Cases that contradict each other undecidedly.
struct Torn {
    point: Point,
    along: Vec<usize>,
    /// The lines that do so, with what they give.
    lines: BTreeMap<Place, BTreeSet<String>>,
}

/// Rows; `None` is the default.
type Rows = Vec<Option<usize>>;

/// The codes that are found here, and how.
pub(in crate::analyse) const ANALYSIS: Analysis = Analysis {
    codes: &[codes::SYMMETRY_BROKEN, codes::SYMMETRY_ASSUMED, codes::NOT_ANALYSED],
    run: Run::Sets(findings),
};

/// A warning for each line that most of its images contradict, and for cases
/// that contradict each other undecidedly; a note where only assumptions help.
fn findings(study: &mut Study<'_>) -> Vec<Diagnostic> {
    let program = study.program;
    let mut odd: BTreeMap<Place, Odd> = BTreeMap::new();
    let mut torn: BTreeMap<(Rows, Rows), Torn> = BTreeMap::new();
    // By the symmetry and the first of the two rows, in the order written.
    let mut assumed: BTreeMap<(Option<usize>, usize), Vec<Contradiction>> = BTreeMap::new();
    let all: Vec<usize> = (0..program.symmetries.len()).collect();
    let plain: Vec<usize> = all.iter().copied().filter(|s| program.symmetries[*s].result.is_none()).collect();
    // Nobody said what becomes of a level or a vector, unless the symmetry says it.
    let says = |number: &usize| program.output.is_number() || program.symmetries[*number].result.is_some();
    let (all, plain): (Vec<usize>, Vec<usize>) =
        (all.into_iter().filter(says).collect(), plain.into_iter().filter(says).collect());
    let mut found: Vec<Diagnostic> = Vec::new();
    for number in all.clone() {
        let mut open: Vec<Option<usize>> = Vec::new();
        let (broken, saved) = contradictions(study, number);
        for contradiction in saved {
            let (a, b) = contradiction.rows;
            let group = assumed.entry((a.min(b), number)).or_default();
            if group.iter().all(|other| other.rows != (b, a) && other.rows != (a, b)) {
                group.push(contradiction);
            }
        }
        for contradiction in broken {
            let Some(witness) = study.space.witness(contradiction.set) else { continue };
            if !witness.certain {
                open.extend([contradiction.rows.0, contradiction.rows.1]);
            }
            let start = Point::of(program, &witness);
            let changes = program.symmetries[number].result.is_some();
            let near = Orbit::new(program, start.clone(), &plain);
            if changes {
                // Whose own images disagree has been reported for that.
                let far = Orbit::new(program, start.image(&program.pool, &program.symmetries[number]), &plain);
                if !near.is_unanimous() || !far.is_unanimous() {
                    continue;
                }
            }
            if !changes && near.is_unanimous() {
                continue;
            }
            if !witness.certain {
                open.truncate(open.len() - 2);
            }
            let wide = Orbit::new(program, start.clone(), &all);
            // Others may settle what the nearest images leave open, but only by taking one of their sides.
            let sides_with_near = |orbit: &Orbit| {
                let mut camp = orbit.camps[0].iter().map(|member| &orbit.members[*member].point);
                camp.any(|point| near.members.iter().any(|member| member.point == *point))
            };
            let verdict = match (changes, near.has_majority()) {
                (true, _) => None,
                (false, true) => Some((&near, &plain)),
                (false, false) if wide.has_majority() && sides_with_near(&wide) => Some((&wide, &all)),
                (false, false) => None,
            };
            if let Some((orbit, along)) = verdict {
                let votes = (orbit.camps[0].len(), orbit.members.len());
                for member in orbit.camps[1..].iter().flatten() {
                    let member = &orbit.members[*member];
                    let place = (member.outcome.row, member.outcome.line);
                    let odd = odd.entry(place).or_insert_with(|| Odd {
                        point: member.point.clone(),
                        votes,
                        along: along.clone(),
                        against: BTreeSet::new(),
                    });
                    odd.against.extend(orbit.places(0));
                }
                continue;
            }
            let (orbit, along) = if changes { (&wide, &all) } else { (&near, &plain) };
            if orbit.is_unanimous() {
                continue;
            }
            let rows = |camp: usize| {
                let mut rows: Vec<Option<usize>> = orbit.places(camp).into_iter().map(|(row, _)| row).collect();
                rows.dedup();
                rows
            };
            let key = (rows(0).min(rows(1)), rows(0).max(rows(1)));
            let own = &orbit.members[0].outcome;
            let place = (own.row, own.line);
            let gives = given(study, place, &start);
            let gives = written(study, &gives);
            let torn =
                torn.entry(key).or_insert_with(|| Torn { point: start, along: along.clone(), lines: BTreeMap::new() });
            torn.lines.entry(place).or_default().insert(gives);
        }
        found.extend(not_decided(program, number, open));
    }
    for (place, odd) in odd {
        found.extend(odd_one_out(study, place, &odd));
    }
    for ((first, second), torn) in &torn {
        found.extend(undecided(study, (first, second), torn));
    }
    found.extend(assumed.into_values().filter_map(|group| only_assumed(study, &group)));
    found
}

/// A note on cases whose values are not linear, and for which no point was found at which they contradict their images.
fn not_decided(program: &Program, symmetry: usize, mut rows: Vec<Option<usize>>) -> Option<Diagnostic> {
    rows.sort_unstable();
    rows.dedup();
    let symmetry = &program.symmetries[symmetry];
    let message = format!("whether `{}` holds everywhere was not decided", symmetry.name);
    let note = Diagnostic::note(codes::NOT_ANALYSED, message).at(symmetry.span, "");
    let help = format!("of {}: there it takes more than linear arithmetic", words::cases(program, &rows));
    (!rows.is_empty()).then(|| note.help(help))
}

/// Finds contradictions of a symmetry: on inputs that the assumptions admit
/// with their images, and then pairs of rows for which this only happens on others.
fn contradictions(study: &mut Study<'_>, number: usize) -> (Vec<Contradiction>, Vec<Contradiction>) {
    let symmetry = &study.program.symmetries[number];
    let view = study.space.view(&symmetry.levels, &symmetry.numbers, View::PLAIN);
    let (images, image_assumed) = study.seen(view);
    let inside = study.inside(&symmetry.numbers);
    let admitted = study.space.sets.and(study.assumed, image_assumed);
    let (mut broken, mut saved) = (Vec::new(), Vec::new());
    for piece in study.pieces.clone() {
        for image in &images {
            let both = study.space.sets.and(piece.set, image.set);
            let both = study.space.sets.and(both, inside);
            if both.is_empty() {
                continue;
            }
            let different = differ(study, symmetry, &piece, image);
            let set = study.space.sets.and(both, different);
            if study.space.is_void(set) {
                continue;
            }
            let occurs = study.space.sets.and(set, admitted);
            let rows = (piece.row, image.row);
            match study.space.is_void(occurs) {
                true => saved.push(Contradiction { symmetry: number, rows, set }),
                false => broken.push(Contradiction { symmetry: number, rows, set: occurs }),
            }
        }
    }
    let is_broken = |rows| broken.iter().any(|other: &Contradiction| other.rows == rows);
    saved.retain(|contradiction| !is_broken(contradiction.rows));
    (broken, saved)
}

/// The set where a value is not that of the image, mapped as results are.
fn differ(study: &mut Study<'_>, symmetry: &Symmetry, piece: &Piece, image: &Piece) -> Set {
    match &symmetry.result {
        None => study.space.different(&piece.values, &image.values),
        Some(map) => {
            let said = study.space.with_result(map, &image.values);
            study.space.different(&piece.values, &said)
        }
    }
}

/// The line that gives the value at a place, or what stands in for it.
fn span(program: &Program, (row, line): Place, otherwise: Span) -> Span {
    match (row.map(|row| &program.rows[row]), line) {
        (Some(row), Some(line)) => row.lines[line].span,
        (Some(row), None) => row.lines.last().map_or(row.span, |line| line.span),
        (None, _) => otherwise,
    }
}

/// The symmetries that an argument rests on.
fn by(program: &Program, along: &[usize]) -> String {
    let names: Vec<String> = along.iter().map(|number| format!("`{}`", program.symmetries[*number].name)).collect();
    words::list(&names)
}

/// A point as `explain` takes it, without fetched inputs that no line of the case reads.
fn place_at(study: &Study<'_>, point: &Point, row: Option<usize>) -> String {
    let program = study.program;
    let pool = &program.pool;
    let read = match row {
        None => program.default.iter().fold(Default::default(), |all: InputSet, v| all.or(pool.expr_facts(*v).inputs)),
        Some(row) => words::mentioned(program, row),
    };
    words::at(program, &point.witness(program, &vec![true; program.inputs.len()]), read).unwrap_or_default()
}

/// The values at a place, with their selections decided at a point.
fn given(study: &mut Study<'_>, (row, line): Place, point: &Point) -> Vec<ExprId> {
    let program = study.program;
    let values = match row.zip(line) {
        Some((row, line)) => &program.rows[row].lines[line].values,
        None => &program.default,
    };
    values.iter().map(|value| orbit::chosen(&mut study.space.pool, *value, point)).collect()
}

fn odd_one_out(study: &mut Study<'_>, place: Place, odd: &Odd) -> Option<Diagnostic> {
    let program = study.program;
    let orbit = Orbit::new(program, odd.point.clone(), &odd.along);
    let opponent = orbit.opponent()?;
    let (row, line) = place;
    let wrong = given(study, place, &odd.point);
    let right = orbit::expected(study, opponent)?;
    let (was, should) = (written(study, &wrong), written(study, &right));
    let name = words::called(program, place);
    let (most, total) = odd.votes;
    let message = format!("{name} is the odd one out: {most} of {total} images agree on another value");
    let other = (opponent.outcome.row, opponent.outcome.line);
    let symmetric = program.symmetries[odd.along[0]].span;
    let mut warning = Diagnostic::warning(codes::SYMMETRY_BROKEN, message)
        .at(span(program, place, symmetric), format!("here it gives {was}"));
    if other.0 != row || other.1 != line {
        warning = warning
            .at(span(program, other, symmetric), format!("{} says {should} for it", words::called(program, other)));
    }
    let own = &orbit.members[0];
    let what = format!(
        "at {} it gives {}, its images under {} say {}",
        place_at(study, &odd.point, row),
        short(program, &own.says),
        by(program, &odd.along),
        short(program, &opponent.says)
    );
    let against = odd.against.iter().map(|other| format!("against {}", words::named(program, *other)));
    let warning = warning.about([format!("{was}, not {should}")]).about(against);
    Some(warning.help(what).help(match line {
        Some(_) => format!("to mend it, write `{should}` for `{was}` there"),
        None => format!("to mend it, add a line that gives `{should}` there"),
    }))
}

fn undecided(
    study: &mut Study<'_>,
    (first, second): (&[Option<usize>], &[Option<usize>]),
    Torn { point, along, lines }: &Torn,
) -> Option<Diagnostic> {
    let program = study.program;
    let orbit = Orbit::new(program, point.clone(), along);
    let opponent = orbit.opponent()?;
    let own = &orbit.members[0];
    let (here, there) = ((own.outcome.row, own.outcome.line), (opponent.outcome.row, opponent.outcome.line));
    let should = orbit::expected(study, opponent)?;
    let should = written(study, &should);
    let mut rows: Vec<Option<usize>> = first.iter().chain(second).copied().collect();
    rows.sort_unstable();
    rows.dedup();
    let names = words::cases(program, &rows);
    let message = match rows.len() {
        1 => format!("{names} contradicts its own image"),
        _ => format!("{names} contradict each other as images"),
    };
    let symmetric = program.symmetries[along[0]].span;
    let mut warning = Diagnostic::warning(codes::SYMMETRY_BROKEN, message).at(
        span(program, here, symmetric),
        format!("{} gives {} here", words::called(program, here), short(program, &own.says)),
    );
    if there != here {
        warning = warning.at(
            span(program, there, symmetric),
            format!(
                "{} says {} for the same, that is {should}",
                words::called(program, there),
                short(program, &opponent.says)
            ),
        );
    }
    let at = place_at(study, point, here.0);
    let about = lines.iter().map(|(place, gives)| {
        let gives: Vec<&str> = gives.iter().map(String::as_str).collect();
        format!("{} gives {}", words::named(program, *place), gives.join(" or "))
    });
    Some(
        warning
            .about(about)
            .help(format!("at {at}, under {}", by(program, along)))
            .help("as many images say the one as the other: mend one of them, or acknowledge that they differ"),
    )
}

/// A result as one says it.
fn short(program: &Program, values: &[f64]) -> String {
    match program.output.is_real() {
        true => values.iter().map(|value| words::short(*value)).collect::<Vec<_>>().join(", "),
        false => show::expression(&program.output, values, Precision::F32),
    }
}

/// A result as one writes it down: levels by name.
fn written(study: &mut Study<'_>, values: &[ExprId]) -> String {
    let output = &study.program.output;
    let constants: Option<Vec<f64>> = values.iter().map(|value| study.space.pool.constant(*value)).collect();
    match constants.filter(|_| !output.is_real()) {
        Some(constants) => show::expression(output, &constants, Precision::F32),
        None => words::simplified(&mut study.space, values),
    }
}

/// A note on rows that contradict one row only where no assumption admits it.
fn only_assumed(study: &mut Study<'_>, group: &[Contradiction]) -> Option<Diagnostic> {
    let program = study.program;
    let contradiction = group.first()?;
    let symmetry = &program.symmetries[contradiction.symmetry];
    let row = contradiction.rows.0.min(contradiction.rows.1);
    let mut others: Vec<Option<usize>> = group.iter().map(|pair| pair.rows.0.max(pair.rows.1)).collect();
    others.sort_unstable();
    others.dedup();
    let name = words::cases(program, &[row]);
    let message = match others.as_slice() {
        [one] if *one == row => format!("{name} is its own image under `{}` by assumption only", symmetry.name),
        _ => format!("{name} agrees with its images under `{}` by assumption only: {}", symmetry.name, {
            words::cases(program, &others)
        }),
    };
    let blamed: Vec<String> = study.blame(contradiction.set).into_iter().map(|name| format!("`{name}`")).collect();
    let span = row.map_or(symmetry.span, |row| program.rows[row].guard_span);
    let note = Diagnostic::note(codes::SYMMETRY_ASSUMED, message).at(span, "");
    let taken = match blamed.is_empty() {
        // The image of an assumption rules it out.
        true => "it takes the assumptions for the inputs and for their images".to_owned(),
        false => format!("it takes {}", words::list(&blamed)),
    };
    let mut about: Vec<String> = others.iter().map(|other| words::cases(program, &[*other])).collect();
    for contradiction in group {
        about.extend(study.blame(contradiction.set).into_iter().map(str::to_owned));
    }
    let note = note.about([symmetry.name.clone()]).about(about);
    let witness = study.space.witness(contradiction.set)?;
    let differ = if witness.certain {
        let at = place_at(study, &Point::of(program, &witness), contradiction.rows.0);
        format!("otherwise they differ, for instance at {at}")
    } else {
        "otherwise they may differ".to_owned()
    };
    Some(note.help(taken).help(differ))
}

#[cfg(test)]
mod tests {
    use crate::analyse::found;

    fn mirrored(value: &str) -> Vec<String> {
        let all = found(&format!(
            r#"Table(language: 1, name: "t", hit_policy: First,
                inputs: {{"s": Levels(values: {{"left": 0, "right": 1}}), "x": Range(from: 0, to: 1)}},
                symmetries: {{
                    "mirror": Symmetry(map: {{"s": {{"left": "right", "right": "left"}}, "x": "1 - x"}}),
                    "swap": Symmetry(map: {{"x": "1 - x"}}, result: "1 - value"),
                }},
                output: Number(clamp: (0, 1)),
                cases: [Case(id: 1, when: "s == left || s == right", value: "{value}")],
                default: 0)"#
        ));
        all.into_iter().filter(|finding| finding.starts_with("U0506")).collect()
    }

    #[test]
    fn broken_symmetries_are_found() {
        assert_eq!(mirrored("if s == left { 2 * x } else { 2 - 2 * x }"), ["U0506 case 1 contradicts its own image"]);
        assert_eq!(mirrored("if s == left { x } else { x }"), ["U0506 case 1 contradicts its own image"]);
        // Equal only once clamped, and only because x ends at 1.
        assert_eq!(mirrored("if s == left { min(x, 1) } else { max(1 - x, 0) }"), [""; 0]);
        assert_eq!(mirrored("if x < 0.5 { 0.25 } else { if x == 0.5 { 0.5 } else { 0.75 } }").len(), 1);
    }
}
