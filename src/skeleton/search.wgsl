// Light of polygons at surfaces by search: what `area/search` does, a thread for each pixel.
//
// Every decision is a table's: `search_plan`, `quad_diagonal`, `triangle_configuration`,
// `triangle_region`, `triangle_rays`, `closest_point_setup`, `closest_point_start`,
// `closest_point_step`, `clip_step`; and so are random numbers (`pcg`) and the light of an edge
// (`edge_integral`). A test of visibility is a ray past the triangles of a hierarchy, and past balls
// and cones.
//
// Pixels learn from their neighbours on a checkerboard: those of one colour first, then the others
// from what these have found. No thread reads what another one of the same run writes.

struct Frame {
    size: vec2<u32>,
    lights: u32,
    // Corners of all lights.
    corners: u32,
    nodes: u32,
    solids: u32,
    seed: u32,
    // Points of each curve; 0 for closest points.
    rays: u32,
    // The level `rule` of `closest_point_start`.
    rule: u32,
    // Pixels of which colour there are, 0 or 1, or 2 for all of them.
    colour: u32,
    // 1 if they learn from their neighbours.
    learns: u32,
    tolerance: f32,
    gap: f32,
    spacing: f32,
    // Surfaces nearer than this to the ends of a ray hide nothing.
    close: f32,
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

struct Node {
    low: vec3<f32>,
    // Triangles of a leaf; 0 of an inner node.
    count: u32,
    high: vec3<f32>,
    // The first of the triangles, or of the two nodes below.
    first: u32,
}

struct Face {
    a: vec3<f32>,
    b: vec3<f32>,
    c: vec3<f32>,
}

struct Solid {
    // The centre of a ball, the apex of a cone.
    place: vec3<f32>,
    // Of a cone, from its apex to its base; of a ball 0.
    length: f32,
    axis: vec3<f32>,
    // Of a cone the square of its radius over its depth below the apex, of a ball that of its radius.
    square: f32,
}

struct Surface {
    high: vec3<f32>,
    // 0 where no surface is seen.
    seen: u32,
    low: vec3<f32>,
    normal: vec3<f32>,
}

struct Edge {
    // Bit 0: its start is visible; bit 1: its end is; bit 2: it was searched.
    ends: u32,
    count: u32,
    // Where the visibility changes, in ascending order.
    places: vec2<f32>,
}

struct Found {
    received: vec3<f32>,
    // The form factors of the lights, added up.
    factor: f32,
    // The visible shares of the lights, added up.
    fraction: f32,
    // Lights that have a share.
    lights: u32,
    // One more than the configuration of the first triangle of the first light.
    configuration: u32,
    tests: u32,
    // 1 where more memory or more steps were needed than there are.
    overflow: u32,
}

@group(0) @binding(0) var<uniform> frame: Frame;
@group(0) @binding(1) var<storage, read> lights: array<Light>;
@group(0) @binding(2) var<storage, read> corners: array<Corner>;
@group(0) @binding(3) var<storage, read> nodes: array<Node>;
@group(0) @binding(4) var<storage, read> faces: array<Face>;
@group(0) @binding(5) var<storage, read> solids: array<Solid>;
@group(0) @binding(6) var<storage, read> surfaces: array<Surface>;
@group(0) @binding(7) var<storage, read_write> edges: array<Edge>;
@group(0) @binding(8) var<storage, read_write> found: array<Found>;

// What is wider than the widest gap but for this counts as wide.
const ALIKE = 1e-5;
const NOISE = 1e-6;
const TAU = 6.283185307179586;
// Places of an edge that are tested before a search gives up, and places that a search for a closest point looks at.
const TESTED = 64u;
const LOOKS = 24u;
const CORNERS = 8u;
const POLYGONS = 6u;
const NODES = 40u;
// Rounds of loops of a thread. Mesa's rasteriser leaves loops early once the threads that it runs
// side by side have gone through some 65,000 rounds in all; other devices have no such limit.
override MOST_ROUNDS: u32 = 1048576u;

// Labels of points: the levels of the sets `point`.
const A = 3u;
const B = 6u;
const K = 9u;
const H = 10u;
const X = 11u;
const Y = 12u;
const Y_OF_RAYS = 16u;
const LABELS = 21u;
// Levels of `search_plan`, of `quad_diagonal`, of `closest_point_start` and an item of `clip_step`.
const PLAN_BISECT = 0u;
const PLAN_PROBE = 2u;
const ACROSS_HALVES = 2u;
const GO = 1u;
const STEP_CROSSING = 1u;
const FOUND_Y = 2u;

const SEARCHED = 4u;

// The pixel: its place, in the parts that single precision has of it.
var<private> place: Corner;
var<private> normal: vec3<f32>;
var<private> state: u32;
var<private> tests: u32;
var<private> rounds: u32;
var<private> overflow: bool;

// The light, as seen from the place.
var<private> own: array<vec3<f32>, CORNERS>;
var<private> light_normal: vec3<f32>;
var<private> is_far: bool;

// Polygons that are still to be searched, each corner with the edge that starts there.
var<private> stack_corners: array<u32, POLYGONS * CORNERS>;
var<private> stack_edges: array<Edge, POLYGONS * CORNERS>;
var<private> stack_counts: array<u32, POLYGONS>;
var<private> depth: u32;

// A triangle: its points by their labels.
var<private> points: array<vec3<f32>, LABELS>;
var<private> seen_vertices: array<bool, 3>;

struct Wedge {
    apex: vec3<f32>,
    far: array<vec3<f32>, 2>,
    chord: array<vec3<f32>, 2>,
    far_seen: bool,
}
var<private> wedge: Wedge;

struct Look {
    at: f32,
    distance: f32,
    border: vec3<f32>,
    bulges: bool,
}
var<private> looks: array<Look, LOOKS>;
var<private> look_count: u32;

// Sums over the visible loops of a light.
var<private> form_factor: f32;
var<private> visible_area: f32;

fn random() -> f32 {
    let number = pcg_unit(state);
    state = pcg_hash(state);
    return number;
}

fn below(count: u32) -> u32 {
    return min(u32(random() * f32(count)), count - 1u);
}

// --- Visibility. Places are relative to the pixel's.

fn is_beside(node: u32, inverse: vec3<f32>) -> bool {
    let low = (nodes[node].low - place.high) * inverse;
    let high = (nodes[node].high - place.high) * inverse;
    let first = min(low, high);
    let last = max(low, high);
    let enters = max(max(first.x, first.y), max(first.z, 0.0));
    let leaves = min(min(last.x, last.y), min(last.z, 1.0));
    // Boxes are rounded.
    return enters > leaves + NOISE;
}

fn crosses(face: u32, along: vec3<f32>, range: vec2<f32>) -> bool {
    let a = faces[face].a - place.high;
    let b = faces[face].b - place.high;
    let c = faces[face].c - place.high;
    let across = cross(b - a, c - a);
    let at = dot(across, a) / dot(across, along);
    if (!(at > range.x && at < range.y)) {
        return false;
    }
    // Two faces at an edge see it from both sides, so that nothing falls through.
    let sides = vec3<f32>(dot(along, cross(b, a)), dot(along, cross(c, b)), dot(along, cross(a, c)));
    return all(sides >= vec3<f32>(0.0)) || all(sides <= vec3<f32>(0.0));
}

fn cone_product(solid: u32, a: vec3<f32>, b: vec3<f32>) -> f32 {
    let axis = solids[solid].axis;
    return dot(a, b) - (1.0 + solids[solid].square) * dot(a, axis) * dot(b, axis);
}

fn is_in_cone(solid: u32, at: vec3<f32>) -> bool {
    return cone_product(solid, at, at) < 0.0;
}

fn meets(solid: u32, along: vec3<f32>) -> bool {
    // From the centre, or the apex, to the place.
    let from_solid = place.high - solids[solid].place + place.low;
    if (solids[solid].length == 0.0) {
        let nearest = clamp(-dot(from_solid, along) / dot(along, along), 0.0, 1.0);
        let offset = from_solid + along * nearest;
        return dot(offset, offset) < solids[solid].square;
    }
    let depth_here = dot(from_solid, solids[solid].axis);
    let speed = dot(along, solids[solid].axis);
    var range = vec2<f32>(0.0, 1.0);
    if (speed != 0.0) {
        let ends = vec2<f32>(-depth_here, solids[solid].length - depth_here) / speed;
        range = vec2<f32>(max(0.0, min(ends.x, ends.y)), min(1.0, max(ends.x, ends.y)));
    } else if (depth_here <= 0.0 || depth_here >= solids[solid].length) {
        return false;
    }
    if (range.x >= range.y) {
        return false;
    }
    let quadratic = cone_product(solid, along, along);
    var lowest = range.x;
    if (quadratic > 0.0) {
        lowest = clamp(-cone_product(solid, from_solid, along) / quadratic, range.x, range.y);
    }
    return is_in_cone(solid, from_solid + along * range.x) || is_in_cone(solid, from_solid + along * lowest)
        || is_in_cone(solid, from_solid + along * range.y);
}

fn is_open(along: vec3<f32>) -> bool {
    for (var solid = 0u; solid < frame.solids; solid += 1u) {
        rounds += 1u;
        if (meets(solid, along)) {
            return false;
        }
    }
    if (frame.nodes == 0u) {
        return true;
    }
    let end = frame.close / length(along);
    let range = vec2<f32>(end, 1.0 - end);
    let inverse = vec3<f32>(1.0) / along;
    var waiting: array<u32, NODES>;
    var count = 1u;
    waiting[0] = 0u;
    while (count > 0u && rounds < MOST_ROUNDS) {
        rounds += 1u;
        count -= 1u;
        let node = waiting[count];
        if (is_beside(node, inverse)) {
            continue;
        }
        let first = nodes[node].first;
        if (nodes[node].count == 0u) {
            if (count + 2u > NODES) {
                overflow = true;
                return true;
            }
            waiting[count] = first;
            waiting[count + 1u] = first + 1u;
            count += 2u;
            continue;
        }
        for (var face = first; face < first + nodes[node].count; face += 1u) {
            rounds += 1u;
            if (crosses(face, along, range)) {
                return false;
            }
        }
    }
    return true;
}

fn sees(at: vec3<f32>) -> bool {
    tests += 1u;
    overflow = overflow || rounds >= MOST_ROUNDS;
    return is_open(at);
}

// --- Searches along a segment.

fn on(start: vec3<f32>, end: vec3<f32>, at: f32) -> vec3<f32> {
    return start * (1.0 - at) + end * at;
}

fn bisect(start: vec3<f32>, end: vec3<f32>, between: vec2<f32>, seen: bool, tolerance: f32) -> f32 {
    var a = between.x;
    var b = between.y;
    var middle = a + (b - a) * random();
    while (abs(b - a) >= 2.0 * tolerance && !overflow) {
        rounds += 1u;
        if (sees(on(start, end, middle)) == seen) {
            a = middle;
        } else {
            b = middle;
        }
        let next = 0.5 * (a + b);
        if (next == middle) {
            break;
        }
        middle = next;
    }
    return 0.5 * (a + b);
}

// A place that differs from both ends, or a negative number.
fn differing(start: vec3<f32>, end: vec3<f32>, between: vec2<f32>, seen: bool) -> f32 {
    var tested: array<f32, TESTED>;
    tested[0] = between.x;
    tested[1] = between.y;
    var count = 2u;
    var next = between.x + (between.y - between.x) * random();
    while (!overflow) {
        if (sees(on(start, end, next)) != seen) {
            return next;
        }
        if (count == TESTED) {
            overflow = true;
            break;
        }
        // Into its place.
        var at = count;
        while (at > 0u && tested[at - 1u] >= next) {
            tested[at] = tested[at - 1u];
            at -= 1u;
        }
        tested[at] = next;
        count += 1u;
        rounds += count;
        var widest = 0.0;
        for (var i = 1u; i < count; i += 1u) {
            widest = max(widest, tested[i] - tested[i - 1u]);
        }
        if (widest < frame.gap) {
            break;
        }
        let wide = widest * (1.0 - ALIKE);
        var ties = 0u;
        for (var i = 1u; i < count; i += 1u) {
            ties += u32(tested[i] - tested[i - 1u] >= wide);
        }
        var left = 0u;
        if (ties > 1u) {
            left = below(ties);
        }
        for (var i = 1u; i < count; i += 1u) {
            if (tested[i] - tested[i - 1u] >= wide) {
                if (left == 0u) {
                    next = 0.5 * (tested[i - 1u] + tested[i]);
                    break;
                }
                left -= 1u;
            }
        }
    }
    return -1.0;
}

fn search_edge(start: vec3<f32>, end: vec3<f32>, ends: u32, before: Edge) -> Edge {
    let seen = (ends & 1u) != 0u;
    let differ = seen != ((ends & 2u) != 0u);
    var history = 0u;
    var changed = false;
    var known = vec2<f32>(0.0, 1.0);
    if ((before.ends & SEARCHED) != 0u) {
        history = 1u + before.count;
        changed = ((before.ends ^ ends) & 1u) != 0u;
        if (before.count > 0u) {
            known = before.places;
        }
    }
    let plan = search_plan_key(u32(differ) | (history << 1u) | (u32(changed) << 3u), known.x, known.y);
    let between = vec2<f32>(plan.lo, plan.hi);
    var edge = Edge(ends | SEARCHED, 0u, vec2<f32>(0.0));
    if (plan.method == PLAN_BISECT) {
        edge.count = 1u;
        edge.places = vec2<f32>(bisect(start, end, between, seen, frame.tolerance));
        return edge;
    }
    var hit = -1.0;
    if (plan.method == PLAN_PROBE && sees(on(start, end, plan.at)) != seen) {
        hit = plan.at;
    } else {
        hit = differing(start, end, between, seen);
    }
    if (hit >= 0.0) {
        edge.count = 2u;
        edge.places.x = bisect(start, end, vec2<f32>(0.0, hit), seen, frame.tolerance);
        edge.places.y = bisect(start, end, vec2<f32>(hit, 1.0), !seen, frame.tolerance);
    }
    return edge;
}

fn reversed(edge: Edge) -> Edge {
    let ends = (edge.ends & SEARCHED) | ((edge.ends & 1u) << 1u) | ((edge.ends >> 1u) & 1u);
    return Edge(ends, edge.count, vec2<f32>(1.0) - edge.places.yx);
}

// --- Borders of shadows between two discontinuities.

fn far_place(at: f32) -> vec3<f32> {
    return on(wedge.far[0], wedge.far[1], at);
}

fn meets_chord(at: f32, chord: array<vec3<f32>, 2>) -> f32 {
    let first = distance(chord[0], wedge.apex) / distance(wedge.far[0], wedge.apex);
    let last = distance(chord[1], wedge.apex) / distance(wedge.far[1], wedge.apex);
    let turned = (1.0 - at) / first + at / last;
    // Of a triangle without area there is nothing to be met.
    return select(0.0, clamp(1.0 / turned, 0.0, 1.0), turned > 0.0 && turned < 1e30);
}

fn off_line(at: vec3<f32>) -> f32 {
    let along = wedge.far[1] - wedge.far[0];
    let towards = at - wedge.far[0];
    return length(towards - along * (dot(towards, along) / max(dot(along, along), 1e-37)));
}

fn far_distance(at: vec3<f32>) -> f32 {
    let all = off_line(wedge.apex);
    return select(0.0, min(off_line(at) / all, 1.0), all > 0.0);
}

fn look(at: f32) -> Look {
    rounds += look_count;
    for (var i = 0u; i < look_count; i += 1u) {
        if (looks[i].at == at) {
            return looks[i];
        }
    }
    let end = far_place(at);
    let chord = on(wedge.apex, end, meets_chord(at, wedge.chord));
    var made = Look(at, 0.0, chord, false);
    if (sees(chord) != wedge.far_seen) {
        made.bulges = true;
        made.border = on(chord, end, bisect(chord, end, vec2<f32>(0.0, 1.0), !wedge.far_seen, frame.spacing / 10.0));
    }
    made.distance = far_distance(made.border);
    if (look_count == LOOKS) {
        overflow = true;
    } else {
        looks[look_count] = made;
        look_count += 1u;
    }
    return made;
}

// The places halfway to the two ends, at which `closest_point_step` may fetch the distance.
struct ClosestPointStepSite {
    low: f32,
    high: f32,
}

fn closest_point_step_fetch_d_low(site: ClosestPointStepSite) -> f32 {
    return look(site.low).distance;
}

fn closest_point_step_fetch_d_high(site: ClosestPointStepSite) -> f32 {
    return look(site.high).distance;
}

// The closest point, or none.
fn closest() -> Look {
    let none = Look(0.0, 0.0, vec3<f32>(0.0), false);
    look_count = 2u;
    let first_end = far_distance(wedge.chord[0]);
    let last_end = far_distance(wedge.chord[1]);
    looks[0] = Look(0.0, first_end, vec3<f32>(0.0), false);
    looks[1] = Look(1.0, last_end, vec3<f32>(0.0), false);
    var places = vec3<f32>(0.0, random(), 1.0);
    let start = look(places.y);
    let key = u32(start.bulges) | (frame.rule << 1u);
    if (closest_point_start_key(key, start.at, first_end, start.distance, last_end) != GO) {
        return none;
    }
    while (places.z - places.x > frame.spacing && !overflow) {
        let lo = look(places.x).distance;
        let mid = look(places.y).distance;
        let hi = look(places.z).distance;
        let site = ClosestPointStepSite(0.5 * (places.x + places.y), 0.5 * (places.y + places.z));
        let next = closest_point_step_key(0u, places.x, places.y, places.z, lo, mid, hi, site);
        if (next.z - next.x >= places.z - places.x && next.y == places.y) {
            break;
        }
        places = next;
    }
    var last = look(places.y);
    last.bulges = last.bulges && last.distance < min(first_end, last_end);
    return last;
}

// --- Triangles.

// Adds a visible loop: its area, and its light above the horizon.
fn add_loop(labels: ptr<function, array<u32, 16>>, count: u32) {
    let anchor = points[(*labels)[0]];
    var area = vec3<f32>(0.0);
    for (var i = 2u; i < count; i += 1u) {
        area += 0.5 * cross(points[(*labels)[i - 1u]] - anchor, points[(*labels)[i]] - anchor);
    }
    visible_area += dot(area, light_normal);
    var sum = 0.0;
    var first = vec3<f32>(0.0);
    var before = vec3<f32>(0.0);
    var middle = vec3<f32>(0.0);
    var clipped_area = vec3<f32>(0.0);
    var clipped = 0u;
    var a = points[(*labels)[count - 1u]];
    var height_a = dot(normal, a);
    for (var i = 0u; i < count; i += 1u) {
        let b = points[(*labels)[i]];
        let height_b = dot(normal, b);
        let sides = vec2<u32>(
            u32(height_a >= 0.0) + u32(height_a > 0.0),
            u32(height_b >= 0.0) + u32(height_b > 0.0),
        );
        var items = clip_step_key(sides.x | (sides.y << 2u));
        for (var item = 1u; item <= items[0]; item += 1u) {
            var at = a;
            if (items[item] == STEP_CROSSING) {
                at = select(
                    b + (a - b) * (height_b / (height_b - height_a)),
                    a + (b - a) * (height_a / (height_a - height_b)),
                    height_a > 0.0,
                );
            }
            if (clipped == 0u) {
                first = at;
            } else {
                sum += light_of(before, at);
                clipped_area += 0.5 * cross(before - first, at - first);
            }
            before = at;
            middle += at;
            clipped += 1u;
        }
        a = b;
        height_a = height_b;
    }
    rounds += 3u * count;
    if (clipped < 3u) {
        return;
    }
    if (is_far) {
        let c = middle / f32(clipped);
        let n = normal;
        form_factor +=
            abs(edge_integral_small(c.x, c.y, c.z, clipped_area.x, clipped_area.y, clipped_area.z, n.x, n.y, n.z));
    } else {
        form_factor += abs(sum + light_of(before, first)) / TAU;
    }
}

fn light_of(u: vec3<f32>, v: vec3<f32>) -> f32 {
    return edge_integral_term(u.x, u.y, u.z, v.x, v.y, v.z, normal.x, normal.y, normal.z);
}

// The other discontinuity of an edge that has two.
fn other(label: u32) -> u32 {
    return select(label - 3u, label + 3u, label < B);
}

// Finds the points of the curves, and returns how many each has.
fn curves(setup: ClosestPointSetupValue) -> u32 {
    let first = select(X, Y_OF_RAYS, setup.found == FOUND_Y);
    var apex_seen = !wedge.far_seen;
    if (setup.apex < A) {
        apex_seen = seen_vertices[setup.apex];
    }
    var count = 0u;
    // All places are drawn first.
    var places: array<f32, 5>;
    for (var ray = 0u; ray < frame.rays; ray += 1u) {
        places[ray] = (f32(ray + 1u) + 0.8 * (random() - 0.5)) / f32(frame.rays + 1u);
    }
    for (var ray = 0u; ray < frame.rays; ray += 1u) {
        let end = far_place(places[ray]);
        if (apex_seen != wedge.far_seen) {
            let at = bisect(wedge.apex, end, vec2<f32>(0.0, 1.0), apex_seen, frame.tolerance);
            points[first + count] = on(wedge.apex, end, at);
        } else {
            // A strip crosses the ray.
            let near = array<vec3<f32>, 2>(points[other(setup.d1)], points[other(setup.d2)]);
            let middle = 0.5 * (meets_chord(places[ray], near) + meets_chord(places[ray], wedge.chord));
            if (sees(on(wedge.apex, end, middle)) == wedge.far_seen) {
                continue;
            }
            let enters = bisect(wedge.apex, end, vec2<f32>(0.0, middle), wedge.far_seen, frame.tolerance);
            let leaves = bisect(wedge.apex, end, vec2<f32>(middle, 1.0), !wedge.far_seen, frame.tolerance);
            points[first + count] = on(wedge.apex, end, leaves);
            points[Y_OF_RAYS + count] = on(wedge.apex, end, enters);
        }
        count += 1u;
    }
    return count;
}

fn set_wedge(setup: ClosestPointSetupValue) {
    wedge.apex = points[setup.apex];
    wedge.far = array<vec3<f32>, 2>(points[setup.e1], points[setup.e2]);
    wedge.chord = array<vec3<f32>, 2>(points[setup.d1], points[setup.d2]);
    wedge.far_seen = seen_vertices[setup.e1];
}

// Searches a triangle by its corners and the edges that start there; returns its configuration.
fn search_triangle(vertices: vec3<u32>, sides: array<Edge, 3>) -> u32 {
    var its_sides = sides;
    var key = 0u;
    for (var i = 0u; i < 3u; i += 1u) {
        let edge = its_sides[i];
        let start = own[vertices[i]];
        let end = own[vertices[(i + 1u) % 3u]];
        seen_vertices[i] = (edge.ends & 1u) != 0u;
        key |= ((edge.ends & 1u) << i) | (u32(edge.count == 2u) << (3u + i));
        points[i] = start;
        points[A + i] = on(start, end, edge.places.x);
        points[B + i] = on(start, end, edge.places.y);
    }
    let kind = triangle_configuration_key(key);
    let turn = u32(kind.rotation);
    let opposite = (turn + 2u) % 3u;
    let state_key = kind.configuration | (turn << 3u);
    var exist = vec2<bool>(false);
    var count = 0u;
    // Of one configuration both halves are searched, between which K and H lie.
    let halves = closest_point_setup_key(state_key | (1u << 5u)).found != 0u;
    if (halves) {
        points[K] = 0.5 * (points[A + turn] + points[B + turn]);
        let at = bisect(points[K], points[opposite], vec2<f32>(0.0, 1.0), !seen_vertices[opposite], frame.tolerance);
        points[H] = on(points[K], points[opposite], at);
    }
    for (var half_side = 0u; half_side < 2u; half_side += 1u) {
        let setup = closest_point_setup_key(state_key | (half_side << 5u));
        if (setup.found == 0u) {
            continue;
        }
        set_wedge(setup);
        if (frame.rays > 0u) {
            count = curves(setup);
        } else {
            let point = closest();
            let is_y = setup.found == FOUND_Y;
            points[select(X, Y, is_y)] = point.border;
            if (is_y) {
                exist.y = point.bulges;
            } else {
                exist.x = point.bulges;
            }
        }
    }
    let lit_key = state_key | (u32(seen_vertices[turn]) << 5u);
    var labels: array<u32, 16>;
    if (frame.rays > 0u) {
        var list = triangle_rays_key(lit_key | (count << 6u));
        for (var index = 0u; index < list[0]; index += 1u) {
            let start = 1u + 17u * index;
            for (var i = 0u; i < list[start]; i += 1u) {
                labels[i] = list[start + 1u + i];
            }
            add_loop(&labels, list[start]);
        }
    } else {
        var region = triangle_region_key(lit_key | (u32(exist.x) << 6u) | (u32(exist.y) << 7u));
        for (var index = 0u; index < region.loops[0]; index += 1u) {
            let start = 1u + 9u * index;
            for (var i = 0u; i < region.loops[start]; i += 1u) {
                labels[i] = region.loops[start + 1u + i];
            }
            add_loop(&labels, region.loops[start]);
        }
    }
    return kind.configuration;
}

// --- Polygons.

// The place where the diagonals of a quadrilateral cross, which `quad_diagonal` may ask about.
struct QuadDiagonalSite {
    at: vec3<f32>,
}

fn quad_diagonal_fetch_middle(site: QuadDiagonalSite) -> bool {
    return sees(site.at);
}

// The parameters at which two lines in a plane cross each other.
fn crossing(a: vec3<f32>, along_a: vec3<f32>, b: vec3<f32>, along_b: vec3<f32>) -> vec2<f32> {
    let across = cross(along_a, along_b);
    let square = dot(across, across);
    if (square == 0.0) {
        return vec2<f32>(0.5);
    }
    let at = vec2<f32>(dot(cross(b - a, along_b), across), dot(cross(b - a, along_a), across)) / square;
    return clamp(at, vec2<f32>(0.0), vec2<f32>(1.0));
}

fn none() -> Edge {
    return Edge(0u, 0u, vec2<f32>(0.0));
}

// A diagonal, and the discontinuities along it.
struct Cut {
    first: u32,
    second: u32,
    edge: Edge,
}

fn cut_quad(base: u32) -> Cut {
    var at: array<vec3<f32>, 4>;
    var key = 0u;
    for (var i = 0u; i < 4u; i += 1u) {
        at[i] = own[stack_corners[base + i]];
        key |= (stack_edges[base + i].ends & 1u) << i;
    }
    // Drawn even where it plays no part, so that streams stay together.
    let drawn = below(2u);
    let middles = crossing(at[0], at[2] - at[0], at[1], at[3] - at[1]);
    let found_cut = quad_diagonal_key(key | (drawn << 4u), QuadDiagonalSite(on(at[0], at[2], middles.x)));
    let first = found_cut.diagonal;
    let ends = ((key >> first) & 1u) | (((key >> (first + 2u)) & 1u) << 1u);
    if (found_cut.method != ACROSS_HALVES) {
        return Cut(first, first + 2u, search_edge(at[first], at[first + 2u], ends, none()));
    }
    let middle = middles[first];
    let seen = (ends & 1u) != 0u;
    let near = bisect(at[first], at[first + 2u], vec2<f32>(0.0, middle), seen, frame.tolerance);
    let beyond = bisect(at[first], at[first + 2u], vec2<f32>(middle, 1.0), !seen, frame.tolerance);
    return Cut(first, first + 2u, Edge(ends | SEARCHED, 2u, vec2<f32>(near, beyond)));
}

fn cut_polygon(base: u32, count: u32) -> Cut {
    let drawn = below(count * (count - 3u) / 2u);
    var number = 0u;
    var best = 0u;
    var chosen = vec2<u32>(0u);
    for (var first = 0u; first + 2u < count; first += 1u) {
        let last = select(count, count - 1u, first == 0u);
        for (var second = first + 2u; second < last; second += 1u) {
            let differ = ((stack_edges[base + first].ends ^ stack_edges[base + second].ends) & 1u) != 0u;
            let cut_off = min(second - first, count - (second - first));
            if ((differ && cut_off > best) || (best == 0u && number == drawn)) {
                chosen = vec2<u32>(first, second);
            }
            if (differ) {
                best = max(best, cut_off);
            }
            number += 1u;
        }
    }
    rounds += number;
    let ends = (stack_edges[base + chosen.x].ends & 1u) | ((stack_edges[base + chosen.y].ends & 1u) << 1u);
    let start = own[stack_corners[base + chosen.x]];
    let end = own[stack_corners[base + chosen.y]];
    return Cut(chosen.x, chosen.y, search_edge(start, end, ends, none()));
}

// Searches the polygons of the stack; returns one more than the configuration of the first triangle.
fn search_polygons() -> u32 {
    var configuration = 0u;
    while (depth > 0u && !overflow) {
        rounds += 16u;
        let base = (depth - 1u) * CORNERS;
        let count = stack_counts[depth - 1u];
        if (count == 3u) {
            depth -= 1u;
            let vertices = vec3<u32>(stack_corners[base], stack_corners[base + 1u], stack_corners[base + 2u]);
            let sides = array<Edge, 3>(stack_edges[base], stack_edges[base + 1u], stack_edges[base + 2u]);
            let kind = search_triangle(vertices, sides);
            if (configuration == 0u) {
                configuration = 1u + kind;
            }
            continue;
        }
        var cut: Cut;
        if (count == 4u) {
            cut = cut_quad(base);
        } else {
            cut = cut_polygon(base, count);
        }
        // The part beyond takes the polygon's place, and the near part lies on top.
        var old_corners: array<u32, CORNERS>;
        var old_edges: array<Edge, CORNERS>;
        for (var i = 0u; i < count; i += 1u) {
            old_corners[i] = stack_corners[base + i];
            old_edges[i] = stack_edges[base + i];
        }
        let top = base + CORNERS;
        let near = cut.second - cut.first;
        for (var i = 0u; i < near; i += 1u) {
            stack_corners[top + i] = old_corners[cut.first + i];
            stack_edges[top + i] = old_edges[cut.first + i];
        }
        stack_corners[top + near] = old_corners[cut.second];
        stack_edges[top + near] = reversed(cut.edge);
        stack_counts[depth] = near + 1u;
        let beyond = count - near;
        stack_corners[base] = old_corners[cut.first];
        stack_edges[base] = cut.edge;
        for (var i = 0u; i < beyond; i += 1u) {
            stack_corners[base + 1u + i] = old_corners[(cut.second + i) % count];
            stack_edges[base + 1u + i] = old_edges[(cut.second + i) % count];
        }
        stack_counts[depth - 1u] = beyond + 1u;
        depth += 1u;
    }
    return configuration;
}

// Searches a light; returns one more than the configuration of its first triangle, or 0 if it has no area here.
fn search_light(light: u32, pixel: u32, neighbour: u32, at: vec2<u32>) -> u32 {
    let count = lights[light].count;
    var reach = 0.0;
    var middle = vec3<f32>(0.0);
    for (var i = 0u; i < count; i += 1u) {
        let corner = corners[lights[light].first + i];
        own[i] = (corner.high - place.high) + (corner.low - place.low);
        reach = max(reach, length(own[i]));
        middle += own[i] / f32(count);
    }
    light_normal = vec3<f32>(0.0);
    for (var i = 2u; i < count; i += 1u) {
        light_normal += 0.5 * cross(own[i - 1u] - own[0], own[i] - own[0]);
    }
    var extent = 0.0;
    for (var i = 0u; i < count; i += 1u) {
        extent = max(extent, distance(own[i], middle));
    }
    is_far = extent < 1e-2 * length(middle);
    form_factor = 0.0;
    visible_area = 0.0;
    let height = dot(light_normal, middle);
    if (abs(height) <= NOISE * length(light_normal) * reach) {
        return 0u;
    }
    state = pcg_jitter(at.x, at.y, light, frame.seed);
    var seen: array<u32, CORNERS>;
    for (var i = 0u; i < count; i += 1u) {
        seen[i] = u32(sees(own[i]));
    }
    for (var i = 0u; i < count; i += 1u) {
        let next = (i + 1u) % count;
        var before = none();
        if (frame.learns == 1u && surfaces[neighbour].seen != 0u) {
            before = edges[neighbour * frame.corners + lights[light].first + i];
        }
        stack_corners[i] = i;
        stack_edges[i] = search_edge(own[i], own[next], seen[i] | (seen[next] << 1u), before);
        edges[pixel * frame.corners + lights[light].first + i] = stack_edges[i];
    }
    stack_counts[0] = count;
    depth = 1u;
    let configuration = search_polygons();
    if (height > 0.0 && lights[light].two_sided == 0u) {
        form_factor = 0.0;
    }
    return configuration;
}

@compute @workgroup_size(8, 8)
fn area_search(@builtin(global_invocation_id) id: vec3<u32>) {
    let at = id.xy;
    if (any(at >= frame.size) || (frame.colour < 2u && ((at.x + at.y) & 1u) != frame.colour)) {
        return;
    }
    let pixel = at.y * frame.size.x + at.x;
    var result = Found(vec3<f32>(0.0), 0.0, 0.0, 0u, 0u, 0u, 0u);
    if (surfaces[pixel].seen != 0u) {
        place = Corner(surfaces[pixel].high, surfaces[pixel].low);
        normal = surfaces[pixel].normal;
        let neighbour = select(pixel - 1u, min(pixel + 1u, frame.size.x * frame.size.y - 1u), at.x == 0u);
        for (var light = 0u; light < frame.lights; light += 1u) {
            let configuration = search_light(light, pixel, neighbour, at);
            if (configuration > 0u) {
                result.fraction += visible_area / dot(light_normal, light_normal);
                result.lights += 1u;
                result.received += lights[light].colour * form_factor;
                result.factor += form_factor;
            }
            if (light == 0u) {
                result.configuration = configuration;
            }
        }
        result.tests = tests;
        result.overflow = u32(overflow);
    }
    found[pixel] = result;
}
