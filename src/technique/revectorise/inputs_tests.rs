use crate::technique::revectorise::cpu;
use crate::technique::revectorise::cpu::Query;
use crate::technique::revectorise::{Receiver, ReceiverKind, Receivers, Settings, ShadowMap, Variant, Visibility};

/// A map whose texels are in shadow where a condition holds at their centres, under a receiver between.
fn map(size: u32, shadow: impl Fn(f32, f32) -> bool) -> ShadowMap {
    let texel = |index: u32| match shadow((index % size) as f32 + 0.5, (index / size) as f32 + 0.5) {
        true => 0.25,
        false => 1.0,
    };
    ShadowMap { size, depth: (0..size * size).map(texel).collect() }
}

/// Receivers over the middle half of a map, `fine` to a texel in each direction, with their places in texels.
fn receivers(size: u32, fine: u32) -> (Receivers, Vec<[f32; 2]>) {
    let side = size / 2 * fine;
    let place = |index: u32| (size / 4) as f32 + (index as f32 + 0.5) / fine as f32;
    let places: Vec<[f32; 2]> = (0..side * side).map(|i| [place(i % side), place(i / side)]).collect();
    let receiver = |[x, y]: &[f32; 2]| Receiver {
        u: x / size as f32,
        v: y / size as f32,
        z: 0.5,
        kind: ReceiverKind::Facing,
        ..Receiver::default()
    };
    (Receivers { width: side, height: side, points: places.iter().map(receiver).collect() }, places)
}

fn visibility(variant: Variant, map: &ShadowMap, receivers: &Receivers) -> Visibility {
    let program = variant.program().expect("a table of this crate");
    let settings = Settings::default();
    let query = Query { map, receivers, settings: &settings };
    cpu::visibility(variant, program, query, &|_| ()).expect("its inputs are known")
}

/// The edge of a half plane as a technique shows it, against the true edge moved by `shift` texels.
struct Edge {
    /// Samples on the wrong side of the line.
    wrong: usize,
    /// The farthest of them, in texels.
    farthest: f32,
}

/// The line at `degrees` through the middle of a map: signed distance of a place, in texels.
fn line(degrees: f32) -> impl Fn(f32, f32) -> f32 {
    let (sin, cos) = degrees.to_radians().sin_cos();
    move |x, y| (x - 32.3) * cos + (y - 31.8) * sin
}

fn edge(degrees: f32, shift: f32, places: &[[f32; 2]], seen: &Visibility) -> Edge {
    let distance = line(degrees);
    let from_line = places.iter().zip(&seen.value).map(|([x, y], value)| (distance(*x, *y) - shift, *value >= 0.5));
    let wrong: Vec<f32> = from_line.filter(|(d, lit)| (*d >= 0.0) != *lit).map(|(d, _)| d.abs()).collect();
    Edge { wrong: wrong.len(), farthest: wrong.into_iter().fold(0.0, f32::max) }
}

const ANGLES: [f32; 9] = [3.0, 5.0, 11.0, 22.5, 30.0, 60.0, 77.0, 88.0, 101.0];

#[test]
fn revectorisation_makes_a_line_of_a_staircase() {
    for degrees in ANGLES {
        let distance = line(degrees);
        let map = map(64, |x, y| distance(x, y) < 0.0);
        let (receivers, places) = receivers(64, 8);
        let hard = edge(degrees, 0.0, &places, &visibility(Variant::Hard, &map, &receivers));
        // SMSR only adds shadow: its line goes through the lit corners, about half a texel away. Which of
        // these lines it is does not matter here.
        let smsr = visibility(Variant::Smsr, &map, &receivers);
        let shifts = (20..=60).map(|shift| edge(degrees, shift as f32 / 100.0, &places, &smsr));
        let smsr = shifts.min_by_key(|edge| edge.wrong).expect("there are some");
        let rsmss = edge(degrees, 0.0, &places, &visibility(Variant::Rsmss, &map, &receivers));
        let told = |edge: &Edge| format!("{} wrong, up to {:.2}", edge.wrong, edge.farthest);
        println!("{degrees:5}°: hard {}; smsr {}; rsmss {}", told(&hard), told(&smsr), told(&rsmss));
        for edge in [smsr, rsmss] {
            assert!(edge.wrong * 20 < hard.wrong * 9, "{degrees}°: {} of {}", edge.wrong, hard.wrong);
            assert!(edge.farthest < 0.8 * hard.farthest, "{degrees}°: {} of {}", edge.farthest, hard.farthest);
        }
    }
}

#[test]
fn soft_silhouettes_do_not_move_the_edge() {
    for degrees in ANGLES {
        let distance = line(degrees);
        let map = map(64, |x, y| distance(x, y) < 0.0);
        let (receivers, places) = receivers(64, 8);
        let lit = places.iter().filter(|[x, y]| distance(*x, *y) >= 0.0).count() as f32;
        let seen = visibility(Variant::Rsmss, &map, &receivers).value.iter().sum::<f32>();
        // The edge is at least 32 texels long, with 64 samples to a texel.
        let shift = (seen - lit) / (32.0 * 64.0);
        assert!(shift.abs() < 0.03, "{degrees}°: the edge moved by {shift} texels");
    }
}

#[test]
fn soft_silhouettes_are_continuous_on_a_staircase() {
    // Steps of 3 texels: within one texel the value changes by at most 1/8 × (1 + 1/3), and no more across a border.
    let map = map(64, |x, y| (y - 0.5) < ((x - 0.5) / 3.0).floor() + 20.0);
    let (receivers, _) = receivers(64, 8);
    let seen = visibility(Variant::Rsmss, &map, &receivers);
    let side = receivers.width as usize;
    let steps = seen.value.chunks(side).flat_map(|row| row.windows(2).map(|pair| (pair[0] - pair[1]).abs()));
    let down = (side..seen.value.len()).map(|i| (seen.value[i] - seen.value[i - side]).abs());
    let largest = steps.chain(down).fold(0.0, f32::max);
    assert!(largest < 0.17, "a jump of {largest}");
}

#[test]
fn a_run_longer_than_the_limit_keeps_the_plain_test() {
    let map = map(64, |x, y| (y - 0.5) < ((x - 0.5) / 20.0).floor() + 30.0);
    let (receivers, _) = receivers(64, 2);
    let program = Variant::Rsmss.program().expect("a table of this crate");
    let seen = |variant, limit| {
        let settings = Settings { search_limit: limit, ..Settings::default() };
        let query = Query { map: &map, receivers: &receivers, settings: &settings };
        cpu::visibility(variant, program, query, &|_| ()).expect("its inputs are known")
    };
    let hard = seen(Variant::Hard, 20);
    assert_eq!(seen(Variant::Rsmss, 19).value, hard.value);
    assert_ne!(seen(Variant::Rsmss, 20).value, hard.value);
}
