// One sample per pixel.

fn shade(point: vec4<f32>, pixel: vec2<u32>) -> Sample {
    return revectorise(centre(point, textureLoad(slopes, pixel, 0).xy));
}
