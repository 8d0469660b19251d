// Edges and runs by gathers, four texels at a time.
//
// Two gathers see a texel and its four neighbours, which is the end of it for
// most pixels. Along a run one gather sees two texels of it and the two beside.

// Whether walks note breaks.
const WALKS_BREAK: bool = true;

// The edge at a texel, with its depth test.
fn look(at: Centre) -> Edge {
    var c = at;
    let upper = gather(c.texel);
    let lower = gather(c.texel + 1);
    c.lit = c.z <= upper.y;
    if (LIT_ONLY && !c.lit) {
        return Edge(c, NONE, NONE, vec4<bool>(false));
    }
    // Of right, left, top and bottom.
    let planes = c.z + vec4<f32>(c.slope.x, -c.slope.x, -c.slope.y, c.slope.y);
    let around = vec4<f32>(lower.z, upper.x, upper.z, lower.x);
    var sides = (planes <= around) != vec4<bool>(c.lit);
    if (!any(sides)) {
        return Edge(c, NONE, NONE, vec4<bool>(false));
    }
    let upper_left = (plane(c.z, c.slope, vec2<i32>(-1, -1)) <= upper.w) != c.lit;
    let lower_right = (plane(c.z, c.slope, vec2<i32>(1, 1)) <= lower.y) != c.lit;
    var corners = vec4<bool>(upper_left, false, false, lower_right);
    // An opposite texel with another one beside it does not stand alone.
    let doubtful = ISOLATED_SIDES && any(sides & !vec4<bool>(lower_right, upper_left, upper_left, lower_right));
    let two_sides = NEEDS_NEIGHBOURS && ((sides.x && sides.y) || (sides.z && sides.w));
    let corner = reads_dominance() && sides.x != sides.y && sides.z != sides.w;
    if (doubtful || two_sides || corner) {
        corners.y = (plane(c.z, c.slope, vec2<i32>(1, -1)) <= gather(c.texel + vec2<i32>(1, 0)).z) != c.lit;
        corners.z = (plane(c.z, c.slope, vec2<i32>(-1, 1)) <= gather(c.texel + vec2<i32>(0, 1)).x) != c.lit;
    }
    if (doubtful) {
        let alone = sides & !(corners.yxxz | corners.wzyw);
        sides.x = sides.x && (!alone.x || opposite(c, vec2<i32>(2, 0)));
        sides.y = sides.y && (!alone.y || opposite(c, vec2<i32>(-2, 0)));
        sides.z = sides.z && (!alone.z || opposite(c, vec2<i32>(0, -2)));
        sides.w = sides.w && (!alone.w || opposite(c, vec2<i32>(0, 2)));
    }
    let H = select(0u, RIGHT, sides.x) | select(0u, LEFT, sides.y);
    let V = select(0u, TOP, sides.z) | select(0u, BOTTOM, sides.w);
    return Edge(c, H, V, corners);
}

// Whether a texel diagonally beside an edge is opposite.
fn corner_opposite(e: Edge, offset: vec2<i32>) -> bool {
    let row = select(e.corners.xy, e.corners.zw, offset.y > 0);
    return select(row.x, row.y, offset.x > 0);
}

// Depths of two texels in a row or column, the nearer one first, and of the two beside them.
struct Pair {
    own: vec2<f32>,
    side: vec2<f32>,
}

fn pair(c: Centre, axis: Axis, direction: i32, k: i32, side: i32) -> Pair {
    // The corner between steps k and k + 1, and between the run and its side.
    let along = select(-k, k + 1, direction > 0);
    let across = select(0, 1, side > 0);
    let seen = gather(c.texel + axis.along * along + axis.across * across);
    // As if the run went along a row.
    let four = select(seen.zyxw, seen, axis.along.x == 1);
    let own = select(four.xy, four.wz, side > 0);
    let beside = select(four.wz, four.xy, side > 0);
    return Pair(select(own.yx, own, direction > 0), select(beside.yx, beside, direction > 0));
}

// A walk in one direction.
struct Walk {
    // As in Ends.
    steps: i32,
    break_at: u32,
    // How far the receiver is lifted.
    lift: f32,
    // Whether the opposite texel at the end has another one beside it.
    accompanied: bool,
}

// The depth test of a walk that lifts the receiver where it is about to shadow itself, if it may.
fn lifted_test(c: Centre, lift: ptr<function, f32>, z: f32, there: f32, may_lift: bool) -> bool {
    if (may_lift && abs((z - *lift) - there) < frame.walk_bias) {
        *lift = *lift + frame.walk_bias;
    }
    return (z - *lift <= there) != c.lit;
}

// Step k of a walk, `here` from the edge: depths of the texel and of the two beside it.
fn one_step(c: Centre, walk: ptr<function, Walk>, axis: Axis, here: vec2<i32>, k: i32, own: f32, before: f32, after: f32) {
    let z = plane(c.z, c.slope, here);
    let z_before = plane(c.z, c.slope, here - axis.across);
    let z_after = plane(c.z, c.slope, here + axis.across);
    var ends = (z <= own) != c.lit;
    let left = select(0u, axis.before, (z_before <= before) != c.lit) | select(0u, axis.after, (z_after <= after) != c.lit);
    var goes_on = left != 0u;
    if (frame.walk_bias > 0.0) {
        var lift = (*walk).lift;
        ends = lifted_test(c, &lift, z, own, c.lit);
        goes_on = false;
        if (!ends && axis.before != 0u) {
            goes_on = lifted_test(c, &lift, z_before, before, !c.lit);
        }
        if (!ends && axis.after != 0u && !goes_on) {
            goes_on = lifted_test(c, &lift, z_after, after, !c.lit);
        }
        (*walk).lift = lift;
    }
    if (ends) {
        (*walk).steps = k;
        (*walk).accompanied = left != 0u && frame.walk_bias == 0.0;
    } else if (!goes_on) {
        (*walk).steps = -k;
    }
    if (!ends && left != (axis.before | axis.after) && (*walk).break_at == 0u) {
        (*walk).break_at = 4u * u32(k) + left;
    }
}

// Two steps of a walk.
fn two_steps(c: Centre, walk: ptr<function, Walk>, axis: Axis, direction: i32, k: i32) {
    count_step();
    let first = pair(c, axis, direction, k, select(-1, 1, axis.after != 0u));
    var second = first;
    if (axis.before != 0u && axis.after != 0u) {
        second = pair(c, axis, direction, k, -1);
    }
    let here = axis.along * (direction * k);
    one_step(c, walk, axis, here, k, first.own.x, second.side.x, first.side.x);
    if ((*walk).steps == 0) {
        one_step(c, walk, axis, here + axis.along * direction, k + 1, first.own.y, second.side.y, first.side.y);
    }
}

// A texel that stands alone ends a run like one that lost the edge.
fn without_isolated(c: Centre, walk: Walk, towards: vec2<i32>) -> Walk {
    var result = walk;
    if (ISOLATED_ENDS && walk.steps > 0 && !walk.accompanied && isolated(c, towards * walk.steps)) {
        result.steps = -walk.steps;
        if (walk.break_at == 0u) {
            result.break_at = 4u * u32(walk.steps) + NONE;
        }
    }
    return result;
}

// Both walks in one loop: their gathers do not wait for each other, and
// neighbouring pixels, which share a run, stay together.
fn ends(c: Centre, axis: Axis) -> Ends {
    var before = Walk(0, 0u, 0.0, false);
    var after = before;
    // An end just beyond the limit makes the run too long like one that is not found.
    for (var k = 1; k <= frame.limit && (before.steps == 0 || after.steps == 0); k += 2) {
        if (before.steps == 0) {
            two_steps(c, &before, axis, -1, k);
        }
        if (after.steps == 0) {
            two_steps(c, &after, axis, 1, k);
        }
    }
    before = without_isolated(c, before, -axis.along);
    after = without_isolated(c, after, axis.along);
    return Ends(vec2<i32>(before.steps, after.steps), vec2<u32>(before.break_at, after.break_at));
}

// The only run of most edges is walked by the same code, whichever its axis, so
// that pixels at horizontal and at vertical edges stay together, too.
fn runs(e: Edge, place: vec2<f32>) -> Runs {
    let upright = e.V == NONE;
    var axis = row(e);
    if (upright) {
        axis = column(e);
    }
    let first = measured(ends(e.c, axis), select(place.x, place.y, upright));
    if (upright) {
        return Runs(no_run(), first);
    }
    var second = no_run();
    if (e.H != NONE && !first.endless) {
        second = measured(ends(e.c, column(e)), place.y);
    }
    return Runs(first, second);
}
