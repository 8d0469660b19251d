// One thread per pixel.

@group(1) @binding(0) var<storage, read_write> values: array<f32>;

@compute @workgroup_size(8, 8)
fn visibility_pass(@builtin(global_invocation_id) id: vec3<u32>) {
    if (all(id.xy < frame.pixels)) {
        values[id.y * frame.pixels.x + id.x] = visibility(id.xy).value;
    }
}
