// Layered depth images: what `flat.rs`, `layers.rs` and `inside.rs` do, in passes over triangles and pixels.
//
// `count` walks the rows of all triangles and counts surfaces at pixels, `scan_blocks`, `scan_sums` and `add_sums` say
// where each pixel's list begins, and the host, which reads back how long all of them are together, gives memory for
// exactly that; `scatter` walks again and writes, `arrange` sorts each list and leaves those surfaces at which a ray goes
// into matter or comes out of it, as the table `policies` says (`crossed`), and `mark` marks the slabs between them.
//
// A centre is inside of a triangle or not by whole numbers of 64 bits, as vectors of a low and a high word.

struct Frame {
    size: vec2<u32>,
    triangles: u32,
    // The rows of all triangles.
    rows: u32,
    // 1 if depths are linear on the picture.
    parallel: u32,
    // Codes of the table's levels.
    rule: f32,
    // 1 to drop what a list ends with inside of matter.
    drop_odd: u32,
    // 1 if the host sorted the lists.
    sorted: u32,
    slabs: u32,
}

struct Triangle {
    // In units of 1/4096 of a pixel; areas are positive.
    a: vec2<i32>,
    b: vec2<i32>,
    c: vec2<i32>,
    // The first column and row, the number of columns, and rows of all triangles before this one.
    first: vec2<u32>,
    columns: u32,
    before: u32,
    // Depths of the corners, over the depths in perspective, and their inverses.
    depths: vec3<f32>,
    area: f32,
    inverses: vec3<f32>,
    shift: u32,
    // Of each edge 1, 2, 4 if a centre on it is inside; the last bit is set if the triangle faces away.
    flags: u32,
    triangle: u32,
    object: u32,
    // Normals of the corners, 16 bits each for the octahedron's x and y.
    normal_a: u32,
    normal_b: u32,
    normal_c: u32,
}

struct Entry {
    depth: f32,
    // The triangle; the last bit is set if it faces away.
    surface: u32,
    object: u32,
    // 16 bits each for the octahedron's x and y.
    normal: u32,
}

@group(0) @binding(0) var<uniform> frame: Frame;
@group(0) @binding(1) var<storage, read> triangles: array<Triangle>;
@group(0) @binding(2) var<storage, read_write> counts: array<atomic<u32>>;
// Of each pixel where its list begins, and how long it is; the last bit is set if it ended inside of matter.
@group(0) @binding(3) var<storage, read_write> lists: array<vec2<u32>>;
// Sums of blocks of pixels; for `mark` the edges of slabs, as bits.
@group(0) @binding(4) var<storage, read_write> words: array<u32>;
@group(0) @binding(5) var<storage, read_write> entries: array<Entry>;
// The length of all lists together and of the longest, the least and the largest depth as ordered
// words, of which the first is inverted, the lists that
// ended inside, and from FIRST_MARK on how many more pixels hold matter in a slab than in the one before.
@group(0) @binding(6) var<storage, read_write> marks: array<atomic<u32>>;

const TOTAL = 0u;
const LONGEST = 1u;
const NEAREST = 2u;
const FARTHEST = 3u;
const ODD = 4u;
const FIRST_MARK = 5u;

const UNITS = 4096;
const AWAY = 0x80000000u;
const THREADS = 256u;

// Numbers of 64 bits.

fn add64(a: vec2<u32>, b: vec2<u32>) -> vec2<u32> {
    let low = a.x + b.x;
    return vec2<u32>(low, a.y + b.y + u32(low < a.x));
}

fn negative64(a: vec2<u32>) -> vec2<u32> {
    return add64(~a, vec2<u32>(1u, 0u));
}

fn product64(a: i32, b: i32) -> vec2<u32> {
    let x = u32(abs(a));
    let y = u32(abs(b));
    let low = (x & 0xffffu) * (y & 0xffffu);
    let one = (x & 0xffffu) * (y >> 16u);
    let other = (x >> 16u) * (y & 0xffffu);
    let middle = (low >> 16u) + (one & 0xffffu) + (other & 0xffffu);
    let high = (x >> 16u) * (y >> 16u) + (one >> 16u) + (other >> 16u) + (middle >> 16u);
    let result = vec2<u32>((low & 0xffffu) | (middle << 16u), high);
    if ((a < 0) != (b < 0)) {
        return negative64(result);
    }
    return result;
}

// The low word of a number from 0 on, shifted to the right by less than 64.
fn shifted64(a: vec2<u32>, by: u32) -> u32 {
    if (by == 0u) {
        return a.x;
    }
    if (by < 32u) {
        return (a.x >> by) | (a.y << (32u - by));
    }
    return a.y >> (by - 32u);
}

fn side(ends: vec4<i32>, at: vec2<i32>) -> vec2<u32> {
    let edge = ends.zw - ends.xy;
    let to = at - ends.xy;
    return add64(product64(edge.x, to.y), negative64(product64(edge.y, to.x)));
}

fn is_inside(side: vec2<u32>, tie: u32) -> bool {
    return (side.y < AWAY) && (any(side != vec2<u32>(0u)) || (tie != 0u));
}

// A sum that stays at the largest word.
fn add(a: u32, b: u32) -> u32 {
    return select(a + b, 0xffffffffu, b > 0xffffffffu - a);
}

fn line(group: vec3<u32>, groups: vec3<u32>, thread: u32, threads: u32) -> u32 {
    return (group.y * groups.x + group.x) * threads + thread;
}

fn share(side: vec2<u32>, triangle: Triangle) -> f32 {
    return f32(shifted64(side, triangle.shift)) / triangle.area;
}

fn mixed(values: vec3<f32>, b: f32, c: f32) -> f32 {
    return values.x + b * (values.y - values.x) + c * (values.z - values.x);
}

fn walk(row: u32, scatters: bool) {
    var index = 0u;
    var end = frame.triangles;
    while (end - index > 1u) {
        let middle = (index + end) / 2u;
        if (triangles[middle].before <= row) {
            index = middle;
        } else {
            end = middle;
        }
    }
    let triangle = triangles[index];
    let y = triangle.first.y + (row - triangle.before);
    let at = vec2<i32>(vec2<u32>(triangle.first.x, y)) * UNITS + UNITS / 2;
    let ends_a = vec4<i32>(triangle.b, triangle.c);
    let ends_b = vec4<i32>(triangle.c, triangle.a);
    let ends_c = vec4<i32>(triangle.a, triangle.b);
    var a = side(ends_a, at);
    var b = side(ends_b, at);
    var c = side(ends_c, at);
    let step_a = product64(ends_a.y - ends_a.w, UNITS);
    let step_b = product64(ends_b.y - ends_b.w, UNITS);
    let step_c = product64(ends_c.y - ends_c.w, UNITS);
    var pixel = y * frame.size.x + triangle.first.x;
    for (var column = 0u; column < triangle.columns; column++) {
        let flags = triangle.flags;
        if (is_inside(a, flags & 1u) && is_inside(b, flags & 2u) && is_inside(c, flags & 4u)) {
            if (scatters) {
                let u = share(b, triangle);
                let v = share(c, triangle);
                var depth = mixed(triangle.depths, u, v);
                if (frame.parallel == 0u) {
                    depth = depth / mixed(triangle.inverses, u, v);
                }
                let place = lists[pixel].x + atomicSub(&counts[pixel], 1u) - 1u;
                let normal = normal_at(triangle, u, v);
                entries[place] = Entry(depth, triangle.triangle | (flags & AWAY), triangle.object, normal);
            } else {
                atomicAdd(&counts[pixel], 1u);
            }
        }
        a = add64(a, step_a);
        b = add64(b, step_b);
        c = add64(c, step_c);
        pixel++;
    }
}

fn normal_at(triangle: Triangle, u: f32, v: f32) -> u32 {
    if (triangle.normal_a == triangle.normal_b && triangle.normal_a == triangle.normal_c) {
        return triangle.normal_a;
    }
    let a = octahedral(triangle.normal_a);
    return packed(a + u * (octahedral(triangle.normal_b) - a) + v * (octahedral(triangle.normal_c) - a));
}

// A direction on an octahedron that is opened out: its place, and back.
fn packed(normal: vec3<f32>) -> u32 {
    let sum = abs(normal.x) + abs(normal.y) + abs(normal.z);
    var at = select(vec2<f32>(0.0), normal.xy / sum, sum > 0.0);
    if (normal.z < 0.0) {
        at = (1.0 - abs(at.yx)) * select(vec2<f32>(-1.0), vec2<f32>(1.0), at >= vec2<f32>(0.0));
    }
    let words = vec2<u32>(clamp(at * 0.5 + 0.5, vec2<f32>(0.0), vec2<f32>(1.0)) * 65535.0 + 0.5);
    return words.x | (words.y << 16u);
}

fn octahedral(word: u32) -> vec3<f32> {
    let at = vec2<f32>(vec2<u32>(word & 0xffffu, word >> 16u)) / 65535.0 * 2.0 - 1.0;
    let z = 1.0 - abs(at.x) - abs(at.y);
    var xy = at;
    if (z < 0.0) {
        xy = (1.0 - abs(at.yx)) * select(vec2<f32>(-1.0), vec2<f32>(1.0), at >= vec2<f32>(0.0));
    }
    return normalize(vec3<f32>(xy, z));
}

@compute @workgroup_size(64)
fn count(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>,
         @builtin(local_invocation_index) thread: u32) {
    let row = line(group, groups, thread, 64u);
    if (row < frame.rows) {
        walk(row, false);
    }
}

@compute @workgroup_size(64)
fn scatter(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>,
           @builtin(local_invocation_index) thread: u32) {
    let row = line(group, groups, thread, 64u);
    if (row < frame.rows) {
        walk(row, true);
    }
}

var<workgroup> sums: array<u32, 256>;

// Sums over a workgroup: of the threads before this one, and of all.
fn scan(thread: u32, own: u32) -> vec2<u32> {
    sums[thread] = own;
    workgroupBarrier();
    for (var reach = 1u; reach < THREADS; reach = 2u * reach) {
        var sum = sums[thread];
        if (thread >= reach) {
            sum = add(sum, sums[thread - reach]);
        }
        workgroupBarrier();
        sums[thread] = sum;
        workgroupBarrier();
    }
    let before = select(sums[(thread + THREADS - 1u) % THREADS], 0u, thread == 0u);
    return vec2<u32>(before, sums[THREADS - 1u]);
}

@compute @workgroup_size(256)
fn scan_blocks(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>,
               @builtin(local_invocation_index) thread: u32) {
    let pixel = line(group, groups, thread, THREADS);
    let pixels = frame.size.x * frame.size.y;
    var own = 0u;
    if (pixel < pixels) {
        own = atomicLoad(&counts[pixel]);
        atomicMax(&marks[LONGEST], own);
    }
    let sum = scan(thread, own);
    if (pixel < pixels) {
        lists[pixel] = vec2<u32>(sum.x, own);
        if (thread == 0u) {
            words[pixel / THREADS] = sum.y;
        }
    }
}

// One workgroup, whose threads take a stretch of blocks each.
@compute @workgroup_size(256)
fn scan_sums(@builtin(local_invocation_index) thread: u32) {
    let blocks = (frame.size.x * frame.size.y + THREADS - 1u) / THREADS;
    let stretch = (blocks + THREADS - 1u) / THREADS;
    let first = min(thread * stretch, blocks);
    let end = min(first + stretch, blocks);
    var own = 0u;
    for (var block = first; block < end; block++) {
        own = add(own, words[block]);
    }
    let sum = scan(thread, own);
    var before = sum.x;
    for (var block = first; block < end; block++) {
        let of_block = words[block];
        words[block] = before;
        before = add(before, of_block);
    }
    if (thread == 0u) {
        atomicStore(&marks[TOTAL], sum.y);
    }
}

@compute @workgroup_size(256)
fn add_sums(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>,
            @builtin(local_invocation_index) thread: u32) {
    let pixel = line(group, groups, thread, THREADS);
    if (pixel < frame.size.x * frame.size.y) {
        lists[pixel].x = add(lists[pixel].x, words[pixel / THREADS]);
    }
}

// Depths in an order of words.
fn ordered(depth: f32) -> u32 {
    let bits = bitcast<u32>(depth);
    return bits ^ select(AWAY, 0xffffffffu, bits >= AWAY);
}

fn is_before(a: Entry, b: Entry) -> bool {
    let x = ordered(a.depth);
    let y = ordered(b.depth);
    return (x < y) || ((x == y) && (a.surface < b.surface));
}

fn insertion_sort(first: u32, length: u32) {
    for (var i = 1u; i < length; i++) {
        let entry = entries[first + i];
        var place = i;
        while (place > 0u && is_before(entry, entries[first + max(place, 1u) - 1u])) {
            entries[first + place] = entries[first + place - 1u];
            place--;
        }
        entries[first + place] = entry;
    }
}

fn sift(first: u32, start: u32, length: u32) {
    let entry = entries[first + start];
    var place = start;
    while (2u * place + 1u < length) {
        var child = 2u * place + 1u;
        if (child + 1u < length && is_before(entries[first + child], entries[first + child + 1u])) {
            child++;
        }
        if (!is_before(entry, entries[first + child])) {
            break;
        }
        entries[first + place] = entries[first + child];
        place = child;
    }
    entries[first + place] = entry;
}

fn heap_sort(first: u32, length: u32) {
    for (var start = length / 2u; start > 0u; start--) {
        sift(first, start - 1u, length);
    }
    for (var end = length - 1u; end > 0u; end--) {
        let last = entries[first + end];
        entries[first + end] = entries[first];
        entries[first] = last;
        sift(first, 0u, end);
    }
}

@compute @workgroup_size(64)
fn arrange(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>,
           @builtin(local_invocation_index) thread: u32) {
    let pixel = line(group, groups, thread, 64u);
    if (pixel >= frame.size.x * frame.size.y) {
        return;
    }
    let first = lists[pixel].x;
    let length = lists[pixel].y;
    atomicStore(&counts[pixel], length);
    if (length == 0u) {
        return;
    }
    if (frame.sorted == 0u) {
        if (length <= 32u) {
            insertion_sort(first, length);
        } else {
            heap_sort(first, length);
        }
    }
    atomicMax(&marks[NEAREST], ~ordered(entries[first].depth));
    atomicMax(&marks[FARTHEST], ordered(entries[first + length - 1u].depth));
    var kept = 0u;
    var wound = 0.0;
    var inside = false;
    for (var i = 0u; i < length; i++) {
        let entry = entries[first + i];
        let now = policies_crossed(frame.rule, wound, entry.surface < AWAY);
        if (now.inside != inside) {
            entries[first + kept] = entry;
            kept++;
        }
        wound = now.wound;
        inside = now.inside;
    }
    if (inside) {
        atomicAdd(&marks[ODD], 1u);
        kept -= frame.drop_odd;
    }
    lists[pixel].y = kept | select(0u, AWAY, inside);
}

// The slab that a surface lies in.
fn slab_of(depth: f32) -> u32 {
    var index = 0u;
    var end = frame.slabs;
    while (end - index > 1u) {
        let middle = (index + end) / 2u;
        if (bitcast<f32>(words[middle]) <= depth) {
            index = middle;
        } else {
            end = middle;
        }
    }
    return index;
}

@compute @workgroup_size(64)
fn mark(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>,
        @builtin(local_invocation_index) thread: u32) {
    let pixel = line(group, groups, thread, 64u);
    if (pixel >= frame.size.x * frame.size.y) {
        return;
    }
    let first = lists[pixel].x;
    let length = lists[pixel].y & 0x7fffffffu;
    for (var i = 0u; i < length; i += 2u) {
        atomicAdd(&marks[FIRST_MARK + slab_of(entries[first + i].depth)], 1u);
        if (i + 1u < length) {
            atomicSub(&marks[FIRST_MARK + slab_of(entries[first + i + 1u].depth) + 1u], 1u);
        }
    }
}
