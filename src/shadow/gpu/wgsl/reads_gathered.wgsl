// Edges and runs by gathers, four texels at a time.
//
// Two gathers see a texel and its four neighbours, which is the end of it for
// most pixels. Along a run one gather sees two texels of it and the two beside.

// The edge at a texel, with its depth test.
fn look(at: Centre) -> Edge {
    var c = at;
    let upper = gather(c.texel);
    let lower = gather(c.texel + 1);
    c.lit = c.z <= upper.y;
    if (LIT_ONLY && !c.lit) {
        return Edge(c, NONE, NONE);
    }
    // Of right, left, top and bottom.
    let planes = c.z + vec4<f32>(c.slope.x, -c.slope.x, -c.slope.y, c.slope.y);
    let around = vec4<f32>(lower.z, upper.x, upper.z, lower.x);
    var sides = (planes <= around) != vec4<bool>(c.lit);
    if (!any(sides)) {
        return Edge(c, NONE, NONE);
    }
    if (ISOLATED_SIDES) {
        // Beside an opposite texel another one: it does not stand alone, and no more is read.
        let before = (plane(c.z, c.slope, vec2<i32>(-1, -1)) <= upper.w) == c.lit;
        let after = (plane(c.z, c.slope, vec2<i32>(1, 1)) <= lower.y) == c.lit;
        let doubtful = sides & vec4<bool>(after, before, before, after);
        if (any(doubtful)) {
            sides.x = sides.x && !(doubtful.x && isolated(c, vec2<i32>(1, 0)));
            sides.y = sides.y && !(doubtful.y && isolated(c, vec2<i32>(-1, 0)));
            sides.z = sides.z && !(doubtful.z && isolated(c, vec2<i32>(0, -1)));
            sides.w = sides.w && !(doubtful.w && isolated(c, vec2<i32>(0, 1)));
        }
    }
    return Edge(c, u32(sides.x) * RIGHT + u32(sides.y) * LEFT, u32(sides.z) * TOP + u32(sides.w) * BOTTOM);
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

// The depth test of a walk. It lifts the receiver a little where that is about to
// shadow itself, if it may.
fn walk_test(c: Centre, lift: ptr<function, f32>, offset: vec2<i32>, there: f32, may_lift: bool) -> bool {
    let z = plane(c.z, c.slope, offset);
    if (may_lift && abs((z - *lift) - there) < frame.walk_bias) {
        *lift = *lift + frame.walk_bias;
    }
    return (z - *lift <= there) != c.lit;
}

// Whether a walk ends at step k, and with which sign: zero if it goes on.
fn one_step(c: Centre, lift: ptr<function, f32>, axis: Axis, here: vec2<i32>, k: i32, own: f32, before: f32, after: f32) -> i32 {
    if (walk_test(c, lift, here, own, c.lit)) {
        return select(k, -k, ISOLATED_ENDS && isolated(c, here));
    }
    var goes_on = false;
    if (axis.before) {
        goes_on = walk_test(c, lift, here - axis.across, before, !c.lit);
    }
    if (axis.after && !goes_on) {
        goes_on = walk_test(c, lift, here + axis.across, after, !c.lit);
    }
    return select(-k, 0, goes_on);
}

// Two steps of a walk.
fn two_steps(c: Centre, lift: ptr<function, f32>, axis: Axis, direction: i32, k: i32) -> i32 {
    count_step();
    let first = pair(c, axis, direction, k, select(-1, 1, axis.after));
    var second = first;
    if (axis.before && axis.after) {
        second = pair(c, axis, direction, k, -1);
    }
    let here = axis.along * (direction * k);
    let near = one_step(c, lift, axis, here, k, first.own.x, second.side.x, first.side.x);
    if (near != 0) {
        return near;
    }
    return one_step(c, lift, axis, here + axis.along * direction, k + 1, first.own.y, second.side.y, first.side.y);
}

// The ends of a run: the steps to each, with its sign; zero if there is none
// within the limit. Both in one loop: its gathers do not wait for each other,
// and neighbouring pixels, whose runs are the same, stay together.
fn ends(c: Centre, axis: Axis) -> vec2<i32> {
    var before = 0;
    var after = 0;
    var lift_before = 0.0;
    var lift_after = 0.0;
    // An end just beyond the limit makes the run too long like one that is not found.
    for (var k = 1; k <= frame.limit && (before == 0 || after == 0); k += 2) {
        if (before == 0) {
            before = two_steps(c, &lift_before, axis, -1, k);
        }
        if (after == 0) {
            after = two_steps(c, &lift_after, axis, 1, k);
        }
    }
    return vec2<i32>(before, after);
}
