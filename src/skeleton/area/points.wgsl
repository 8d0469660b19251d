
// Points that each have a light and bodies of their own, as the point sees them, in a unit of the light's size.

struct Query {
    normal: vec3<f32>,
    // The corners of the light, counter-clockwise as seen from the point.
    first: u32,
    // The rows of the transform.
    row_0: vec3<f32>,
    count: u32,
    row_1: vec3<f32>,
    // The list of bodies.
    list: u32,
    row_2: vec3<f32>,
    list_count: u32,
    // 0 if the light sends nothing to this side: then only shares of its area are asked for.
    emits: u32,
    // 0 if there is no transform.
    is_shaped: u32,
}

struct Answer {
    // Shares of the light's area: what nothing hides, and what of that lies above the horizon.
    share: f32,
    share_above: f32,
    form_factor: f32,
    form_factor_unshadowed: f32,
    shaped: f32,
    shaped_unshadowed: f32,
    // The work for the form factor.
    pieces: u32,
    clips: u32,
    // 1 where more memory or more steps were needed than there are.
    overflow: u32,
}

@group(0) @binding(4) var<storage, read> queries: array<Query>;
@group(0) @binding(5) var<storage, read_write> answers: array<Answer>;

@compute @workgroup_size(64) fn area_points(@builtin(global_invocation_id) id: vec3<u32>) {
    if (id.x >= arrayLength(&queries)) {
        return;
    }
    let query = queries[id.x];
    normal = query.normal;
    rows[0] = query.row_0;
    rows[1] = query.row_1;
    rows[2] = query.row_2;
    var result: Answer;
    // The host has seen that the point does not lie in the light's plane.
    see_light(query.first, query.count);
    let whole = length(light_normal);
    let is_open = see_bodies(query.list, query.list_count);

    copy(LIGHT, CURRENT);
    if (is_open) {
        add_up(AREAS);
    }
    result.share = visible / whole;

    visible = 0.0;
    pieces = 0u;
    clips = 0u;
    above_horizon();
    if (query.emits != 0u && counts[CURRENT] != 0u) {
        result.form_factor_unshadowed = integrate(CURRENT, false);
    }
    if (is_open) {
        add_up(select(AREAS, AREAS | FACTORS, query.emits != 0u));
    }
    result.share_above = visible / whole;
    result.form_factor = form_factor;
    result.pieces = pieces;
    result.clips = clips;

    if (query.is_shaped != 0u && query.emits != 0u) {
        clips = 0u;
        above_horizon();
        above_transformed_horizon();
        if (counts[CURRENT] != 0u) {
            result.shaped_unshadowed = integrate(CURRENT, true);
        }
        if (is_open) {
            add_up(SHAPED);
        }
        result.shaped = shaped;
    }
    result.overflow = u32(overflow);
    answers[id.x] = result;
}
