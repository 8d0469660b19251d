// The sweep of convolution shadows: what `sweep.rs`, `stencil.rs` and `matter.rs` do, a thread for each pixel and a pass
// for each slab. The lists of surfaces come from `convolve_layers.wgsl`.
//
// `begin` sets pixels to before the first slab. Each `sweep` gathers the images of all lights from the pass before, finds
// what its slab holds as the table `slab` says of the surfaces in it, shades that with the light that arrived, and lets
// through the rest; it writes the images that the next pass reads.
//
// What holds patterns is sampled by `convolve_detail.wgsl`; where nothing does, `convolve_plain.wgsl` stands in for it.
// The sums here go in the order of those on the CPU, so what needs no powers is the same to the last bit.

struct Frame {
    size: vec2<u32>,
    lights: u32,
    // 1 if gathers read the nearest pixel beside the image, and not light that nothing has hindered.
    clamps: u32,
    // Codes of the tables' levels.
    coverage: f32,
    // 1 if the last of several surfaces is seen.
    last: u32,
    // 1 to begin a picture, and not to add to one.
    fresh: u32,
    seed: u32,
    // 1 if light on opaque slopes is put right, and the root of a slab's thickness over the right distance of penumbras.
    compensates: u32,
    drift: f32,
    // Units of a pixel: at the base of depths, and more for a unit of depth.
    pixel_at_base: f32,
    pixel_growth: f32,
    // 1 if matter with detail is integrated between its values in front and behind.
    integrates: u32,
}

struct Record {
    front: f32,
    back: f32,
    thickness: f32,
    slab: u32,
    // The row of the first light's gather.
    gathers: u32,
}

struct Entry {
    depth: f32,
    // The triangle; the last bit is set if it faces away.
    surface: u32,
    object: u32,
    normal: u32,
}

struct Material {
    colour: vec3<f32>,
    // Opacity of a whole slab, and the share of light that it lets through.
    alpha: f32,
    through: vec3<f32>,
    // Opacity of a length, and the share of what is absorbed that goes on all the same.
    opacity: f32,
    transport: vec3<f32>,
    length: f32,
    // Facets: their exponent, or 0 without any; reflectance from above; the place of `microfacet_g` in the lookups.
    exponent: f32,
    reflectance: f32,
    shown: u32,
    // Detail: its pattern, octaves and numbers; the way to its space; the place of its knots in the lookups.
    pattern: u32,
    numbers: vec4<f32>,
    origin: vec3<f32>,
    octaves: u32,
    right: vec3<f32>,
    first_knot: u32,
    down: vec3<f32>,
    knots: u32,
    away: vec3<f32>,
}

struct Cursor {
    // The next surface of the pixel, and the end of its list.
    next: u32,
    end: u32,
    // Inside of matter, and of which object.
    inside: u32,
    medium: u32,
}

@group(0) @binding(0) var<uniform> frame: Frame;
@group(0) @binding(1) var<uniform> record: Record;
@group(0) @binding(2) var<storage, read> lists: array<vec2<u32>>;
@group(0) @binding(3) var<storage, read> entries: array<Entry>;
@group(0) @binding(4) var<storage, read_write> cursors: array<Cursor>;
// Light by light, pixel by pixel.
@group(0) @binding(5) var<storage, read> images: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read_write> next_images: array<vec4<f32>>;
// Of each light three rows: colour; mean slope and xx and xy of their covariance; yy. Gathers: the first row of their samples, their number, their kind, and for MAGNIFIED by how
// much more than 1 it magnifies; of DITHERED the rows are gathers themselves. Samples: offsets and weight.
@group(0) @binding(7) var<storage, read> rows: array<vec4<u32>>;
@group(0) @binding(8) var<storage, read> materials: array<Material>;
// Colour times opacity, and opacity.
@group(0) @binding(9) var<storage, read_write> seen: array<vec4<f32>>;
// Quotients of iterated and right light on slopes by drift; of materials `microfacet_g` by cosine, and knots: value,
// colour, opacity, transport, extinction.
@group(0) @binding(10) var<storage, read> lookups: array<f32>;

const LIGHT_ROWS = 3u;
const DRIFTS = 1024u;
const DRIFT_SPACING = 0.005859375;
const COSINES = 257u;

const SAME = 0u;
const DITHERED = 1u;
const MAGNIFIED = 2u;

const MAX_OFFSET = 1e9;

const NO_PATTERN = 0u;
const FBM = 1u;
const RIDGED = 2u;
const KNOT = 9u;

// The places of the table `slab`.
const NOWHERE = 0u;
const JITTERED = 1u;
const MIDDLE = 4u;

struct Matter {
    held: bool,
    alpha: f32,
    through: vec3<f32>,
    colour: vec3<f32>,
    object: u32,
}

fn light_at(light: u32, at: vec2<i32>) -> vec3<f32> {
    let size = vec2<i32>(frame.size);
    let inside = clamp(at, vec2<i32>(0), size - 1);
    let pixel = (light * frame.size.y + u32(inside.y)) * frame.size.x + u32(inside.x);
    let value = images[pixel].rgb;
    if (frame.clamps == 0u && any(inside != at)) {
        return bitcast<vec3<f32>>(rows[LIGHT_ROWS * light].xyz);
    }
    return value;
}

fn stencil(light: u32, at: vec2<i32>, gather: vec4<u32>) -> vec3<f32> {
    var sum = vec3<f32>(0.0);
    for (var i = 0u; i < gather.y; i++) {
        let sample = rows[gather.x + i];
        sum += bitcast<f32>(sample.z) * light_at(light, at + bitcast<vec2<i32>>(sample.xy));
    }
    return sum;
}

fn magnified(light: u32, at: vec2<i32>, gather: vec4<u32>) -> vec3<f32> {
    let moved = (vec2<f32>(at) + 0.5 - 0.5 * vec2<f32>(frame.size)) * bitcast<f32>(gather.w);
    var sum = vec3<f32>(0.0);
    for (var i = 0u; i < gather.y; i++) {
        let sample = rows[gather.x + i];
        let offset = clamp(moved + bitcast<vec2<f32>>(sample.xy), vec2<f32>(-MAX_OFFSET), vec2<f32>(MAX_OFFSET));
        let whole = floor(offset);
        let part = offset - whole;
        let corner = at + vec2<i32>(whole);
        let weight = bitcast<f32>(sample.z);
        sum += weight * ((1.0 - part.x) * (1.0 - part.y)) * light_at(light, corner);
        sum += weight * (part.x * (1.0 - part.y)) * light_at(light, corner + vec2<i32>(1, 0));
        sum += weight * ((1.0 - part.x) * part.y) * light_at(light, corner + vec2<i32>(0, 1));
        sum += weight * (part.x * part.y) * light_at(light, corner + vec2<i32>(1, 1));
    }
    return sum;
}

fn gathered(light: u32, at: vec2<i32>) -> vec3<f32> {
    var gather = rows[record.gathers + light];
    if (gather.z == MAGNIFIED) {
        return magnified(light, at, gather);
    }
    if (gather.z == DITHERED) {
        let phase = noise_hash(u32(at.x), u32(at.y), record.slab, frame.seed).unit;
        gather = rows[gather.x + u32(phase * f32(gather.y))];
    }
    return stencil(light, at, gather);
}

// The length of the parts inside, and of the longest of them the object and the ends.
struct Parts {
    path: f32,
    object: u32,
    front: f32,
    back: f32,
}

fn parts(cursor: Cursor, crossings: u32) -> Parts {
    var from_depth = record.front;
    var inside = cursor.inside != 0u;
    var medium = cursor.medium;
    var result = Parts(0.0, cursor.medium, record.front, record.front);
    var longest = 0.0;
    for (var i = 0u; i <= crossings; i++) {
        var depth = record.back;
        var object = 0u;
        if (i < crossings) {
            let entry = entries[cursor.next + i];
            depth = max(entry.depth, record.front);
            object = entry.object;
        }
        if (inside) {
            let length = depth - from_depth;
            result.path += length;
            if (length > longest) {
                longest = length;
                result.object = medium;
                result.front = from_depth;
                result.back = depth;
            }
        }
        from_depth = depth;
        inside = !inside;
        medium = object;
    }
    return result;
}

fn interpolated(first: u32, count: u32, at: f32) -> f32 {
    let place = clamp(at, 0.0, f32(count - 1u));
    let before = min(u32(place), count - 2u);
    let part = place - f32(before);
    return lookups[first + before] + part * (lookups[first + before + 1u] - lookups[first + before]);
}

// A direction from its place on an octahedron that is opened out.
fn octahedral(word: u32) -> vec3<f32> {
    let at = vec2<f32>(vec2<u32>(word & 0xffffu, word >> 16u)) / 65535.0 * 2.0 - 1.0;
    let z = 1.0 - abs(at.x) - abs(at.y);
    var xy = at;
    if (z < 0.0) {
        xy = (1.0 - abs(at.yx)) * select(vec2<f32>(-1.0), vec2<f32>(1.0), at >= vec2<f32>(0.0));
    }
    let direction = vec3<f32>(xy, z);
    return direction / sqrt(direction.x * direction.x + direction.y * direction.y + direction.z * direction.z);
}

// The quotient of right and iterated light on an opaque slope.
fn slope_quotient(light: u32, normal: vec3<f32>) -> f32 {
    let across = sqrt(normal.x * normal.x + normal.y * normal.y);
    if (normal.z >= 0.0 || across < 1e-6) {
        return 1.0;
    }
    let x = normal.x / across;
    let y = normal.y / across;
    let slopes = bitcast<vec4<f32>>(rows[LIGHT_ROWS * light + 1u]);
    let yy = bitcast<f32>(rows[LIGHT_ROWS * light + 2u].x);
    let variance = x * x * slopes.z + 2.0 * (x * y) * slopes.w + y * y * yy;
    if (variance <= 0.0) {
        return 1.0;
    }
    let drift = (-normal.z / across + (slopes.x * x + slopes.y * y)) / sqrt(variance) * frame.drift;
    return 1.0 / interpolated(0u, DRIFTS, drift / DRIFT_SPACING - 1.0);
}

// The share of a light that facets reflect to the viewer.
fn reflected(light: u32, material: Material, normal: vec3<f32>) -> f32 {
    let slopes = bitcast<vec4<f32>>(rows[LIGHT_ROWS * light + 1u]);
    let towards = sqrt(slopes.x * slopes.x + slopes.y * slopes.y + 1.0);
    let to_light = (slopes.x * normal.x + slopes.y * normal.y - normal.z) / towards;
    let last = f32(COSINES - 1u);
    let shown_to_light = interpolated(material.shown, COSINES, clamp(to_light, 0.0, 1.0) * last);
    let shown_to_viewer = interpolated(material.shown, COSINES, clamp(-normal.z, 0.0, 1.0) * last);
    return shade_specular(material.exponent, material.reflectance, normal.x, normal.y, normal.z, slopes.x, slopes.y,
                          max(shown_to_light, 0.001), max(shown_to_viewer, 0.001));
}

fn nothing() -> Matter {
    return Matter(false, 0.0, vec3<f32>(1.0), vec3<f32>(0.0), 0u);
}

fn matter(cursor: Cursor, crossings: u32, sampled_at: u32, id: vec2<u32>) -> Matter {
    if (sampled_at == NOWHERE) {
        return nothing();
    }
    var whole = true;
    var within = Parts(record.thickness, cursor.medium, record.front, record.back);
    if (sampled_at != JITTERED && sampled_at != MIDDLE) {
        whole = slab_coverage_level(frame.coverage) == SLAB_COVERAGE_FULL;
        if (whole) {
            let hit = entries[select(cursor.next, cursor.next + crossings - 1u, frame.last != 0u)];
            let at = max(hit.depth, record.front);
            within = Parts(record.thickness, hit.object, at, at);
        } else {
            within = parts(cursor, crossings);
        }
    }
    if (within.path <= 0.0) {
        return nothing();
    }
    let material = materials[within.object];
    if (material.pattern != NO_PATTERN) {
        return detailed(material, id, within, sampled_at == JITTERED);
    }
    if (whole) {
        return Matter(true, material.alpha, material.through, material.colour, within.object);
    }
    let alpha = shade_opacity(material.opacity, material.length, within.path);
    let through = vec3<f32>(
        shade_transmittance(material.opacity, material.transport.x, material.length, within.path),
        shade_transmittance(material.opacity, material.transport.y, material.length, within.path),
        shade_transmittance(material.opacity, material.transport.z, material.length, within.path),
    );
    return Matter(true, alpha, through, material.colour, within.object);
}

@compute @workgroup_size(8, 8)
fn begin(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= frame.size)) {
        return;
    }
    let pixel = id.y * frame.size.x + id.x;
    let list = lists[pixel];
    cursors[pixel] = Cursor(list.x, list.x + (list.y & 0x7fffffffu), 0u, 0u);
    for (var light = 0u; light < frame.lights; light++) {
        next_images[light * frame.size.x * frame.size.y + pixel] = bitcast<vec4<f32>>(rows[LIGHT_ROWS * light]);
    }
    if (frame.fresh != 0u) {
        seen[pixel] = vec4<f32>(0.0);
    } else {
        seen[pixel].w = 0.0;
    }
}

@compute @workgroup_size(8, 8)
fn sweep(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= frame.size)) {
        return;
    }
    let pixel = id.y * frame.size.x + id.x;
    let cursor = cursors[pixel];
    var crossings = 0u;
    while (cursor.next + crossings < cursor.end && entries[cursor.next + crossings].depth < record.back) {
        crossings++;
    }
    let found = slab(cursor.inside != 0u, i32(crossings), frame.coverage);
    let here = matter(cursor, crossings, found.sampled_at, id.xy);
    let material = materials[here.object];
    let is_facetted = material.exponent > 0.0;
    let is_slope = frame.compensates != 0u && material.opacity >= 1.0;
    let changes = here.held && found.surface && (is_facetted || is_slope);
    var normal = vec3<f32>(0.0);
    if (changes) {
        normal = octahedral(entries[select(cursor.next, cursor.next + crossings - 1u, frame.last != 0u)].normal);
    }
    var arrived = vec3<f32>(0.0);
    for (var light = 0u; light < frame.lights; light++) {
        var value = gathered(light, vec2<i32>(id.xy));
        if (changes) {
            var right = value;
            if (is_slope) {
                right = min(value * slope_quotient(light, normal), bitcast<vec3<f32>>(rows[LIGHT_ROWS * light].xyz));
            }
            var sent = here.colour;
            if (is_facetted) {
                sent += reflected(light, material, normal);
            }
            arrived += right * sent;
        } else {
            arrived += value;
        }
        if (here.held) {
            value = value * here.through;
        }
        next_images[light * frame.size.x * frame.size.y + pixel] = vec4<f32>(value, 1.0);
    }
    if (here.held) {
        let before = seen[pixel];
        let open = (1.0 - before.w) * here.alpha;
        if (!changes) {
            arrived = arrived * here.colour;
        }
        seen[pixel] = vec4<f32>(before.rgb + open * arrived, before.w + open);
    }
    if (crossings > 0u) {
        let medium = entries[cursor.next + crossings - 1u].object;
        cursors[pixel] = Cursor(cursor.next + crossings, cursor.end, u32(found.inside_after), medium);
    }
}
