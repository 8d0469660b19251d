// For `convolve.wgsl` where no object has a pattern: noise is long, and drivers take their time for it.

fn detailed(material: Material, id: vec2<u32>, within: Parts, is_jittered: bool) -> Matter {
    return nothing();
}
