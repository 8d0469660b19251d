// Discontinuities and runs: what revectorisation knows of a silhouette.
//
// Levels of H: none 0, right 1, left 2, both 3; of V: none 0, top 1, bottom 2,
// both 3. Rows grow downwards.

const NONE: u32 = 0u;
const RIGHT: u32 = 1u;
const LEFT: u32 = 2u;
const TOP: u32 = 1u;
const BOTTOM: u32 = 2u;
const BOTH: u32 = 3u;

// Types of run.
const DUAL_NEGATIVE: u32 = 0u;
const POSITIVE_NEGATIVE: u32 = 1u;
const DUAL_POSITIVE: u32 = 2u;

// A texel and the sides of it that are opposite.
struct Edge {
    c: Centre,
    H: u32,
    V: u32,
    // Which of upper left, upper right, lower left and lower right texel are
    // opposite; only where they were needed.
    corners: vec4<bool>,
}

// An axis of the map, seen from an edge: the run goes along it, and the sides
// that make the run an edge lie across.
struct Axis {
    along: vec2<i32>,
    across: vec2<i32>,
    // The levels of the sides towards smaller and larger coordinates, zero where they are not opposite.
    before: u32,
    after: u32,
}

// The ends of a run.
struct Ends {
    // The number of steps towards smaller and larger coordinates: positive where
    // an opposite texel ends the run, negative where the edge is lost, zero where
    // there is no end within the limit.
    steps: vec2<i32>,
    // Of an edge with two sides, where it first does not have both: four times
    // the steps, and the level of the sides that are left; zero if that is nowhere.
    breaks: vec2<u32>,
}

struct Run {
    kind: u32,
    // 0 at the negative end, 1 at the positive end.
    position: f32,
    // Whether an end was not found, or the run is longer than the limit.
    endless: bool,
    breaks: vec2<u32>,
}

// The runs of an edge along rows and columns.
struct Runs {
    horizontal: Run,
    vertical: Run,
}

// The row through an edge: its run goes left and right.
fn row(e: Edge) -> Axis {
    return Axis(vec2<i32>(1, 0), vec2<i32>(0, 1), e.V & TOP, e.V & BOTTOM);
}

// The column through an edge: its run goes up and down.
fn column(e: Edge) -> Axis {
    return Axis(vec2<i32>(0, 1), vec2<i32>(1, 0), e.H & LEFT, e.H & RIGHT);
}

// Whether it is to be read which discontinuity dominates at a corner. Where walks
// lift the receiver, a run without dominance may be longer than one texel, and
// the collapsed form does not hold.
fn reads_dominance() -> bool {
    return READ_DOMINANCE || frame.walk_bias > 0.0;
}

fn is_corner(H: u32, V: u32) -> bool {
    return (H == LEFT || H == RIGHT) && (V == TOP || V == BOTTOM);
}

// From a place in the texel to the borders of both end texels.
fn distances(steps: vec2<i32>, t: f32) -> vec2<f32> {
    return vec2<f32>(f32(abs(steps.x) - 1) + t, f32(abs(steps.y)) - t);
}

// A run that is not walked.
fn no_run() -> Run {
    return Run(POSITIVE_NEGATIVE, 0.0, false, vec2<u32>(0u));
}

// Type and position of a run; `t` is the place in the texel along it.
fn measured(ends: Ends, t: f32) -> Run {
    let steps = ends.steps;
    let length = abs(steps.x) + abs(steps.y) - 1;
    if (steps.x == 0 || steps.y == 0 || length > frame.limit) {
        return Run(POSITIVE_NEGATIVE, 0.0, true, ends.breaks);
    }
    if (steps.x < 0 && steps.y < 0) {
        return Run(DUAL_NEGATIVE, 0.0, false, ends.breaks);
    }
    let away = distances(steps, t);
    if (steps.x > 0 && steps.y > 0) {
        return Run(DUAL_POSITIVE, clamp(1.5 - max(away.x, away.y) / f32(length), 0.0, 1.0), false, ends.breaks);
    }
    let positive = select(away.y, away.x, steps.x > 0);
    return Run(POSITIVE_NEGATIVE, clamp(1.0 - positive / f32(length), 0.0, 1.0), false, ends.breaks);
}
