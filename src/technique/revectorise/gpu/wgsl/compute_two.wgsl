// Two dispatches: the first looks at every pixel and queues those at silhouettes,
// the second treats the queue. Its threads have the same work to do, while
// pixels at silhouettes are few and far between in the picture.

@group(1) @binding(0) var<storage, read_write> values: array<f32>;
// Workgroups of the second dispatch, then the number of pixels queued.
@group(1) @binding(1) var<storage, read_write> work: array<atomic<u32>, 4>;
@group(1) @binding(2) var<storage, read_write> queue: array<u32>;

const QUEUE_GROUP: u32 = 64u;

// A workgroup counts its pixels first, so that it asks for places in the queue once.
var<workgroup> count: atomic<u32>;
var<workgroup> first: u32;

@compute @workgroup_size(8, 8)
fn glance_pass(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let at = id.y * frame.pixels.x + id.x;
    var edge = false;
    if (all(id.xy < frame.pixels)) {
        let seen = glance(id.xy);
        values[at] = seen.value;
        edge = seen.edge;
    }
    var place = 0u;
    if (edge) {
        place = atomicAdd(&count, 1u);
    }
    workgroupBarrier();
    if (local == 0u) {
        let all_of_them = atomicLoad(&count);
        if (all_of_them > 0u) {
            first = atomicAdd(&work[3], all_of_them);
            atomicMax(&work[0], (first + all_of_them + QUEUE_GROUP - 1u) / QUEUE_GROUP);
        }
    }
    workgroupBarrier();
    if (edge) {
        queue[first + place] = at;
    }
}

@compute @workgroup_size(64)
fn queue_pass(@builtin(global_invocation_id) id: vec3<u32>) {
    if (id.x < atomicLoad(&work[3])) {
        let at = queue[id.x];
        values[at] = visibility(vec2<u32>(at % frame.pixels.x, at / frame.pixels.x)).value;
    }
}
