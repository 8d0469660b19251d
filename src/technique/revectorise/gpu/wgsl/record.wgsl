// One thread per pixel, which writes down all there is to know.

@group(1) @binding(0) var<storage, read_write> values: array<f32>;
// For each pixel: case, key, reads, steps.
@group(1) @binding(1) var<storage, read_write> records: array<vec4<u32>>;

@compute @workgroup_size(8, 8)
fn visibility_pass(@builtin(global_invocation_id) id: vec3<u32>) {
    if (all(id.xy < frame.pixels)) {
        let at = id.y * frame.pixels.x + id.x;
        let sample = visibility(id.xy);
        values[at] = sample.value;
        records[at] = vec4<u32>(sample.case_id, sample.key, reads, steps);
    }
}
