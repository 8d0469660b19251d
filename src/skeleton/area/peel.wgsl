// Light of polygons past polygons, boxes and convex meshes: what `peel.rs` and `occluder.rs` do, a
// thread for each point and light. `picture.wgsl` and `points.wgsl` ask it for what they need.
//
// What is decided comes from the tables: how an edge is clipped (`clip_step`), the silhouettes of
// boxes (`box_silhouette`) and meshes (`edge_silhouette`), and what an edge adds to the light
// (`edge_integral`). Positions come as two numbers each, the second one what rounding the first
// one lost, so that a position relative to a point is as good as one that was rounded last.
//
// Memory is bounded: a point that would need more says so, and the host computes it.

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

@group(0) @binding(0) var<storage, read> corners: array<Corner>;
@group(0) @binding(1) var<storage, read> bodies: array<Body>;
@group(0) @binding(2) var<storage, read> faces: array<Face>;
// Lists of bodies, and the edges of meshes.
@group(0) @binding(3) var<storage, read> words: array<u32>;

// The kinds of bodies.
const POLYGON = 0u;
// A polygon that goes through the light's plane.
const CROSSING = 1u;
const BOX = 2u;
const MESH = 3u;
// Too large for here: the host computes what it matters to.
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

// Polygons have numbers: those of the stack, a few to work with, and the light.
const CURRENT = DEPTH;
const SPARE = DEPTH + 1u;
const SCRATCH = DEPTH + 2u;
const LIGHT = DEPTH + 4u;
const POLYGONS = DEPTH + 5u;
var<private> pool: array<vec3<f32>, POLYGONS * CORNERS>;
var<private> counts: array<u32, POLYGONS>;

// What is added up of the pieces: areas, form factors, form factors of what a transform makes of them.
const AREAS = 1u;
const FACTORS = 2u;
const SHAPED = 4u;

// The point. Surfaces nearer to it than `blur` are taken to go through it.
var<private> place: Corner;
var<private> normal: vec3<f32>;
var<private> blur: f32;
// The rows of the transform for SHAPED.
var<private> rows: array<vec3<f32>, 3>;
// Normal of the light's plane towards the point, and its product with any point of the plane.
var<private> light_normal: vec3<f32>;
var<private> light_level: f32;
var<private> is_far: bool;
// The bodies that matter, each with what was found out about it.
var<private> live: array<Entry, LIVE>;
var<private> live_count: u32;
// The sums, and those of AREAS, FACTORS and SHAPED that are wanted.
var<private> wanted: u32;
var<private> visible: f32;
var<private> form_factor: f32;
var<private> shaped: f32;
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

fn copy(polygon: u32, to: u32) {
    counts[to] = 0u;
    for (var index = 0u; index < counts[polygon]; index += 1u) {
        push(to, pool[polygon * CORNERS + index]);
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

fn transformed(at: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(dot(rows[0], at), dot(rows[1], at), dot(rows[2], at));
}

// The form factor of a polygon above the horizon, or of what the transform makes of it.
fn integrate(polygon: u32, is_shaped: bool) -> f32 {
    if (is_far && !is_shaped) {
        let c = middle(polygon);
        let a = area(polygon);
        return abs(edge_integral_small(c.x, c.y, c.z, a.x, a.y, a.z, normal.x, normal.y, normal.z));
    }
    let up = select(normal, vec3<f32>(0.0, 0.0, 1.0), is_shaped);
    var sum = 0.0;
    var u = pool[polygon * CORNERS + counts[polygon] - 1u];
    if (is_shaped) {
        u = transformed(u);
    }
    for (var index = 0u; index < counts[polygon]; index += 1u) {
        var v = pool[polygon * CORNERS + index];
        if (is_shaped) {
            v = transformed(v);
        }
        sum += edge_integral_term(u.x, u.y, u.z, v.x, v.y, v.z, up.x, up.y, up.z);
        u = v;
    }
    return abs(sum) / TAU;
}

// Adds a polygon that nothing hides.
fn add(polygon: u32) {
    pieces += 1u;
    if ((wanted & AREAS) != 0u) {
        visible += length(area(polygon));
    }
    if ((wanted & FACTORS) != 0u) {
        form_factor += integrate(polygon, false);
    }
    if ((wanted & SHAPED) != 0u) {
        shaped += integrate(polygon, true);
    }
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
            let slack = NOISE * (1.0 + length(centre) / size) + blur / size;
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
            if (-dot(faces[face].normal, at) > NOISE * max(length(at), bodies[index].radius) + blur) {
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
    if (abs(height) <= (NOISE * length(centre) + blur) * 0.5 * length(sum)) {
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
                add(CURRENT);
            } else if (depth < DEPTH) {
                copy(CURRENT, spare);
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
    var u = pool[LIGHT * CORNERS + counts[LIGHT] - 1u];
    for (var i = 0u; i < counts[LIGHT]; i += 1u) {
        let v = pool[LIGHT * CORNERS + i];
        let plane = cross(v, u);
        if (-dot(plane, centre) > reach * length(plane)) {
            return true;
        }
        u = v;
    }
    return false;
}

// Takes a light as the point sees it into the polygon LIGHT; false if the point lies in its plane or behind it.
fn see_light(first: u32, count: u32) -> bool {
    counts[LIGHT] = 0u;
    var reach = 0.0;
    for (var index = 0u; index < count; index += 1u) {
        let at = corner(first + index);
        push(LIGHT, at);
        reach = max(reach, length(at));
    }
    light_normal = area(LIGHT);
    let centre = middle(LIGHT);
    light_level = dot(light_normal, centre);
    var extent = 0.0;
    for (var index = 0u; index < count; index += 1u) {
        extent = max(extent, length(pool[LIGHT * CORNERS + index] - centre));
    }
    is_far = extent < 1e-2 * length(centre);
    return light_level < -1e-7 * length(light_normal) * reach;
}

// Finds out which bodies of a list can hide some of the light; false if the point is inside of one.
fn see_bodies(list: u32, count: u32) -> bool {
    live_count = 0u;
    for (var index = 0u; index < count; index += 1u) {
        let body = words[list + index];
        rounds += 2u * counts[LIGHT];
        if (rounds > MOST_ROUNDS) {
            overflow = true;
            return true;
        }
        if (is_outside(body)) {
            continue;
        }
        let found = look(body);
        if (found.x == 2u) {
            return false;
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
    return true;
}

// Makes the part of the light above the horizon the current polygon.
fn above_horizon() {
    clip(LIGHT, normal, false, CURRENT);
}

// Leaves of the current polygon what the transform takes to directions above the horizon.
fn above_transformed_horizon() {
    if (counts[CURRENT] != 0u) {
        clip(CURRENT, rows[2], false, SCRATCH);
        copy(SCRATCH, CURRENT);
    }
}

// Adds up what is wanted of the visible pieces of the current polygon.
fn add_up(what: u32) {
    wanted = what;
    if (counts[CURRENT] != 0u && !overflow) {
        peel();
    }
}
