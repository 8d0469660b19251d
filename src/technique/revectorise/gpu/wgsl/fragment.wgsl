// A triangle that covers the picture.

@vertex
fn cover(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(f32(index & 1u) * 4.0 - 1.0, f32(index >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn visibility_pass(@builtin(position) position: vec4<f32>) -> @location(0) f32 {
    return visibility(vec2<u32>(position.xy)).value;
}
