// Dominance at corners: whether the horizontal, and whether the vertical
// discontinuity dominates.

// A discontinuity dominates where the neighbour opposite to the other one has it, too.
fn dominance(e: Edge) -> vec2<bool> {
    if (!is_corner(e.H, e.V)) {
        return vec2<bool>(false);
    }
    if (!reads_dominance()) {
        // Both: the table then takes the minimum or maximum over the two runs, which
        // on every map is the same value (a run without dominance has length 1).
        return vec2<bool>(true);
    }
    let x = select(1, -1, e.H == RIGHT);
    let y = select(-1, 1, e.V == TOP);
    return vec2<bool>(
        corner_opposite(e, vec2<i32>(1, y)) || corner_opposite(e, vec2<i32>(-1, y)),
        corner_opposite(e, vec2<i32>(x, 1)) || corner_opposite(e, vec2<i32>(x, -1)),
    );
}
