
// Pictures: a thread for each pixel and a workgroup for each tile.

struct Frame {
    size: vec2<u32>,
    lights: u32,
    // Surfaces nearer to a point than this are taken to go through it.
    blur: f32,
    // The camera.
    eye_high: vec3<f32>,
    eye_low: vec3<f32>,
}

struct Light {
    colour: vec3<f32>,
    // Its corners, counter-clockwise as seen from the side that emits.
    first: u32,
    count: u32,
}

struct Surface {
    high: vec3<f32>,
    // NOTHING, MATT or GLOSSY.
    kind: u32,
    low: vec3<f32>,
    roughness: f32,
    normal: vec3<f32>,
}

struct Lit {
    // Sums of form factors, times radiance and bare, and of those that the gloss makes of lights.
    diffuse: vec3<f32>,
    factor: f32,
    glossy: vec3<f32>,
    pieces: u32,
    clips: u32,
    // 1 where more memory or more steps were needed than there are.
    overflow: u32,
}

@group(0) @binding(4) var<uniform> frame: Frame;
@group(0) @binding(5) var<storage, read> lights: array<Light>;
@group(0) @binding(6) var<storage, read> surfaces: array<Surface>;
@group(0) @binding(7) var<storage, read_write> lit: array<Lit>;

// The words of the table `ltc_matrix`.
@group(0) @binding(8) var<storage, read> texels: array<u32>;

fn ltc_matrix_lookup(word: u32) -> u32 {
    return texels[word];
}

// What is seen at a pixel.
const NOTHING = 0u;
const MATT = 1u;
const GLOSSY = 2u;

// Finds the transform that stands for the gloss of a surface.
fn see_gloss(roughness: f32) {
    let view = normalize((frame.eye_high - place.high) + (frame.eye_low - place.low));
    let cosine = clamp(dot(normal, view), 0.0, 1.0);
    let aside = cross(normal, view);
    let x = ltc_column(roughness);
    let y = ltc_row(cosine, min(dot(aside, aside), 1.0));
    let column = clamp(i32(x), 0, 62);
    let row = clamp(i32(y), 0, 62);
    let fx = x - f32(column);
    let fy = y - f32(row);
    let v00 = ltc_matrix(row, column);
    let v01 = ltc_matrix(row, column + 1);
    let v10 = ltc_matrix(row + 1, column);
    let v11 = ltc_matrix(row + 1, column + 1);
    let a = ltc_blend(v00.x, v01.x, v10.x, v11.x, fx, fy);
    let b = ltc_blend(v00.y, v01.y, v10.y, v11.y, fx, fy);
    let c = ltc_blend(v00.z, v01.z, v10.z, v11.z, fx, fy);
    let d = ltc_blend(v00.w, v01.w, v10.w, v11.w, fx, fy);
    let along = view - normal * dot(normal, view);
    // With the view along the normal any direction will do.
    let other = select(vec3<f32>(1.0, 0.0, 0.0), vec3<f32>(0.0, 1.0, 0.0), abs(normal.x) > 0.5);
    let first = normalize(select(cross(normal, other), along, dot(along, along) > 1e-12));
    let second = cross(normal, first);
    rows[0] = a * first + b * normal;
    rows[1] = second;
    rows[2] = c * first + d * normal;
}

// The two form factors of a light at the point.
fn of_light(light: u32, list: u32, count: u32, is_glossy: bool) -> vec2<f32> {
    form_factor = 0.0;
    shaped = 0.0;
    if (see_light(lights[light].first, lights[light].count) && see_bodies(list, count)) {
        above_horizon();
        add_up(FACTORS);
        if (is_glossy) {
            // What is counted is the work for the form factor.
            let work = vec2<u32>(pieces, clips);
            clips = 0u;
            above_horizon();
            above_transformed_horizon();
            add_up(SHAPED);
            pieces = work.x;
            clips = work.y;
        }
    }
    return vec2<f32>(form_factor, shaped);
}

@compute @workgroup_size(8, 8) fn area_light(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(workgroup_id) tile: vec3<u32>,
) {
    if (id.x >= frame.size.x || id.y >= frame.size.y) {
        return;
    }
    let pixel = id.y * frame.size.x + id.x;
    var result: Lit;
    let kind = surfaces[pixel].kind;
    if (kind != NOTHING) {
        place = Corner(surfaces[pixel].high, surfaces[pixel].low);
        normal = surfaces[pixel].normal;
        blur = frame.blur;
        if (kind == GLOSSY) {
            see_gloss(surfaces[pixel].roughness);
        }
        let tiles = (frame.size + vec2<u32>(7u)) / 8u;
        // For each light and each tile `words` begins with where its list of bodies begins, and how long it is.
        for (var light = 0u; light < frame.lights && !overflow; light += 1u) {
            let entry = 2u * ((light * tiles.y + tile.y) * tiles.x + tile.x);
            let factors = of_light(light, words[entry], words[entry + 1u], kind == GLOSSY);
            result.factor += factors.x;
            result.diffuse += lights[light].colour * factors.x;
            result.glossy += lights[light].colour * factors.y;
        }
    }
    result.pieces = pieces;
    result.clips = clips;
    result.overflow = u32(overflow);
    lit[pixel] = result;
}
