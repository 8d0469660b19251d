// Matter with patterns, for `convolve.wgsl`: what `detail.rs` and `fine.rs` do.

// The place of a depth at a pixel in the space of a pattern.
fn place_of(material: Material, id: vec2<u32>, depth: f32) -> vec3<f32> {
    let unit = frame.pixel_at_base + depth * frame.pixel_growth;
    let at = (vec2<f32>(id) + 0.5 - 0.5 * vec2<f32>(frame.size)) * unit;
    return material.origin + at.x * material.right + at.y * material.down + depth * material.away;
}

fn pattern_at(material: Material, place: vec3<f32>) -> f32 {
    let numbers = material.numbers;
    if (material.pattern == FBM) {
        var next = NoiseFbmOctaveValue(place.x, place.y, place.z, 1.0, 0.0);
        for (var i = 0u; i < material.octaves; i++) {
            next = noise_fbm_octave(next.px, next.py, next.pz, numbers.x, numbers.y, next.height, next.total);
        }
        return next.total;
    }
    if (material.pattern == RIDGED) {
        var next = NoiseRidgedOctaveValue(place.x, place.y, place.z, 1.0, 1.0, 0.0);
        for (var i = 0u; i < material.octaves; i++) {
            next = noise_ridged_octave(next.px, next.py, next.pz, numbers.x, numbers.y, numbers.z, numbers.w,
                                       next.height, next.weight, next.total);
        }
        return next.total;
    }
    return noise_brick(place.x, place.y, place.z, numbers.x, numbers.y, numbers.z, numbers.w);
}

// The matter that a value of a pattern stands for.
struct Meant {
    colour: vec3<f32>,
    opacity: f32,
    transport: vec3<f32>,
    extinction: f32,
}

fn meant(material: Material, value: f32) -> Meant {
    var next = 1u;
    while (next + 1u < material.knots && lookups[material.first_knot + next * KNOT] <= value) {
        next++;
    }
    let a = material.first_knot + (next - 1u) * KNOT;
    let b = a + KNOT;
    let width = lookups[b] - lookups[a];
    var part = 1.0;
    if (width > 0.0) {
        part = clamp((value - lookups[a]) / width, 0.0, 1.0);
    }
    var mixed = array<f32, 9>();
    for (var i = 1u; i < KNOT; i++) {
        mixed[i] = lookups[a + i] + part * (lookups[b + i] - lookups[a + i]);
    }
    return Meant(vec3<f32>(mixed[1], mixed[2], mixed[3]), mixed[4], vec3<f32>(mixed[5], mixed[6], mixed[7]), mixed[8]);
}

// Opacity and colour of a way on which the pattern goes from one value to another.
fn integrated(material: Material, ends: vec2<f32>, path: f32) -> vec4<f32> {
    let lo = lookups[material.first_knot];
    let hi = lookups[material.first_knot + (material.knots - 1u) * KNOT];
    let s = clamp(ends, vec2<f32>(lo), vec2<f32>(hi));
    let middle = meant(material, 0.5 * (s.x + s.y));
    var result = vec4<f32>(0.0);
    for (var channel = 0u; channel < 3u; channel++) {
        var tau = 0.0;
        var tau_c = 0.0;
        for (var i = 0u; i + 1u < material.knots; i++) {
            let a = material.first_knot + i * KNOT;
            let b = a + KNOT;
            let piece = shade_piece_of_ramp(s.x, s.y, lookups[a], lookups[b], lookups[a + 8u], lookups[b + 8u],
                                            lookups[a + 1u + channel], lookups[b + 1u + channel]);
            tau += piece.tau;
            tau_c += piece.tau_c;
        }
        let found = shade_preintegrated(tau, tau_c, s.x, s.y, path, middle.extinction, middle.colour[channel], hi - lo);
        result[channel] = found.colour;
        result.w = found.alpha;
    }
    return result;
}

fn detailed(material: Material, id: vec2<u32>, within: Parts, is_jittered: bool) -> Matter {
    if (frame.integrates != 0u) {
        let ends = vec2<f32>(pattern_at(material, place_of(material, id, within.front)),
                             pattern_at(material, place_of(material, id, within.back)));
        let found = integrated(material, ends, within.path);
        let transport = meant(material, 0.5 * (ends.x + ends.y)).transport;
        let through = 1.0 - found.w * (1.0 - transport);
        return Matter(found.w > 0.0, found.w, through, found.rgb, within.object);
    }
    var depth = within.front + 0.5 * (within.back - within.front);
    if (is_jittered) {
        depth = within.front + noise_hash(id.x, id.y, record.slab, frame.seed).unit * record.thickness;
    }
    let here = meant(material, pattern_at(material, place_of(material, id, depth)));
    let alpha = shade_opacity(here.opacity, material.length, within.path);
    let through = vec3<f32>(
        shade_transmittance(here.opacity, here.transport.x, material.length, within.path),
        shade_transmittance(here.opacity, here.transport.y, material.length, within.path),
        shade_transmittance(here.opacity, here.transport.z, material.length, within.path),
    );
    return Matter(alpha > 0.0, alpha, through, here.colour, within.object);
}
