//! The tables of triangles against a plain enumeration of all their states, and against geometry.

use std::collections::BTreeSet;

use glam::DVec2;

use super::super::super::sampling::Stream;
use super::super::tables::{Tables, label};

const NAMES: [&str; 6] = ["C000", "C011", "C112", "C022", "C222", "C002"];

fn tables() -> Tables {
    Tables::new().unwrap_or_else(|e| panic!("{e}"))
}

/// Configuration and rotation by counting, as the text of the paper has them.
fn counted(seen: [bool; 3], twice: [bool; 3]) -> (&'static str, usize) {
    let equal = |a: usize, b: usize| seen[a] == seen[b];
    let is_two = |edge: usize| twice[edge] && equal(edge, (edge + 1) % 3);
    let twos: Vec<usize> = (0..3).filter(|edge| is_two(*edge)).collect();
    let odd = (0..3).find(|vertex| !equal(*vertex, (vertex + 1) % 3) && !equal(*vertex, (vertex + 2) % 3));
    match (odd, &twos[..]) {
        (None, []) => ("C000", 0),
        (None, [edge]) => ("C002", *edge),
        // The vertex where the two edges meet.
        (None, [a, b]) => ("C022", if (*a, *b) == (0, 2) { 0 } else { *b }),
        (None, _) => ("C222", 0),
        (Some(vertex), []) => ("C011", vertex),
        (Some(vertex), _) => ("C112", vertex),
    }
}

/// A state of a triangle: vertices and edges.
fn state(bits: usize) -> ([bool; 3], [bool; 3]) {
    let bit = |index: usize| bits >> index & 1 == 1;
    ([bit(0), bit(1), bit(2)], [bit(3), bit(4), bit(5)])
}

#[test]
fn all_64_states_have_the_configuration_that_counting_gives() {
    let tables = tables();
    let mut kinds = BTreeSet::new();
    for bits in 0..64 {
        let (seen, twice) = state(bits);
        let (configuration, rotation) = tables.configuration(seen, twice);
        assert_eq!((tables.name(configuration), rotation), counted(seen, twice), "{seen:?} {twice:?}");
        assert_eq!(tables.name(configuration), NAMES[configuration]);
        let twice: [bool; 3] = std::array::from_fn(|edge| twice[edge] && seen[edge] == seen[(edge + 1) % 3]);
        kinds.insert((seen, twice));
    }
    assert_eq!(kinds.len(), 28);
}

/// A triangle with random places of discontinuities and points.
struct Sample {
    points: [DVec2; label::COUNT],
}

fn signed_area(corners: &[DVec2]) -> f64 {
    let next = corners.iter().cycle().skip(1);
    0.5 * corners.iter().zip(next).map(|(a, b)| a.perp_dot(*b)).sum::<f64>()
}

/// Points of a state, with interior points beyond their chords.
fn sample(configuration: &str, rotation: usize, stream: &mut Stream) -> Sample {
    let vertices = [DVec2::new(0.0, 0.0), DVec2::new(1.0, 0.1), DVec2::new(0.2, 1.0)];
    let mut points = [DVec2::NAN; label::COUNT];
    let mut between = |lo: f64, hi: f64| lo + (hi - lo) * stream.uniform();
    for edge in 0..3 {
        let (from, to) = (vertices[edge], vertices[(edge + 1) % 3]);
        let (a, b) = (between(0.05, 0.45), between(0.55, 0.95));
        points[label::V + edge] = from;
        points[label::B + edge] = from.lerp(to, b);
        // Of edges at an odd vertex the only discontinuity lies anywhere.
        let only = configuration == "C011" || (configuration == "C112" && edge != (rotation + 1) % 3);
        points[label::A + edge] = from.lerp(to, if only { between(0.05, 0.95) } else { a });
    }
    let label_of = |first: usize, canonical: usize| first + (canonical + rotation) % 3;
    let at = |points: &[DVec2; label::COUNT], first: usize, canonical: usize| points[label_of(first, canonical)];
    points[label::K] = 0.5 * (at(&points, label::A, 0) + at(&points, label::B, 0));
    points[label::H] = points[label::K].lerp(at(&points, label::V, 2), between(0.2, 0.8));
    // Beyond a chord, on a ray from the apex: between the chord and the far edge.
    let mut beyond = |apex: DVec2, far: [DVec2; 2], chord: [DVec2; 2], f: f64| {
        let share = |index: usize| (chord[index] - apex).length() / (far[index] - apex).length();
        let (along, from, to) = (1.0 / ((1.0 - f) / share(0) + f / share(1)), apex, far[0].lerp(far[1], f));
        from.lerp(to, along + (1.0 - along) * between(0.05, 0.6))
    };
    let v = |points: &[DVec2; label::COUNT], canonical| at(points, label::V, canonical);
    let f = 0.5;
    match configuration {
        "C011" => {
            let chord = [at(&points, label::A, 0), at(&points, label::A, 2)];
            points[label::X] = beyond(v(&points, 0), [v(&points, 1), v(&points, 2)], chord, f);
        }
        "C022" => {
            let chord = [at(&points, label::B, 0), at(&points, label::A, 2)];
            points[label::X] = beyond(v(&points, 0), [v(&points, 1), v(&points, 2)], chord, f);
        }
        "C002" => {
            let (apex, h) = (points[label::K], points[label::H]);
            let (a, b) = (at(&points, label::A, 0), at(&points, label::B, 0));
            points[label::X] = beyond(apex, [v(&points, 2), v(&points, 0)], [h, a], f);
            points[label::Y] = beyond(apex, [v(&points, 1), v(&points, 2)], [b, h], f);
        }
        _ => {}
    }
    Sample { points }
}

impl Sample {
    fn of(&self, labels: &[usize]) -> Vec<DVec2> {
        labels.iter().map(|label| self.points[*label]).collect()
    }

    /// The area of loops, each of which has to be there, go counter-clockwise and not cross itself.
    fn area(&self, loops: &[Vec<usize>], what: &str) -> f64 {
        let own = |labels: &Vec<usize>| {
            let corners = self.of(labels);
            assert!(corners.iter().all(|corner| corner.is_finite()), "{what}: {labels:?}");
            assert_eq!(labels.iter().collect::<BTreeSet<_>>().len(), labels.len(), "{what}: {labels:?}");
            let area = signed_area(&corners);
            assert!(area > 0.0 && is_simple(&corners), "{what}: {labels:?} {area}");
            area
        };
        loops.iter().map(own).sum()
    }
}

/// Returns whether no two edges of a loop that are not neighbours meet.
fn is_simple(corners: &[DVec2]) -> bool {
    let count = corners.len();
    let edge = |index: usize| (corners[index], corners[(index + 1) % count]);
    let side = |(a, b): (DVec2, DVec2), c: DVec2| (b - a).perp_dot(c - a);
    let cross = |i: usize, j: usize| {
        let (e, f) = (edge(i), edge(j));
        side(e, f.0) * side(e, f.1) < 0.0 && side(f, e.0) * side(f, e.1) < 0.0
    };
    (0..count).all(|i| (i + 2..count).all(|j| (i == 0 && j == count - 1) || !cross(i, j)))
}

#[test]
fn visible_and_hidden_parts_tile_the_triangle_whatever_the_discontinuities() {
    let tables = tables();
    let mut stream = Stream::new([1, 2], 3, 4);
    let mut rows = 0;
    for (configuration, name) in NAMES.iter().enumerate() {
        let turns = if matches!(*name, "C000" | "C222") { 1 } else { 3 };
        let interiors: &[[bool; 2]] = match *name {
            "C011" | "C022" => &[[false, false], [true, false]],
            "C002" => &[[false, false], [true, false], [false, true], [true, true]],
            _ => &[[false, false]],
        };
        for (rotation, interior) in (0..turns).flat_map(|turn| interiors.iter().map(move |interior| (turn, interior))) {
            rows += 2;
            for _ in 0..50 {
                let sample = sample(name, rotation, &mut stream);
                let whole = signed_area(&sample.points[..3]);
                let parts = [0, 1].map(|lit| {
                    let what = format!("{name} {rotation} {interior:?} {lit}");
                    let (loops, triangles) = tables.region([configuration, rotation, lit], *interior);
                    let area = sample.area(&loops, &what);
                    let areas: Vec<f64> = triangles.iter().map(|labels| signed_area(&sample.of(labels))).collect();
                    assert!(areas.iter().all(|area| *area >= 0.0), "{what}: {areas:?}");
                    assert!((areas.iter().sum::<f64>() - area).abs() < 1e-12, "{what}: {areas:?} {area}");
                    area
                });
                assert!((parts[0] + parts[1] - whole).abs() < 1e-12, "{name} {rotation} {interior:?}: {parts:?}");
            }
        }
    }
    assert_eq!(rows, 58);
}

#[test]
fn curves_of_no_points_and_of_one_are_the_regions_without_and_with_closest_points() {
    let tables = tables();
    for (configuration, name) in NAMES.iter().enumerate() {
        for lit in 0..2 {
            let state = [configuration, 0, lit];
            assert_eq!(tables.loops(state, 0), tables.region(state, [false; 2]).0, "{name}");
            let (with, mut of_one) = (tables.region(state, [true, *name == "C002"]).0, tables.loops(state, 1));
            for label in of_one.iter_mut().flatten().filter(|label| **label == label::Y_OF_RAYS) {
                *label = label::Y;
            }
            // A strip has a near curve as well, which the paper leaves straight.
            if *name == "C022" {
                of_one.iter_mut().for_each(|labels| labels.retain(|label| *label != label::Y));
            }
            assert_eq!(of_one, with, "{name}");
            // Longer curves have their points in order, one way on one side and the other way on the other.
            let points = |labels: &[usize], first: usize| {
                labels.iter().copied().filter(|label| (first..first + 5).contains(label)).collect::<Vec<usize>>()
            };
            for first in [label::X, label::Y_OF_RAYS] {
                for labels in tables.loops(state, 5) {
                    let of = points(&labels, first);
                    let ascending: Vec<usize> = (first..first + 5).collect();
                    let descending: Vec<usize> = ascending.iter().rev().copied().collect();
                    assert!(of.is_empty() || of == ascending || of == descending, "{name}: {labels:?}");
                }
            }
        }
    }
}

#[test]
fn turning_a_triangle_turns_its_parts() {
    let tables = tables();
    let turned = |label: usize, by: usize| if label < label::K { label / 3 * 3 + (label + by) % 3 } else { label };
    for (configuration, name) in NAMES.iter().enumerate() {
        for (rotation, lit) in (1..3).flat_map(|rotation| [(rotation, 0), (rotation, 1)]) {
            if matches!(*name, "C000" | "C222") {
                continue;
            }
            let turn = |loops: Vec<Vec<usize>>| -> Vec<Vec<usize>> {
                let labels = |labels: Vec<usize>| labels.into_iter().map(|label| turned(label, rotation)).collect();
                loops.into_iter().map(labels).collect()
            };
            for interior in [[false, false], [true, false], [false, true], [true, true]] {
                let (loops, triangles) = tables.region([configuration, rotation, lit], interior);
                let first = tables.region([configuration, 0, lit], interior);
                assert_eq!(loops, turn(first.0));
                assert_eq!(
                    triangles,
                    first.1.iter().map(|labels| labels.map(|label| turned(label, rotation))).collect::<Vec<_>>()
                );
            }
            for points in 0..=5 {
                assert_eq!(
                    tables.loops([configuration, rotation, lit], points),
                    turn(tables.loops([configuration, 0, lit], points))
                );
            }
        }
    }
}
