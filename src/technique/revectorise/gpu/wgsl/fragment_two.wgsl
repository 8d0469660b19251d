// Two draws: the first looks at every pixel and marks those at silhouettes in the
// depth buffer; the depth test lets the second see only those.

@vertex
fn cover(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(f32(index & 1u) * 4.0 - 1.0, f32(index >> 1u) * 4.0 - 1.0, 0.5, 1.0);
}

struct Marked {
    @location(0) value: f32,
    @builtin(frag_depth) mark: f32,
}

@fragment
fn glance_pass(@builtin(position) position: vec4<f32>) -> Marked {
    let seen = glance(vec2<u32>(position.xy));
    return Marked(seen.value, f32(seen.edge));
}

@fragment
fn visibility_pass(@builtin(position) position: vec4<f32>) -> @location(0) f32 {
    return visibility(vec2<u32>(position.xy)).value;
}
