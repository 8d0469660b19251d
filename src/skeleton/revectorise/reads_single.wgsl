// Edges and runs by single reads, one texel at a time, as the authors' shaders do it.

// Whether walks note breaks.
const WALKS_BREAK: bool = false;

fn counts(c: Centre, offset: vec2<i32>) -> bool {
    return opposite(c, offset) && !(ISOLATED_SIDES && isolated(c, offset));
}

// The edge at a texel, with its depth test.
fn look(at: Centre) -> Edge {
    var c = at;
    c.lit = c.z <= depth(c.texel);
    if (LIT_ONLY && !c.lit) {
        return Edge(c, NONE, NONE, vec4<bool>(false));
    }
    let H = select(0u, RIGHT, counts(c, vec2<i32>(1, 0))) | select(0u, LEFT, counts(c, vec2<i32>(-1, 0)));
    let V = select(0u, TOP, counts(c, vec2<i32>(0, -1))) | select(0u, BOTTOM, counts(c, vec2<i32>(0, 1)));
    return Edge(c, H, V, vec4<bool>(false));
}

// Whether a texel diagonally beside an edge is opposite.
fn corner_opposite(e: Edge, offset: vec2<i32>) -> bool {
    return opposite(e.c, offset);
}

// The depth test of a walk. It lifts the receiver a little where that is about to
// shadow itself, if it may.
fn walk_test(c: Centre, lift: ptr<function, f32>, offset: vec2<i32>, may_lift: bool) -> bool {
    let there = depth(c.texel + offset);
    let z = plane(c.z, c.slope, offset);
    if (may_lift && abs((z - *lift) - there) < frame.walk_bias) {
        *lift = *lift + frame.walk_bias;
    }
    return (z - *lift <= there) != c.lit;
}

// The end of a run in one direction.
fn walk(c: Centre, axis: Axis, direction: i32) -> i32 {
    var lift = 0.0;
    for (var k = 1; k <= frame.limit; k++) {
        count_step();
        let here = axis.along * (direction * k);
        if (walk_test(c, &lift, here, c.lit)) {
            return select(k, -k, ISOLATED_ENDS && isolated(c, here));
        }
        var goes_on = false;
        if (axis.before != 0u) {
            goes_on = walk_test(c, &lift, here - axis.across, !c.lit);
        }
        if (axis.after != 0u && !goes_on) {
            goes_on = walk_test(c, &lift, here + axis.across, !c.lit);
        }
        if (!goes_on) {
            return -k;
        }
    }
    return 0;
}

fn ends(c: Centre, axis: Axis) -> Ends {
    return Ends(vec2<i32>(walk(c, axis, -1), walk(c, axis, 1)), vec2<u32>(0u));
}

fn runs(e: Edge, place: vec2<f32>) -> Runs {
    var found = Runs(no_run(), no_run());
    if (e.V != NONE) {
        found.horizontal = measured(ends(e.c, row(e)), place.x);
    }
    if (e.H != NONE) {
        found.vertical = measured(ends(e.c, column(e)), place.y);
    }
    return found;
}
