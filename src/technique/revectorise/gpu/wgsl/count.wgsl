// One thread per pixel, which counts the states that occur.

// For each key, the number of its pixels.
@group(1) @binding(0) var<storage, read_write> counts: array<atomic<u32>>;

@compute @workgroup_size(8, 8)
fn visibility_pass(@builtin(global_invocation_id) id: vec3<u32>) {
    if (all(id.xy < frame.pixels)) {
        let key = visibility(id.xy).key;
        if (key != NO_TABLE) {
            atomicAdd(&counts[key], 1u);
        }
    }
}
