// One depth test.

fn shade(point: vec4<f32>, pixel: vec2<u32>) -> Sample {
    let c = centre(point, vec2<f32>(0.0));
    return Sample(select(0.0, 1.0, c.z <= depth(c.texel)), NO_TABLE, NO_TABLE);
}
