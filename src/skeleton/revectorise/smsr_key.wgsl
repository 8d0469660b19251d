// The search counts levels from zero; the table takes the codes that it gives them.
fn table_key(H: u32, V: u32, b: u32, tH: u32, tV: u32, domH: bool, domV: bool) -> u32 {
    return smsr_pack(0.25 * f32(H), 0.25 * f32(V), f32(tH) - 1.0, f32(tV) - 1.0, domH, domV);
}
