// The last pass: the technique's visibility of every pixel, and the light that
// it lets through; or the case that every pixel took.

// Whether cases are shown and counted.
override CASES: bool = false;

// As geometry.wgsl left them.
@group(1) @binding(0) var colours: texture_2d<f32>;
// A colour for each case of the table, the last one for the default.
@group(1) @binding(1) var<storage, read> palette: array<vec4<f32>>;
// How many pixels took each case.
@group(1) @binding(2) var<storage, read_write> counts: array<atomic<u32>>;

@vertex
fn cover(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(f32(index & 1u) * 4.0 - 1.0, f32(index >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn light(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let pixel = vec2<u32>(position.xy);
    let found = visibility(pixel);
    let surface = textureLoad(colours, pixel, 0);
    let lit = surface.rgb * (1.0 + surface.a * found.value);
    if (!CASES) {
        return vec4<f32>(lit, 1.0);
    }
    if (found.key == NO_TABLE) {
        return vec4<f32>(vec3<f32>(0.05 + 0.4 * dot(lit, vec3<f32>(0.2126, 0.7152, 0.0722))), 1.0);
    }
    let entry = min(found.case_id, arrayLength(&palette) - 1u);
    atomicAdd(&counts[entry], 1u);
    return palette[entry];
}
