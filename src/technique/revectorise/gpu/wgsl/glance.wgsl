// Whether a pixel is at a silhouette at all: most are not, and are done.

struct Glance {
    value: f32,
    edge: bool,
}

fn glance(pixel: vec2<u32>) -> Glance {
    let point = textureLoad(points, pixel, 0);
    if (point.w != KIND_FACING) {
        return Glance(select(1.0, 0.0, point.w == KIND_AWAY), false);
    }
    let c = centre(point, textureLoad(slopes, pixel, 0).xy);
    let upper = gather(c.texel);
    let lower = gather(c.texel + 1);
    let lit = c.z <= upper.y;
    // Of right, left, top and bottom.
    let around = vec4<f32>(lower.z, upper.x, upper.z, lower.x);
    let planes = c.z + vec4<f32>(c.slope.x, -c.slope.x, -c.slope.y, c.slope.y);
    let sides = (planes <= around) != vec4<bool>(lit);
    return Glance(f32(lit), any(sides) && (lit || !LIT_ONLY));
}
