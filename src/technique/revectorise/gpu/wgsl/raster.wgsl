// What the light sees, and what the camera sees of the light's map.
//
// Depths come from the plane of the face, not from interpolation, so that the
// map and its receivers agree about them like those made by rays.

struct Target {
    // Texels per side of the map.
    size: f32,
    // Steepest slope of a receiver, per texel.
    max_slope: f32,
    // The unit of depths.
    unit: f32,
    // The bias: a constant, and a multiple of the slope per texel.
    constant: f32,
    slope: f32,
}

@group(0) @binding(0) var<uniform> goal: Target;

struct Vertex {
    @location(0) light: vec4<f32>,
    @location(1) camera: vec4<f32>,
    // Of the face, over the square of the light: a place and the depth there, and whether it faces the light.
    @location(2) anchor: vec4<f32>,
    // The change of depth across the square.
    @location(3) slope: vec2<f32>,
}

struct Corner {
    @builtin(position) position: vec4<f32>,
    @location(0) light: vec4<f32>,
    @location(1) @interpolate(flat) anchor: vec4<f32>,
    @location(2) @interpolate(flat) slope: vec2<f32>,
    @location(3) @interpolate(flat) face: u32,
}

@vertex
fn from_light(vertex: Vertex, @builtin(vertex_index) index: u32) -> Corner {
    return Corner(vertex.light, vertex.light, vertex.anchor, vertex.slope, index / 3u);
}

@vertex
fn from_camera(vertex: Vertex, @builtin(vertex_index) index: u32) -> Corner {
    return Corner(vertex.camera, vertex.light, vertex.anchor, vertex.slope, index / 3u);
}

// Rounds to the fixed point of depths.
fn fixed(depth: f32) -> f32 {
    return round(depth / goal.unit) * goal.unit;
}

fn depth_at(corner: Corner, place: vec2<f32>) -> f32 {
    return corner.anchor.z + dot(place - corner.anchor.xy, corner.slope);
}

@fragment
fn shadow_map(corner: Corner) -> @builtin(frag_depth) f32 {
    let steepest = max(abs(corner.slope.x), abs(corner.slope.y)) / goal.size;
    let bias = goal.constant * goal.unit + goal.slope * min(steepest, goal.max_slope);
    let depth = depth_at(corner, corner.position.xy / goal.size);
    return clamp(fixed(clamp(depth, 0.0, 1.0)) + bias, 0.0, 1.0);
}

struct Seen {
    // u, v, depth and kind.
    @location(0) point: vec4<f32>,
    @location(1) slope: vec2<f32>,
    // The face, counted from 1.
    @location(2) face: u32,
}

@fragment
fn receivers(corner: Corner) -> Seen {
    let face = corner.face + 1u;
    if (corner.anchor.w == 0.0 || corner.light.w <= 0.0) {
        // It faces away.
        return Seen(vec4<f32>(0.0, 0.0, 0.0, 2.0), vec2<f32>(0.0), face);
    }
    let clip = corner.light.xyz / corner.light.w;
    let place = vec2<f32>(0.5 + 0.5 * clip.x, 0.5 - 0.5 * clip.y);
    let centre = (floor(place * goal.size) + 0.5) / goal.size;
    let per_texel = corner.slope / goal.size;
    let bound = vec2<f32>(goal.max_slope);
    let limited = clamp(per_texel, -bound, bound);
    let slope = vec2<f32>(fixed(limited.x), fixed(limited.y));
    var depth = depth_at(corner, centre);
    if (any(abs(per_texel) > bound)) {
        // Too steep to be followed to the centre: as far as it goes.
        depth = clip.z + dot(slope, (centre - place) * goal.size);
    }
    return Seen(vec4<f32>(place, fixed(clamp(depth, 0.0, 1.0)), 1.0), slope, face);
}
