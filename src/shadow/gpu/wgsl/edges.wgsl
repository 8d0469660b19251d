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
}

// An axis of the map, seen from an edge: the run goes along it, and the sides
// that make the run an edge lie across.
struct Axis {
    along: vec2<i32>,
    across: vec2<i32>,
    // Whether the sides towards smaller and larger coordinates are opposite.
    before: bool,
    after: bool,
}

struct Run {
    kind: u32,
    // 0 at the negative end, 1 at the positive end.
    position: f32,
    // Whether an end was not found, or the run is longer than the limit.
    endless: bool,
}

// The row through an edge: its run goes left and right.
fn row(e: Edge) -> Axis {
    return Axis(vec2<i32>(1, 0), vec2<i32>(0, 1), (e.V & TOP) != 0u, (e.V & BOTTOM) != 0u);
}

// The column through an edge: its run goes up and down.
fn column(e: Edge) -> Axis {
    return Axis(vec2<i32>(0, 1), vec2<i32>(1, 0), (e.H & LEFT) != 0u, (e.H & RIGHT) != 0u);
}

fn is_corner(e: Edge) -> bool {
    return (e.H == LEFT || e.H == RIGHT) && (e.V == TOP || e.V == BOTTOM);
}

// Whether the ends of a run (the steps to each with its sign, zero if there is
// none within the limit) make it longer than the limit.
fn endless(ends: vec2<i32>) -> bool {
    return ends.x == 0 || ends.y == 0 || abs(ends.x) + abs(ends.y) - 1 > frame.limit;
}

// From a place in the texel to the borders of both end texels.
fn distances(ends: vec2<i32>, t: f32) -> vec2<f32> {
    return vec2<f32>(f32(abs(ends.x) - 1) + t, f32(abs(ends.y)) - t);
}

// The run along an axis; `t` is the place in the texel along it.
fn run(c: Centre, axis: Axis, t: f32) -> Run {
    let found = ends(c, axis);
    if (endless(found)) {
        return Run(POSITIVE_NEGATIVE, 0.0, true);
    }
    if (found.x < 0 && found.y < 0) {
        return Run(DUAL_NEGATIVE, 0.0, false);
    }
    let length = f32(abs(found.x) + abs(found.y) - 1);
    let away = distances(found, t);
    if (found.x > 0 && found.y > 0) {
        return Run(DUAL_POSITIVE, clamp(1.5 - max(away.x, away.y) / length, 0.0, 1.0), false);
    }
    let positive = select(away.y, away.x, found.x > 0);
    return Run(POSITIVE_NEGATIVE, clamp(1.0 - positive / length, 0.0, 1.0), false);
}

// A run that is not walked.
fn no_run() -> Run {
    return Run(POSITIVE_NEGATIVE, 0.0, false);
}
