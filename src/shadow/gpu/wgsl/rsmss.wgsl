// RSMSS: what stands around the table `rsmss`, and what it fetches.

const LIT_ONLY: bool = false;
// A texel that stands alone is no silhouette.
const ISOLATED_SIDES: bool = true;
const ISOLATED_ENDS: bool = true;

fn revectorise(at: Centre) -> Sample {
    let e = look(at);
    if (e.H == NONE && e.V == NONE) {
        return Sample(f32(e.c.lit), NO_TABLE, NO_TABLE);
    }
    var horizontal = no_run();
    var vertical = no_run();
    if (e.V != NONE) {
        horizontal = run(e.c, row(e), at.place.x);
    }
    if (e.H != NONE) {
        vertical = run(e.c, column(e), at.place.y);
    }
    if (horizontal.endless || vertical.endless) {
        return Sample(f32(e.c.lit), NO_TABLE, NO_TABLE);
    }
    let dom = dominance(e);
    let b = select(1u, 0u, e.c.lit);
    let key = table_key(e.H, e.V, b, horizontal.kind, vertical.kind, dom.H, dom.V);
    let site = RsmssSite(e.c, e.H, e.V);
    let result = rsmss_key_case(key, horizontal.position, vertical.position, at.place.x, at.place.y, site);
    return Sample(result.value, result.case_id, key);
}

// What a fetch needs to know: the edge.
struct RsmssSite {
    c: Centre,
    H: u32,
    V: u32,
}

// The sides of a texel across a direction that are opposite to the centre, as a
// level of H or V: `first` is the side of level 1, right or top.
fn sides_at(c: Centre, offset: vec2<i32>, first: vec2<i32>) -> u32 {
    return u32(opposite(c, offset + first)) + 2u * u32(opposite(c, offset - first));
}

const TO_RIGHT: vec2<i32> = vec2<i32>(1, 0);
const TO_TOP: vec2<i32> = vec2<i32>(0, -1);

fn rsmss_fetch_n_top(site: RsmssSite) -> u32 { return sides_at(site.c, TO_TOP, TO_RIGHT); }
fn rsmss_fetch_n_bottom(site: RsmssSite) -> u32 { return sides_at(site.c, -TO_TOP, TO_RIGHT); }
fn rsmss_fetch_n_left(site: RsmssSite) -> u32 { return sides_at(site.c, -TO_RIGHT, TO_TOP); }
fn rsmss_fetch_n_right(site: RsmssSite) -> u32 { return sides_at(site.c, TO_RIGHT, TO_TOP); }

// Where an edge with two sides stops having both of them.
struct Break {
    distance: i32,
    // The sides that are left; both where the run ended without a break.
    level: u32,
}

fn break_towards(c: Centre, direction: vec2<i32>, first: vec2<i32>) -> Break {
    for (var k = 1; k <= frame.limit; k++) {
        count_step();
        let here = direction * k;
        if (opposite(c, here) && !isolated(c, here)) {
            return Break(frame.limit + 2, BOTH);
        }
        let sides = sides_at(c, here, first);
        if (sides != BOTH) {
            return Break(k, sides);
        }
    }
    return Break(frame.limit + 1, NONE);
}

// Of the breaks in both directions the nearer one; of equally near ones the sides that both have left.
fn nearer_break(c: Centre, direction: vec2<i32>, first: vec2<i32>) -> u32 {
    let one = break_towards(c, direction, first);
    let other = break_towards(c, -direction, first);
    if (one.distance == other.distance) {
        return one.level & other.level;
    }
    return select(other.level, one.level, one.distance < other.distance);
}

// The break in one direction, if the other one is not nearer.
fn first_break(c: Centre, direction: vec2<i32>, first: vec2<i32>) -> u32 {
    let one = break_towards(c, direction, first);
    let other = break_towards(c, -direction, first);
    return select(BOTH, one.level, one.distance <= other.distance);
}

fn rsmss_fetch_d_cb_h(site: RsmssSite) -> u32 {
    switch (site.V) {
        case TOP: { return break_towards(site.c, -TO_TOP, TO_RIGHT).level; }
        case BOTTOM: { return break_towards(site.c, TO_TOP, TO_RIGHT).level; }
        default: { return nearer_break(site.c, TO_TOP, TO_RIGHT); }
    }
}
fn rsmss_fetch_d_cb_v(site: RsmssSite) -> u32 {
    switch (site.H) {
        case RIGHT: { return break_towards(site.c, -TO_RIGHT, TO_TOP).level; }
        case LEFT: { return break_towards(site.c, TO_RIGHT, TO_TOP).level; }
        default: { return nearer_break(site.c, TO_RIGHT, TO_TOP); }
    }
}
fn rsmss_fetch_d_cb_top(site: RsmssSite) -> u32 { return first_break(site.c, TO_TOP, TO_RIGHT); }
fn rsmss_fetch_d_cb_bottom(site: RsmssSite) -> u32 { return first_break(site.c, -TO_TOP, TO_RIGHT); }
fn rsmss_fetch_d_cb_left(site: RsmssSite) -> u32 { return first_break(site.c, -TO_RIGHT, TO_TOP); }
fn rsmss_fetch_d_cb_right(site: RsmssSite) -> u32 { return first_break(site.c, TO_RIGHT, TO_TOP); }
