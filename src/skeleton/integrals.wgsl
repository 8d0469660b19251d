// Light at surfaces: what `cells.rs` and `picture.rs` do, a thread for each base
// cell of each surface.
//
// The cells inside of a base cell are visited in depth-first order without a
// stack: a cell is a number with two bits for each division, and the next one
// is found by counting on. Of the numbers that make the light, the skeleton
// computes none: ranges of cosines, coefficients of lobes and moments come from
// the tables.
//
// The host says how many balls, plates, corners and lobes there are.
//
// Why not a thread for each surface: on Mesa's rasteriser the picture then had
// blocks of wrong pixels, as if loops were left early once a thread had gone
// through some 65,000 rounds in all.

struct Surface {
    place: vec3<f32>,
    // The ball it is part of, or the plate, counted after the balls.
    body: u32,
    normal: vec3<f32>,
    // 0 where no surface is seen.
    seen: u32,
}

struct Lobe {
    axis: vec3<f32>,
    sharpness: f32,
    amplitude: vec3<f32>,
}

// An array has one element more than there are things, as it must have one.
struct Scene {
    // Largest error of the border, in radians.
    border: f32,
    // Largest error of a lobe's linear approximation, relative to its largest value.
    curvature: f32,
    // Most divisions of a base cell.
    depth: u32,
    // Centre and radius.
    balls: array<vec4<f32>, BALLS + 1u>,
    // Where in `corners` a plate begins and ends.
    plates: array<vec4<u32>, PLATES + 1u>,
    lobes: array<Lobe, LOBES + 1u>,
    corners: array<vec4<f32>, CORNERS + 1u>,
}

struct Lit {
    light: vec3<f32>,
    // Cells, and edges times 2^16.
    counts: u32,
}

@group(0) @binding(0) var<storage, read> surfaces: array<Surface>;
@group(0) @binding(1) var<storage, read> scene: Scene;
@group(0) @binding(2) var<storage, read_write> lit: array<Lit>;

const PI = 3.14159265358979;
const BASE = vec2<u32>(8u, 4u);
const CELLS = 32u;
// Surfaces of a workgroup.
const ROW = 8u;

// What each thread found, to be added up.
var<workgroup> found: array<Lit, ROW * CELLS>;

// What is seen from the surface: the axis and angle of each ball's cap, and of
// a cap around each plate; of each side of a plate where it begins and the
// normal of its plane.
var<private> normal: vec3<f32>;
var<private> body: u32;
var<private> caps: array<vec4<f32>, BALLS + 1u>;
var<private> around: array<vec4<f32>, PLATES + 1u>;
var<private> ends: array<vec3<f32>, CORNERS + 1u>;
var<private> arcs: array<vec3<f32>, CORNERS + 1u>;

struct Patch {
    lo: vec2<f32>,
    hi: vec2<f32>,
}

// Ends in ascending azimuth; the sign is 0 for an edge that has no area.
struct Edge {
    first: vec2<f32>,
    last: vec2<f32>,
    sign: f32,
}

// A corner of a patch with its distance to the border of visibility.
struct Corner {
    at: vec2<f32>,
    distance: f32,
}

fn unit_or_zero(v: vec3<f32>) -> vec3<f32> {
    let square = dot(v, v);
    return select(vec3<f32>(0.0), v * inverseSqrt(max(square, 1e-30)), square > 1e-30);
}

fn prepare(surface: Surface) {
    normal = surface.normal;
    body = surface.body;
    for (var i = 0u; i < BALLS; i++) {
        let offset = scene.balls[i].xyz - surface.place;
        let distance = length(offset);
        caps[i] = vec4<f32>(offset / distance, asin(min(scene.balls[i].w / distance, 1.0)));
    }
    for (var p = 0u; p < PLATES; p++) {
        let first = scene.plates[p].x;
        let end = scene.plates[p].y;
        let corner = scene.corners[first].xyz;
        let plane = cross(scene.corners[first + 1u].xyz - corner, scene.corners[first + 2u].xyz - corner);
        let turn = sign(dot(corner - surface.place, plane));
        var middle = vec3<f32>(0.0);
        for (var i = first; i < end; i++) {
            let next = select(i + 1u, first, i + 1u == end);
            ends[i] = unit_or_zero(scene.corners[i].xyz - surface.place);
            arcs[i] = turn * unit_or_zero(cross(ends[i], unit_or_zero(scene.corners[next].xyz - surface.place)));
            middle += ends[i];
        }
        middle = unit_or_zero(middle);
        var least = 1.0;
        for (var i = first; i < end; i++) {
            least = min(least, dot(middle, ends[i]));
        }
        around[p] = vec4<f32>(middle, select(PI, angle(least), least > 0.0));
    }
}

fn angle(cosine: f32) -> f32 {
    return acos(clamp(cosine, -1.0, 1.0));
}

fn arc_distance(from_end: vec3<f32>, to_end: vec3<f32>, arc: vec3<f32>, direction: vec3<f32>) -> f32 {
    let along = cross(arc, direction);
    if (dot(from_end, along) * dot(to_end, along) < 0.0 && dot(from_end + to_end, direction) > 0.0) {
        return asin(min(abs(dot(arc, direction)), 1.0));
    }
    return angle(max(dot(from_end, direction), dot(to_end, direction)));
}

fn plate_distance(plate: vec4<u32>, direction: vec3<f32>) -> f32 {
    var depth = 1.0;
    var nearest = PI;
    for (var i = plate.x; i < plate.y; i++) {
        let next = select(i + 1u, plate.x, i + 1u == plate.y);
        depth = min(depth, dot(arcs[i], direction));
        nearest = min(nearest, arc_distance(ends[i], ends[next], arcs[i], direction));
    }
    return select(nearest, -asin(depth), depth > 0.0);
}

// Angle to the nearest change of visibility: positive where visible.
fn visible(at: vec2<f32>) -> f32 {
    let flat = sin(at.y);
    let direction = vec3<f32>(cos(at.x) * flat, sin(at.x) * flat, cos(at.y));
    var distance = asin(clamp(dot(normal, direction), -1.0, 1.0));
    for (var i = 0u; i < BALLS; i++) {
        if (i != body) {
            distance = min(distance, angle(dot(caps[i].xyz, direction)) - caps[i].w);
        }
    }
    for (var i = 0u; i < PLATES; i++) {
        if (BALLS + i != body && angle(dot(around[i].xyz, direction)) - around[i].w < distance) {
            distance = min(distance, plate_distance(scene.plates[i], direction));
        }
    }
    return distance;
}

// The patch that a cell number says, at a depth inside of a base cell.
fn patch_of(base: u32, code: u32, depth: u32) -> Patch {
    var place = vec2<u32>(base % BASE.x, base / BASE.x);
    for (var level = 0u; level < depth; level++) {
        let quarter = code >> (2u * (depth - 1u - level));
        place = 2u * place + vec2<u32>(quarter & 1u, (quarter >> 1u) & 1u);
    }
    // Neighbours compute the same numbers for the same place.
    let step = vec2<f32>(2.0 * PI, PI) / vec2<f32>(BASE << vec2<u32>(depth));
    return Patch(vec2<f32>(place) * step, vec2<f32>(place + vec2<u32>(1u)) * step);
}

// No direction of the patch is farther from its centre.
fn reach(cell: Patch) -> f32 {
    let half = 0.5 * (cell.hi - cell.lo);
    let across = cell.lo.y <= 0.5 * PI && cell.hi.y >= 0.5 * PI;
    let widest = select(max(sin(cell.lo.y), sin(cell.hi.y)), 1.0, across);
    return length(vec2<f32>(half.x * widest, half.y));
}

// Whether the distance differs from the interpolation of its corner values.
fn bent(cell: Patch, corners: array<Corner, 4>, at_centre: f32) -> bool {
    let distances = vec4<f32>(corners[0].distance, corners[1].distance, corners[2].distance, corners[3].distance);
    if (abs(at_centre - 0.25 * dot(distances, vec4<f32>(1.0))) > scene.border) {
        return true;
    }
    var result = false;
    var all = corners;
    for (var i = 0u; i < 4u; i++) {
        let a = all[i];
        let b = all[(i + 1u) & 3u];
        result = result || abs(visible(0.5 * (a.at + b.at)) - 0.5 * (a.distance + b.distance)) > scene.border;
    }
    return result;
}

// How far a lobe is from its linear approximation over a range, relative to its largest value.
fn curvature(sharpness: f32, range: vec2<f32>) -> f32 {
    let y = 0.5 * sharpness * (range.y - range.x);
    return exp(sharpness * (range.y - 1.0)) * max(exp(-y) * y * y / 3.0, select(0.0, 0.5, y > 1.0));
}

// Where the distance is zero between two corners: linear, then one step of false position.
fn crossing(a: Corner, b: Corner) -> vec2<f32> {
    let d = a.distance;
    let e = b.distance;
    let part = d / (d - e);
    let f = visible(a.at + (b.at - a.at) * part);
    let nearer = part * d / (d - f);
    let farther = part + (1.0 - part) * f / (f - e);
    return a.at + (b.at - a.at) * clamp(select(nearer, farther, (f > 0.0) == (d > 0.0)), 0.0, 1.0);
}

// A point beside the middle of a chord, such that the polygon has the area below the parabola.
fn bulge(cell: Patch, start: vec2<f32>, end: vec2<f32>) -> vec2<f32> {
    let middle = 0.5 * (start + end);
    let chord = end - start;
    let size = length(chord);
    if (size == 0.0) {
        return middle;
    }
    let across = vec2<f32>(-chord.y, chord.x) / size;
    let step = 0.01 * size;
    let here = visible(middle);
    let change = visible(middle + across * step) - here;
    // A step as long as the chord is beyond what is taken.
    if (abs(here * step) > abs(change) * 0.3 * size) {
        return middle;
    }
    return clamp(middle - across * (4.0 / 3.0 * here * step / select(change, 1.0, change == 0.0)), cell.lo, cell.hi);
}

// The area between an edge and the upper side; none if the edge is vertical or on that side.
fn edge(cell: Patch, start: vec2<f32>, end: vec2<f32>) -> Edge {
    if (start.x == end.x || (start.y == cell.lo.y && end.y == cell.lo.y)) {
        return Edge(start, end, 0.0);
    }
    if (start.x > end.x) {
        return Edge(end, start, 1.0);
    }
    return Edge(start, end, -1.0);
}

// Light from the directions of a base cell.
fn light_of(surface: Surface, base: u32) -> Lit {
    prepare(surface);
    var sum = vec3<f32>(0.0);
    var cells = 0u;
    var edges = 0u;
    var code = 0u;
    var depth = 0u;
    while (code >> (2u * depth) == 0u) {
        let cell = patch_of(base, code, depth);
        let radius = reach(cell);
        let at_centre = visible(0.5 * (cell.lo + cell.hi));
        if (at_centre >= -radius) {
            // Counter-clockwise.
            var corners: array<Corner, 4>;
            for (var i = 0u; i < 4u; i++) {
                let at = vec2<f32>(
                    select(cell.lo.x, cell.hi.x, i == 1u || i == 2u),
                    select(cell.lo.y, cell.hi.y, i >= 2u),
                );
                corners[i] = Corner(at, visible(at));
            }
            var ranges: array<vec2<f32>, LOBES + 1u>;
            var split = false;
            for (var i = 0u; i < LOBES; i++) {
                let axis = scene.lobes[i].axis;
                let range = spherical_gaussian_interval(cell.lo.x, cell.hi.x, cell.lo.y, cell.hi.y, axis.x, axis.y, axis.z);
                ranges[i] = vec2<f32>(range.a, range.b);
                split = split || curvature(scene.lobes[i].sharpness, ranges[i]) > scene.curvature;
            }
            if (depth < scene.depth && (split || (at_centre <= radius && bent(cell, corners, at_centre)))) {
                code <<= 2u;
                depth += 1u;
                continue;
            }

            // The sides of the visible part, where it begins to be hidden, and where that ends.
            var list: array<Edge, 8>;
            var count = 0u;
            var leaves: array<vec2<f32>, 2>;
            var enters: array<vec2<f32>, 2>;
            var left = 0u;
            var entered = 0u;
            for (var i = 0u; i < 4u; i++) {
                let a = corners[i];
                let b = corners[(i + 1u) & 3u];
                if (a.distance > 0.0 && b.distance > 0.0) {
                    list[count] = edge(cell, a.at, b.at);
                    count += 1u;
                } else if (a.distance > 0.0) {
                    let at = crossing(a, b);
                    list[count] = edge(cell, a.at, at);
                    count += 1u;
                    leaves[left & 1u] = at;
                    left += 1u;
                } else if (b.distance > 0.0) {
                    let at = crossing(a, b);
                    list[count] = edge(cell, at, b.at);
                    count += 1u;
                    enters[entered & 1u] = at;
                    entered += 1u;
                }
            }
            // Of two places where it ends to be hidden, a border leads to the next one if the centre is
            // visible, and otherwise to the one before.
            let other = select(0u, 1u, left == 2u && (corners[0].distance > 0.0) == (at_centre <= 0.0));
            for (var i = 0u; i < left; i++) {
                let start = leaves[i];
                let end = enters[(i + other) & 1u];
                let middle = bulge(cell, start, end);
                list[count] = edge(cell, start, middle);
                list[count + 1u] = edge(cell, middle, end);
                count += 2u;
            }

            // First and second moments of the visible part: ∫∫ ω, and the rows of ∫∫ ω ω.
            var first = vec3<f32>(0.0);
            var diagonal = vec3<f32>(0.0);
            var mixed = vec3<f32>(0.0);
            var used = 0u;
            for (var i = 0u; i < count; i++) {
                let e = list[i];
                if (e.sign != 0.0) {
                    let m = double_product_moments(e.first.x, e.last.x, cell.lo.y, e.first.y, e.last.y);
                    first += e.sign * vec3<f32>(m.mx, m.my, m.mz);
                    diagonal += e.sign * vec3<f32>(m.Mxx, m.Myy, m.Mzz);
                    mixed += e.sign * vec3<f32>(m.Myz, m.Mxz, m.Mxy);
                    used += 1u;
                }
            }
            let n = surface.normal;
            let along = dot(first, n);
            let tensor = diagonal * n + mixed.zxy * n.yzx + mixed.yzx * n.zxy;
            for (var i = 0u; used > 0u && i < LOBES; i++) {
                let lobe = scene.lobes[i];
                // The largest value is 1; colours are applied here.
                let alpha = spherical_gaussian_alpha(1.0, lobe.sharpness, ranges[i].x, ranges[i].y);
                let beta = spherical_gaussian_beta(1.0, lobe.sharpness, ranges[i].x, ranges[i].y);
                sum += lobe.amplitude * (alpha * along + beta * dot(lobe.axis, tensor));
            }
            cells += select(0u, 1u, used > 0u);
            edges += used;
        }
        code += 1u;
        while (depth > 0u && (code & 3u) == 0u) {
            code >>= 2u;
            depth -= 1u;
        }
    }
    return Lit(sum, cells | (edges << 16u));
}

@compute @workgroup_size(ROW, CELLS)
fn light(@builtin(global_invocation_id) id: vec3<u32>, @builtin(local_invocation_id) thread: vec3<u32>) {
    var own = Lit(vec3<f32>(0.0), 0u);
    if (id.x < arrayLength(&surfaces)) {
        let surface = surfaces[id.x];
        if (surface.seen != 0u) {
            own = light_of(surface, thread.y);
        }
    }
    found[thread.y * ROW + thread.x] = own;
    workgroupBarrier();
    if (thread.y == 0u && id.x < arrayLength(&surfaces)) {
        for (var i = 1u; i < CELLS; i++) {
            let other = found[i * ROW + thread.x];
            own.light += other.light;
            own.counts += other.counts;
        }
        lit[id.x] = own;
    }
}
