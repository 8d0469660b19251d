// Dominance at corners.

struct Dominance {
    H: bool,
    V: bool,
}

// The horizontal discontinuity dominates where the neighbour opposite to the
// vertical one has it, too; and the other way round.
fn dominance(e: Edge) -> Dominance {
    if (!is_corner(e)) {
        return Dominance(false, false);
    }
    if (!READ_DOMINANCE) {
        // Both: the table then takes the minimum or maximum over the two runs, which
        // on every map is the same value (a run without dominance has length 1).
        return Dominance(true, true);
    }
    let behind_H = vec2<i32>(select(1, -1, e.H == RIGHT), 0);
    let behind_V = vec2<i32>(0, select(-1, 1, e.V == TOP));
    return Dominance(
        opposite(e.c, behind_V + vec2<i32>(1, 0)) || opposite(e.c, behind_V + vec2<i32>(-1, 0)),
        opposite(e.c, behind_H + vec2<i32>(0, 1)) || opposite(e.c, behind_H + vec2<i32>(0, -1)),
    );
}
