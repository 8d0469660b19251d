// Light of polygons at surfaces, past polygons, boxes and convex meshes: what `peel.rs` and
// `occluder.rs` do, a thread for each pixel and a workgroup for each tile.
//
// What is decided comes from the tables: how an edge is clipped (`clip_step`), the silhouettes of
// boxes (`box_silhouette`) and meshes (`edge_silhouette`), and what an edge adds to the light
// (`edge_integral`). Positions come as two numbers each, the second one what rounding the first
// one lost, so that a position relative to a point is as good as one that was rounded last.
//
// Memory is bounded: a pixel that would need more says so, and the host computes it.

struct Frame {
    size: vec2<u32>,
    lights: u32,
    // Surfaces nearer to a point than this are taken to go through it.
    blur: f32,
}

struct Light {
    colour: vec3<f32>,
    // Its corners.
    first: u32,
    count: u32,
    two_sided: u32,
}

struct Corner {
    high: vec3<f32>,
    low: vec3<f32>,
}

struct Body {
    // A sphere that holds all of it.
    high: vec3<f32>,
    radius: f32,
    low: vec3<f32>,
    // POLYGON, CROSSING, BOX, MESH or HOST.
    kind: u32,
    // Corners of a polygon or mesh; of a box its centre and three half axes, right-handed.
    first: u32,
    count: u32,
    // Edges of a mesh: four words each, from, to, own face, other face.
    edges: u32,
    edge_count: u32,
    // Faces of a mesh.
    faces: u32,
    face_count: u32,
}

struct Face {
    normal: vec3<f32>,
    // One of its corners.
    corner: u32,
}

struct Surface {
    high: vec3<f32>,
    // 0 where no surface is seen.
    seen: u32,
    low: vec3<f32>,
    normal: vec3<f32>,
}

struct Lit {
    received: vec3<f32>,
    pieces: u32,
    clips: u32,
    // 1 where more memory or more steps were needed than there are.
    overflow: u32,
}

@group(0) @binding(0) var<uniform> frame: Frame;
@group(0) @binding(1) var<storage, read> lights: array<Light>;
@group(0) @binding(2) var<storage, read> corners: array<Corner>;
@group(0) @binding(3) var<storage, read> bodies: array<Body>;
@group(0) @binding(4) var<storage, read> faces: array<Face>;
// For each light and each tile where its list of bodies begins and how long it is; the lists; the edges.
@group(0) @binding(5) var<storage, read> words: array<u32>;
@group(0) @binding(6) var<storage, read> surfaces: array<Surface>;
@group(0) @binding(7) var<storage, read_write> lit: array<Lit>;

// The kinds of bodies.
const POLYGON = 0u;
// A polygon that goes through the light's plane.
const CROSSING = 1u;
const BOX = 2u;
const MESH = 3u;
// Too large for here: the host computes the pixels that it matters to.
const HOST = 4u;

// Corners of a polygon, cones that have cut what a piece is left of, and bodies between a point and a light.
const CORNERS = 16u;
const DEPTH = 16u;
const LIVE = 64u;
const MOST_CLIPS = 4096u;
// Rounds of loops of a thread. Mesa's rasteriser leaves loops early once the threads that it runs
// side by side have gone through some 65,000 rounds in all; other devices have no such limit.
override MOST_ROUNDS: u32 = 1048576u;

// What rounding may leave in a difference of products of a few coordinates.
const NOISE = 1e-6;
const TAU = 6.283185307179586;

// An item of `clip_step`: the place where an edge crosses the plane. The other one is its start.
const STEP_CROSSING = 1u;
// Items of `edge_silhouette`.
const EDGE_FORWARD = 1u;
const EDGE_BACKWARD = 2u;
// A point on a box: it is not outside of it, and then the faces that it lies on are bits.
const ON_BOX = 256u;

// A body that matters, what was found out about it, and the number of its planes, some of which may be none.
struct Entry {
    body: u32,
    found: u32,
    planes: u32,
}

// Polygons have numbers: those of the stack, and a few to work with.
const CURRENT = DEPTH;
const SPARE = DEPTH + 1u;
const SCRATCH = DEPTH + 2u;
const POLYGONS = DEPTH + 4u;
var<private> pool: array<vec3<f32>, POLYGONS * CORNERS>;
var<private> counts: array<u32, POLYGONS>;

var<private> place: Corner;
var<private> normal: vec3<f32>;
// Normal of the light's plane towards the point, and its product with any point of the plane.
var<private> light_normal: vec3<f32>;
var<private> light_level: f32;
var<private> is_far: bool;
// The bodies that matter, each with what was found out about it.
var<private> live: array<Entry, LIVE>;
var<private> live_count: u32;
var<private> form_factor: f32;
var<private> pieces: u32;
var<private> clips: u32;
var<private> rounds: u32;
var<private> overflow: bool;

fn seen(high: vec3<f32>, low: vec3<f32>) -> vec3<f32> {
    return (high - place.high) + (low - place.low);
}

fn corner(index: u32) -> vec3<f32> {
    return seen(corners[index].high, corners[index].low);
}

fn side(height: f32) -> u32 {
    return u32(height >= 0.0) + u32(height > 0.0);
}

// From the end above the plane to the end below, so that both sides of a cut share it.
fn crossing(a: vec3<f32>, height_a: f32, b: vec3<f32>, height_b: f32) -> vec3<f32> {
    if (height_a > 0.0) {
        return a + (b - a) * (height_a / (height_a - height_b));
    }
    return b + (a - b) * (height_b / (height_b - height_a));
}

fn push(polygon: u32, at: vec3<f32>) {
    let count = counts[polygon];
    if (count < CORNERS) {
        pool[polygon * CORNERS + count] = at;
        counts[polygon] = count + 1u;
    } else {
        overflow = true;
    }
}

// The part of a polygon on the inner side of a plane, or on the outer one.
fn clip(polygon: u32, plane: vec3<f32>, outer: bool, part: u32) {
    clips += 1u;
    counts[part] = 0u;
    let count = counts[polygon];
    rounds += 3u * count;
    let base = polygon * CORNERS;
    var a = pool[base + count - 1u];
    var height_a = dot(plane, a);
    for (var index = 0u; index < count; index += 1u) {
        let b = pool[base + index];
        let height_b = dot(plane, b);
        let sides = vec2<u32>(side(height_a), side(height_b));
        let turned = select(sides, vec2<u32>(2u) - sides, outer);
        var items = clip_step_key(turned.x | (turned.y << 2u));
        for (var item = 1u; item <= items[0]; item += 1u) {
            var at = a;
            if (items[item] == STEP_CROSSING) {
                at = crossing(a, height_a, b, height_b);
            }
            push(part, at);
        }
        a = b;
        height_a = height_b;
    }
    if (counts[part] < 3u) {
        counts[part] = 0u;
    }
}

fn middle(polygon: u32) -> vec3<f32> {
    var sum = vec3<f32>(0.0);
    for (var index = 0u; index < counts[polygon]; index += 1u) {
        sum += pool[polygon * CORNERS + index];
    }
    return sum / f32(counts[polygon]);
}

fn area(polygon: u32) -> vec3<f32> {
    var sum = vec3<f32>(0.0);
    let first = pool[polygon * CORNERS];
    for (var index = 2u; index < counts[polygon]; index += 1u) {
        let at = polygon * CORNERS + index;
        sum += cross(pool[at - 1u] - first, pool[at] - first);
    }
    return 0.5 * sum;
}

// The form factor of a polygon above the horizon.
fn integrate(polygon: u32) -> f32 {
    if (is_far) {
        let c = middle(polygon);
        let a = area(polygon);
        return abs(edge_integral_small(c.x, c.y, c.z, a.x, a.y, a.z, normal.x, normal.y, normal.z));
    }
    var sum = 0.0;
    var u = pool[polygon * CORNERS + counts[polygon] - 1u];
    for (var index = 0u; index < counts[polygon]; index += 1u) {
        let v = pool[polygon * CORNERS + index];
        sum += edge_integral_term(u.x, u.y, u.z, v.x, v.y, v.z, normal.x, normal.y, normal.z);
        u = v;
    }
    return abs(sum) / TAU;
}

// What is found out about a body once for a point and a light: 0 if it hides nothing, 1 if it has
// planes, 2 if the point is inside; and of a polygon whether it is turned, of a box its key.
fn look(index: u32) -> vec2<u32> {
    let kind = bodies[index].kind;
    let start = bodies[index].first;
    if (kind == BOX) {
        let centre = corner(start);
        var levels = vec3<u32>(0u);
        var touches = 0u;
        var is_outside = false;
        for (var axis = 0u; axis < 3u; axis += 1u) {
            let half = corners[start + 1u + axis].high;
            let size = length(half);
            let at = -dot(centre, half) / (size * size);
            let slack = NOISE * (1.0 + length(centre) / size) + frame.blur / size;
            is_outside = is_outside || abs(at) > 1.0 + slack;
            if (at >= 1.0 - slack) {
                touches |= 1u << axis;
            }
            if (at <= slack - 1.0) {
                touches |= 8u << axis;
            }
            levels[axis] = u32(at > -1.0) + u32(at >= 1.0);
        }
        if (is_outside) {
            return vec2<u32>(1u, levels.x | (levels.y << 2u) | (levels.z << 4u));
        }
        return select(vec2<u32>(1u, ON_BOX | touches), vec2<u32>(2u, 0u), touches == 0u);
    }
    if (kind == HOST) {
        overflow = true;
        return vec2<u32>(0u);
    }
    if (kind == MESH) {
        for (var face = bodies[index].faces; face < bodies[index].faces + bodies[index].face_count; face += 1u) {
            let at = corner(faces[face].corner);
            if (-dot(faces[face].normal, at) > NOISE * max(length(at), bodies[index].radius) + frame.blur) {
                return vec2<u32>(1u, 0u);
            }
        }
        // In it, or on a face of it: the host knows what to do.
        overflow = true;
        return vec2<u32>(0u);
    }
    let count = bodies[index].count;
    let first = corner(start);
    var sum = vec3<f32>(0.0);
    var centre = first;
    var before = first;
    for (var i = 1u; i < count; i += 1u) {
        let at = corner(start + i);
        sum += cross(before - first, at - first);
        centre += at;
        before = at;
    }
    centre /= f32(count);
    let height = 0.5 * dot(sum, centre);
    // Seen edge-on.
    if (abs(height) <= (NOISE * length(centre) + frame.blur) * 0.5 * length(sum)) {
        return vec2<u32>(0u);
    }
    return vec2<u32>(1u, u32(height > 0.0));
}

// The number of the planes of a body, by what was found out about it.
fn plane_count(body: u32, found: u32) -> u32 {
    switch (bodies[body].kind) {
        case BOX: {
            var silhouette = box_silhouette_key(found & 63u);
            return select(silhouette[0], 6u, (found & ON_BOX) != 0u);
        }
        case MESH: {
            return bodies[body].edge_count;
        }
        case CROSSING: {
            return bodies[body].count + 1u;
        }
        default: {
            return bodies[body].count;
        }
    }
}

fn box_corner(body: u32, index: u32) -> vec3<f32> {
    var at = corner(bodies[body].first);
    for (var axis = 0u; axis < 3u; axis += 1u) {
        let half = corners[bodies[body].first + 1u + axis].high;
        at += select(-half, half, ((index >> axis) & 1u) == 1u);
    }
    return at;
}

// The plane through an edge that goes counter-clockwise as seen from the point; w is 0 if it has no direction.
fn through(a: vec3<f32>, b: vec3<f32>) -> vec4<f32> {
    let across = cross(b, a);
    return vec4<f32>(across, f32(length(across) > NOISE * length(a) * length(b)));
}

fn is_front(face: u32) -> bool {
    return -dot(faces[face].normal, corner(faces[face].corner)) > 0.0;
}

// A plane of a body, its normal inwards; w is 0 if there is none of this number.
fn plane_of(entry: Entry, index: u32) -> vec4<f32> {
    let body = entry.body;
    let start = bodies[body].first;
    switch (bodies[body].kind) {
        case BOX: {
            if ((entry.found & ON_BOX) != 0u) {
                let half = corners[start + 1u + index % 3u].high;
                return vec4<f32>(select(half, -half, index < 3u), f32((entry.found >> index) & 1u));
            }
            var silhouette = box_silhouette_key(entry.found);
            let next = select(index + 1u, 0u, index + 1u == silhouette[0]);
            return through(box_corner(body, silhouette[1u + index]), box_corner(body, silhouette[1u + next]));
        }
        case MESH: {
            let edge = bodies[body].edges + 4u * index;
            let a = corner(words[edge]);
            let b = corner(words[edge + 1u]);
            switch (edge_silhouette(is_front(words[edge + 2u]), is_front(words[edge + 3u]))) {
                case EDGE_FORWARD: {
                    return through(a, b);
                }
                case EDGE_BACKWARD: {
                    return through(b, a);
                }
                default: {
                    return vec4<f32>(0.0);
                }
            }
        }
        default: {}
    }
    let count = bodies[body].count;
    if (index == count) {
        // The plane through the point and the line in which the body's plane meets the light's.
        let first = corner(start);
        var sum = vec3<f32>(0.0);
        var before = first;
        for (var i = 1u; i < count; i += 1u) {
            let at = corner(start + i);
            sum += cross(before - first, at - first);
            before = at;
        }
        let own = 0.5 * select(sum, -sum, entry.found == 1u);
        return vec4<f32>(own * light_level - light_normal * dot(own, first), 1.0);
    }
    let next = select(index + 1u, 0u, index + 1u == count);
    if (entry.found == 1u) {
        return through(corner(start + next), corner(start + index));
    }
    return through(corner(start + index), corner(start + next));
}

// Whether a body hides nothing of the current polygon: look before cutting.
fn misses(entry: Entry) -> bool {
    var rest = CURRENT;
    var any = false;
    // First whether one plane alone tells, then what all of them leave.
    for (var turn = 0u; turn < 2u * entry.planes; turn += 1u) {
        rounds += 4u + counts[CURRENT];
        let looks = turn < entry.planes;
        let plane = plane_of(entry, select(turn - entry.planes, turn, looks));
        if (plane.w == 0.0) {
            continue;
        }
        any = true;
        if (looks) {
            var is_apart = true;
            for (var i = 0u; i < counts[CURRENT]; i += 1u) {
                is_apart = is_apart && dot(plane.xyz, pool[CURRENT * CORNERS + i]) <= 0.0;
            }
            if (is_apart) {
                return true;
            }
            continue;
        }
        let part = select(SCRATCH, SCRATCH + 1u, rest == SCRATCH);
        clip(rest, plane.xyz, false, part);
        rest = part;
        if (counts[rest] == 0u) {
            return true;
        }
    }
    // Without a plane there is no body.
    return !any;
}

// Adds the pieces of the current polygon that no live body hides.
fn peel() {
    // For each level the polygon that is left, the place of its body among the live ones, and the next plane.
    var stack: array<vec3<u32>, DEPTH>;
    for (var level = 0u; level < DEPTH; level += 1u) {
        stack[level] = vec3<u32>(level, 0u, 0u);
    }
    var depth = 0u;
    var first = 0u;
    // The polygon that no level has.
    var spare = SPARE;
    loop {
        // Arrive with a polygon at the next body that meets it, or add it.
        if (counts[CURRENT] != 0u) {
            var body = first;
            while (body < live_count && rounds <= MOST_ROUNDS && misses(live[body])) {
                body += 1u;
            }
            if (rounds > MOST_ROUNDS) {
                overflow = true;
            } else if (body == live_count) {
                pieces += 1u;
                form_factor += integrate(CURRENT);
            } else if (depth < DEPTH) {
                counts[spare] = 0u;
                for (var i = 0u; i < counts[CURRENT]; i += 1u) {
                    push(spare, pool[CURRENT * CORNERS + i]);
                }
                // The level takes the spare polygon, and the one that waits at its place becomes spare.
                let waiting = stack[depth].x;
                stack[depth] = vec3<u32>(spare, body, 0u);
                spare = waiting;
                depth += 1u;
            } else {
                overflow = true;
            }
        }
        if (depth == 0u || overflow) {
            break;
        }
        rounds += 4u;
        overflow = overflow || clips > MOST_CLIPS || rounds > MOST_ROUNDS;
        // Split what the last body has left by its next plane: the outer part goes on to the bodies behind it.
        let top = stack[depth - 1u];
        let entry = live[top.y];
        let plane = plane_of(entry, top.z);
        first = top.y + 1u;
        counts[CURRENT] = 0u;
        var rest = top.x;
        if (plane.w != 0.0) {
            for (var outer = 0u; outer < 2u; outer += 1u) {
                clip(top.x, plane.xyz, outer == 1u, select(spare, CURRENT, outer == 1u));
            }
            rest = spare;
            spare = top.x;
        }
        stack[depth - 1u] = vec3<u32>(rest, top.y, top.z + 1u);
        // What is left inside of all planes is hidden.
        if (top.z + 1u == entry.planes || counts[rest] == 0u) {
            depth -= 1u;
        }
    }
}

// Whether the sphere around a body lies outside of one of the planes of the light.
fn is_outside(index: u32) -> bool {
    let centre = seen(bodies[index].high, bodies[index].low);
    let reach = bodies[index].radius * (1.0 + NOISE) + NOISE * length(centre);
    if (light_level - dot(light_normal, centre) > reach * length(light_normal)) {
        return true;
    }
    var u = pool[CURRENT * CORNERS + counts[CURRENT] - 1u];
    for (var i = 0u; i < counts[CURRENT]; i += 1u) {
        let v = pool[CURRENT * CORNERS + i];
        let plane = cross(v, u);
        if (-dot(plane, centre) > reach * length(plane)) {
            return true;
        }
        u = v;
    }
    return false;
}

// The form factor of a light at the point.
fn of_light(light: u32, list: u32, count: u32) -> f32 {
    form_factor = 0.0;
    counts[SCRATCH] = 0u;
    var reach = 0.0;
    for (var index = 0u; index < lights[light].count; index += 1u) {
        let at = corner(lights[light].first + index);
        push(SCRATCH, at);
        reach = max(reach, length(at));
    }
    light_normal = area(SCRATCH);
    let centre = middle(SCRATCH);
    light_level = dot(light_normal, centre);
    if (abs(light_level) <= 1e-7 * length(light_normal) * reach) {
        return 0.0;
    }
    let is_behind = light_level > 0.0;
    if (is_behind && lights[light].two_sided == 0u) {
        return 0.0;
    }
    if (is_behind) {
        light_normal = -light_normal;
        light_level = -light_level;
    }
    // Counter-clockwise as seen from the point.
    counts[CURRENT] = 0u;
    var extent = 0.0;
    for (var index = 0u; index < counts[SCRATCH]; index += 1u) {
        let at = pool[SCRATCH * CORNERS + select(index, counts[SCRATCH] - 1u - index, is_behind)];
        push(CURRENT, at);
        extent = max(extent, length(at - centre));
    }
    is_far = extent < 1e-2 * length(centre);
    live_count = 0u;
    for (var index = 0u; index < count; index += 1u) {
        let body = words[list + index];
        rounds += 2u * counts[CURRENT];
        if (is_outside(body)) {
            continue;
        }
        let found = look(body);
        if (found.x == 2u) {
            return 0.0;
        }
        if (found.x == 1u) {
            if (live_count < LIVE) {
                live[live_count] = Entry(body, found.y, plane_count(body, found.y));
                live_count += 1u;
            } else {
                overflow = true;
            }
        }
    }
    clip(CURRENT, normal, false, SCRATCH);
    counts[CURRENT] = 0u;
    for (var index = 0u; index < counts[SCRATCH]; index += 1u) {
        push(CURRENT, pool[SCRATCH * CORNERS + index]);
    }
    if (counts[CURRENT] != 0u && !overflow) {
        peel();
    }
    return form_factor;
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
    if (surfaces[pixel].seen != 0u) {
        place = Corner(surfaces[pixel].high, surfaces[pixel].low);
        normal = surfaces[pixel].normal;
        let tiles = (frame.size + vec2<u32>(7u)) / 8u;
        for (var light = 0u; light < frame.lights && !overflow; light += 1u) {
            let entry = 2u * ((light * tiles.y + tile.y) * tiles.x + tile.x);
            result.received += lights[light].colour * of_light(light, words[entry], words[entry + 1u]);
        }
    }
    result.pieces = pieces;
    result.clips = clips;
    result.overflow = u32(overflow);
    lit[pixel] = result;
}
