// What every technique reads: the map, the receivers, and single depth tests.

struct Frame {
    // Pixels of the picture.
    pixels: vec2<u32>,
    // Texels per side of the map.
    size: i32,
    // The longest run that is revectorised.
    limit: i32,
    // The threshold e of the depth bias along walks.
    walk_bias: f32,
    // Texels from the centre of a filter's kernel to its border.
    reach: i32,
}

@group(0) @binding(0) var<uniform> frame: Frame;
// The map with a border of one texel that is infinitely far away, so that all is lit outside.
@group(0) @binding(1) var map: texture_2d<f32>;
@group(0) @binding(2) var nearest: sampler;
// Receivers: u, v, depth and kind; and the slopes of their planes.
@group(0) @binding(3) var points: texture_2d<f32>;
@group(0) @binding(4) var slopes: texture_2d<f32>;

// Whether reads are counted, which costs time.
override COUNT: bool = false;
// Texture reads of this pixel, a gather counted as one, and the steps of its loops.
var<private> reads: u32;
var<private> steps: u32;

const KIND_FACING: f32 = 1.0;
const KIND_AWAY: f32 = 2.0;
// For case_id and key: no table was evaluated.
const NO_TABLE: u32 = 4294967295u;

// A receiver at a texel of the map.
struct Centre {
    texel: vec2<i32>,
    // Where in the texel, 0 at its left and top border.
    place: vec2<f32>,
    // Depth at the centre of the texel, and its change from texel to texel.
    z: f32,
    slope: vec2<f32>,
    // Whether the texel is lit.
    lit: bool,
}

struct Sample {
    value: f32,
    case_id: u32,
    key: u32,
}

fn count_read() {
    if (COUNT) {
        reads += 1u;
    }
}

fn count_step() {
    if (COUNT) {
        steps += 1u;
    }
}

// The depth of the map at a texel.
fn depth(texel: vec2<i32>) -> f32 {
    count_read();
    return textureLoad(map, clamp(texel + 1, vec2<i32>(0), vec2<i32>(frame.size + 1)), 0).r;
}

// The depths of the four texels around the upper left corner of a texel:
// x lower left, y lower right, z upper right, w upper left.
fn gather(corner: vec2<i32>) -> vec4<f32> {
    count_read();
    let at = vec2<f32>(corner + 1) / f32(frame.size + 2);
    return textureGather(0, map, nearest, at);
}

// Depth of the receiver's plane some texels away. Exact, so in any order.
fn plane(z: f32, slope: vec2<f32>, offset: vec2<i32>) -> f32 {
    return z + slope.x * f32(offset.x) + slope.y * f32(offset.y);
}

// Whether a texel has the state that the centre has not.
fn opposite(c: Centre, offset: vec2<i32>) -> bool {
    return (plane(c.z, c.slope, offset) <= depth(c.texel + offset)) != c.lit;
}

// Whether a texel that is opposite stands alone: its four neighbours are of the other state.
fn isolated(c: Centre, offset: vec2<i32>) -> bool {
    // A walk that lifts its receiver may find a texel opposite that is not without the lift.
    let own = frame.walk_bias == 0.0 || opposite(c, offset);
    return opposite(c, offset + vec2<i32>(1, 0)) != own && opposite(c, offset + vec2<i32>(-1, 0)) != own
        && opposite(c, offset + vec2<i32>(0, 1)) != own && opposite(c, offset + vec2<i32>(0, -1)) != own;
}

// The centre without its depth test.
fn centre(point: vec4<f32>, slope: vec2<f32>) -> Centre {
    let at = point.xy * f32(frame.size);
    let corner = floor(at);
    return Centre(vec2<i32>(corner), at - corner, point.z, slope, false);
}

// The same receiver, tested some texels away.
fn moved(c: Centre, offset: vec2<i32>) -> Centre {
    return Centre(c.texel + offset, c.place, plane(c.z, c.slope, offset), c.slope, false);
}

// Visibility of a pixel.
fn visibility(pixel: vec2<u32>) -> Sample {
    let point = textureLoad(points, pixel, 0);
    if (point.w == KIND_FACING) {
        return shade(point, pixel);
    }
    return Sample(select(1.0, 0.0, point.w == KIND_AWAY), NO_TABLE, NO_TABLE);
}
