// The filtered formulation without cases that the authors published later. It
// walks from every edge in all four directions, one texel at a time.

const LIT_ONLY: bool = false;
// A texel that stands alone is an edge like any other, but no end of one.
const ISOLATED_SIDES: bool = false;
const ISOLATED_ENDS: bool = true;

// How far along an axis the fragment is from the positive end, relative to the
// run: 0 without a positive end, negative with two of them.
fn along_axis(steps: vec2<i32>, t: f32) -> f32 {
    // A walk without an end counts as one that lost its edge just past the limit.
    let found = select(steps, vec2<i32>(-frame.limit - 1), steps == vec2<i32>(0));
    let length = f32(min(abs(found.x) + abs(found.y) - 1, frame.limit));
    let away = distances(found, t);
    if (found.x < 0 && found.y < 0) {
        return 0.0;
    }
    if (found.x > 0 && found.y > 0) {
        return -4.0 * min(away.x, away.y) / length;
    }
    return select(away.y, away.x, found.x > 0) / length;
}

fn revectorise(at: Centre) -> Sample {
    let e = look(at);
    let plain = f32(e.c.lit);
    if (e.H == NONE && e.V == NONE) {
        return Sample(plain, NO_TABLE, NO_TABLE);
    }
    if (e.H == BOTH && e.V == BOTH) {
        return Sample(1.0 - plain, NO_TABLE, NO_TABLE);
    }
    let rx = along_axis(ends(e.c, row(e)).steps, at.place.x);
    let ry = along_axis(ends(e.c, column(e)).steps, at.place.y);
    var value = plain;
    if (rx * ry < 0.0) {
        value = select(1.0 - max(rx, ry), max(rx, ry), e.c.lit);
    } else if (rx * ry != 0.0) {
        value = select(1.0 - (rx + ry), rx + ry, e.c.lit);
    }
    return Sample(clamp(value, 0.0, 1.0), NO_TABLE, NO_TABLE);
}
