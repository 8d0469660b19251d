// The filtered formulation without cases that the authors published later. It
// walks from every edge in all four directions, one texel at a time.

const LIT_ONLY: bool = false;
// A texel that stands alone is an edge like any other, but no end of one.
const ISOLATED_SIDES: bool = false;
const ISOLATED_ENDS: bool = true;

// How far along an axis the fragment is from the positive end, relative to the
// run: 0 without a positive end, negative with two of them.
fn along_axis(found: vec2<i32>, t: f32) -> f32 {
    let length = f32(abs(found.x) + abs(found.y) - 1);
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
    let horizontal = ends(e.c, row(e));
    let vertical = ends(e.c, column(e));
    if (endless(horizontal) || endless(vertical)) {
        return Sample(plain, NO_TABLE, NO_TABLE);
    }
    let rx = along_axis(horizontal, at.place.x);
    let ry = along_axis(vertical, at.place.y);
    var value = plain;
    if (rx * ry < 0.0) {
        value = select(1.0 - max(rx, ry), max(rx, ry), e.c.lit);
    } else if (rx * ry != 0.0) {
        value = select(1.0 - (rx + ry), rx + ry, e.c.lit);
    }
    return Sample(clamp(value, 0.0, 1.0), NO_TABLE, NO_TABLE);
}
