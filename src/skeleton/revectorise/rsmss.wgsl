// RSMSS: what stands around the table `rsmss`, and what it fetches.

const LIT_ONLY: bool = false;
// A texel that stands alone is no silhouette.
const ISOLATED_SIDES: bool = true;
const ISOLATED_ENDS: bool = true;
const NEEDS_NEIGHBOURS: bool = true;

fn revectorise(at: Centre) -> Sample {
    let e = look(at);
    let plain = Sample(f32(e.c.lit), NO_TABLE, NO_TABLE);
    if (e.H == NONE && e.V == NONE) {
        return plain;
    }
    let found = runs(e, at.place);
    if (found.horizontal.endless || found.vertical.endless) {
        return plain;
    }
    var site = RsmssSite(e, found.horizontal.breaks);
    if (e.H == BOTH) {
        site.breaks = found.vertical.breaks;
    }
    if ((e.H == BOTH) != (e.V == BOTH) && (!WALKS_BREAK || frame.walk_bias > 0.0)) {
        site.breaks = searched_breaks(e);
    }
    let dom = dominance(e);
    let b = select(1u, 0u, e.c.lit);
    let key = table_key(e.H, e.V, b, found.horizontal.kind, found.vertical.kind, dom.x, dom.y);
    let result = rsmss_key_case(key, found.horizontal.position, found.vertical.position, at.place.x, at.place.y, site);
    return Sample(result.value, result.case_id, key);
}

// What a fetch needs to know.
struct RsmssSite {
    edge: Edge,
    // As in Ends, of the run between two sides: the walk passed there and needs no second search.
    breaks: vec2<u32>,
}

const TO_RIGHT: vec2<i32> = vec2<i32>(1, 0);
const TO_TOP: vec2<i32> = vec2<i32>(0, -1);

// The sides of a neighbour that are opposite to the edge's texel: `first` is the side of level 1, right or top.
fn neighbour(e: Edge, offset: vec2<i32>, first: vec2<i32>) -> u32 {
    return u32(corner_opposite(e, offset + first)) + 2u * u32(corner_opposite(e, offset - first));
}

fn rsmss_fetch_n_top(site: RsmssSite) -> u32 { return neighbour(site.edge, TO_TOP, TO_RIGHT); }
fn rsmss_fetch_n_bottom(site: RsmssSite) -> u32 { return neighbour(site.edge, -TO_TOP, TO_RIGHT); }
fn rsmss_fetch_n_left(site: RsmssSite) -> u32 { return neighbour(site.edge, -TO_RIGHT, TO_TOP); }
fn rsmss_fetch_n_right(site: RsmssSite) -> u32 { return neighbour(site.edge, TO_RIGHT, TO_TOP); }

// Breaks by a search of their own, in both directions: for walks that do not
// note them, or that go another way because they lift the receiver.
fn searched_breaks(e: Edge) -> vec2<u32> {
    let upright = e.H == BOTH;
    let along = select(TO_RIGHT, -TO_TOP, upright);
    let first = select(TO_TOP, TO_RIGHT, upright);
    var found = vec2<u32>(0u);
    for (var direction = -1; direction <= 1; direction += 2) {
        var break_at = 0u;
        for (var k = 1; k <= frame.limit + 1 && break_at == 0u; k++) {
            count_step();
            let here = along * (direction * k);
            if (opposite(e.c, here) && !isolated(e.c, here)) {
                break;
            }
            let sides = u32(opposite(e.c, here + first)) + 2u * u32(opposite(e.c, here - first));
            if (k > frame.limit) {
                break_at = 4u * u32(k) + NONE;
            } else if (sides != BOTH) {
                break_at = 4u * u32(k) + sides;
            }
        }
        if (direction < 0) {
            found.x = break_at;
        } else {
            found.y = break_at;
        }
    }
    return found;
}

// The level of a break; both where there is none.
fn break_level(break_at: u32) -> u32 {
    return select(break_at & 3u, BOTH, break_at == 0u);
}

// A break, if that in the other direction is not nearer.
fn nearer_break(here: u32, there: u32) -> u32 {
    return select(BOTH, break_level(here), there == 0u || (here >> 2u) <= (there >> 2u));
}

// Away from a one-sided discontinuity, else the nearest break; of equally near ones the sides that both have left.
fn deciding_break(site: RsmssSite, across: u32, small: u32, large: u32) -> u32 {
    let found = site.breaks;
    if (across == small) {
        return break_level(found.y);
    }
    if (across == large) {
        return break_level(found.x);
    }
    return nearer_break(found.x, found.y) & nearer_break(found.y, found.x);
}

fn rsmss_fetch_d_cb_h(site: RsmssSite) -> u32 { return deciding_break(site, site.edge.V, TOP, BOTTOM); }
fn rsmss_fetch_d_cb_v(site: RsmssSite) -> u32 { return deciding_break(site, site.edge.H, LEFT, RIGHT); }
fn rsmss_fetch_d_cb_top(site: RsmssSite) -> u32 { return nearer_break(site.breaks.x, site.breaks.y); }
fn rsmss_fetch_d_cb_bottom(site: RsmssSite) -> u32 { return nearer_break(site.breaks.y, site.breaks.x); }
fn rsmss_fetch_d_cb_left(site: RsmssSite) -> u32 { return nearer_break(site.breaks.x, site.breaks.y); }
fn rsmss_fetch_d_cb_right(site: RsmssSite) -> u32 { return nearer_break(site.breaks.y, site.breaks.x); }
