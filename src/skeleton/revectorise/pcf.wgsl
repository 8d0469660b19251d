// The mean of depth tests in a square of texels.

fn shade(point: vec4<f32>, pixel: vec2<u32>) -> Sample {
    let c = centre(point, textureLoad(slopes, pixel, 0).xy);
    let reach = frame.reach;
    var lit = 0u;
    for (var y = -reach; y <= reach; y++) {
        for (var x = -reach; x <= reach; x++) {
            let offset = vec2<i32>(x, y);
            lit += u32(plane(c.z, c.slope, offset) <= depth(c.texel + offset));
        }
    }
    let side = 2 * reach + 1;
    return Sample(f32(lit) / f32(side * side), NO_TABLE, NO_TABLE);
}
