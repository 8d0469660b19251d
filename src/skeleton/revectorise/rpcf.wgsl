// The mean of revectorised results in a square of texels; the case is the centre's.

fn shade(point: vec4<f32>, pixel: vec2<u32>) -> Sample {
    let c = centre(point, textureLoad(slopes, pixel, 0).xy);
    let reach = frame.reach;
    var sum = 0.0;
    var middle = Sample(0.0, NO_TABLE, NO_TABLE);
    for (var y = -reach; y <= reach; y++) {
        for (var x = -reach; x <= reach; x++) {
            let sample = revectorise(moved(c, vec2<i32>(x, y)));
            sum += sample.value;
            if (x == 0 && y == 0) {
                middle = sample;
            }
        }
    }
    let side = 2 * reach + 1;
    return Sample(sum / f32(side * side), middle.case_id, middle.key);
}
