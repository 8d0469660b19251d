// Two passes over the scene: what the light sees, and what the camera sees of
// the light's map.
//
// Depths come from the plane of the face, not from interpolation, so that the
// map and its receivers agree about them.

struct Stage {
    // World to the camera's clip space.
    camera: mat4x4<f32>,
    eye: vec3<f32>,
    // Texels per side of the map.
    size: f32,
    // Where a spot light is; unused for a light from far away.
    position: vec3<f32>,
    // Half the angle of a spot light's cone in radians; zero for a light from far away.
    cone: f32,
    // The way the light goes.
    direction: vec3<f32>,
    // The share of light that reaches shadows.
    ambient: f32,
    // The unit of depths, and the steepest slope of a receiver per texel.
    unit: f32,
    max_slope: f32,
    // The bias of the map: a constant, and a multiple of the slope per texel.
    bias: f32,
    slope_bias: f32,
}

@group(0) @binding(0) var<uniform> stage: Stage;

struct Vertex {
    @location(0) place: vec3<f32>,
    @location(1) normal: vec3<f32>,
    // The normal of the flat face.
    @location(2) face: vec3<f32>,
    @location(3) colour: vec3<f32>,
    // The place in the light's clip space.
    @location(4) light: vec4<f32>,
    // Of the face, over the square of the light: a place and the depth there; and 1, or 0 if it is edge-on.
    @location(5) anchor: vec4<f32>,
    // The change of depth across the square.
    @location(6) slope: vec2<f32>,
}

struct Corner {
    @builtin(position) position: vec4<f32>,
    @location(0) place: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) @interpolate(flat) face: vec3<f32>,
    @location(3) @interpolate(flat) colour: vec3<f32>,
    @location(4) light: vec4<f32>,
    @location(5) @interpolate(flat) anchor: vec4<f32>,
    @location(6) @interpolate(flat) slope: vec2<f32>,
}

@vertex
fn from_light(v: Vertex) -> Corner {
    return Corner(v.light, v.place, v.normal, v.face, v.colour, v.light, v.anchor, v.slope);
}

@vertex
fn from_camera(v: Vertex) -> Corner {
    let position = stage.camera * vec4<f32>(v.place, 1.0);
    return Corner(position, v.place, v.normal, v.face, v.colour, v.light, v.anchor, v.slope);
}

// Rounds to the fixed point of depths, in which every depth test is exact.
fn fixed(depth: f32) -> f32 {
    return round(depth / stage.unit) * stage.unit;
}

fn depth_at(corner: Corner, place: vec2<f32>) -> f32 {
    return corner.anchor.z + dot(place - corner.anchor.xy, corner.slope);
}

struct Seen {
    @location(0) depth: f32,
    // For the depth test.
    @builtin(frag_depth) nearest: f32,
}

@fragment
fn shadow_map(corner: Corner) -> Seen {
    let steepest = max(abs(corner.slope.x), abs(corner.slope.y)) / stage.size;
    let bias = stage.bias * stage.unit + stage.slope_bias * min(steepest, stage.max_slope);
    // The map has a border of one texel.
    let depth = depth_at(corner, (corner.position.xy - 1.0) / stage.size);
    let biased = clamp(fixed(clamp(depth, 0.0, 1.0)) + bias, 0.0, 1.0);
    return Seen(biased, biased);
}

struct Surface {
    // Of the receiver: u, v, depth and kind.
    @location(0) point: vec4<f32>,
    // The change of its depth from texel to texel.
    @location(1) slope: vec2<f32>,
    // The colour in shadow, and what the light adds as a multiple of it.
    @location(2) colour: vec4<f32>,
}

// How bright the light is where nothing stands in its way.
fn brightness(place: vec3<f32>) -> f32 {
    if (stage.cone == 0.0) {
        return 1.0;
    }
    let off_axis = acos(clamp(dot(normalize(place - stage.position), stage.direction), -1.0, 1.0)) / stage.cone;
    // The last tenth of the cone fades.
    return clamp((1.0 - off_axis) / 0.1, 0.0, 1.0);
}

@fragment
fn receivers(corner: Corner) -> Surface {
    let to_eye = stage.eye - corner.place;
    let to_light = select(-stage.direction, normalize(stage.position - corner.place), stage.cone > 0.0);
    // Faces are seen from both sides.
    let side = select(-1.0, 1.0, dot(corner.face, to_eye) > 0.0);
    let normal = normalize(corner.normal) * side;
    // The sky above is brighter than the ground below.
    let shadowed = stage.ambient * (0.75 + 0.25 * normal.y);
    let direct = (1.0 - stage.ambient) * max(dot(normal, to_light), 0.0) * brightness(corner.place);
    let colour = vec4<f32>(corner.colour * shadowed, direct / shadowed);
    if (corner.anchor.w == 0.0 || corner.light.w <= 0.0 || dot(corner.face, to_light) * side <= 0.0) {
        return Surface(vec4<f32>(0.0, 0.0, 0.0, 2.0), vec2<f32>(0.0), colour);
    }
    let clip = corner.light.xyz / corner.light.w;
    let place = vec2<f32>(0.5 + 0.5 * clip.x, 0.5 - 0.5 * clip.y);
    let centre = (floor(place * stage.size) + 0.5) / stage.size;
    let per_texel = corner.slope / stage.size;
    let bound = vec2<f32>(stage.max_slope);
    let limited = clamp(per_texel, -bound, bound);
    let slope = vec2<f32>(fixed(limited.x), fixed(limited.y));
    var depth = depth_at(corner, centre);
    if (any(abs(per_texel) > bound)) {
        // Too steep to be followed to the centre: as far as it goes.
        depth = clip.z + dot(slope, (centre - place) * stage.size);
    }
    return Surface(vec4<f32>(place, fixed(clamp(depth, 0.0, 1.0)), 1.0), slope, colour);
}
