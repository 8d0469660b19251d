// SMSR: what stands around the table `smsr`.

// A shadowed texel stays as it is.
const LIT_ONLY: bool = true;
const ISOLATED_SIDES: bool = false;
const ISOLATED_ENDS: bool = false;

fn revectorise(at: Centre) -> Sample {
    let e = look(at);
    if (e.H == NONE && e.V == NONE) {
        return Sample(f32(e.c.lit), NO_TABLE, NO_TABLE);
    }
    var horizontal = no_run();
    var vertical = no_run();
    if (e.V != NONE) {
        horizontal = run(e.c, row(e), at.place.x);
    }
    if (e.H != NONE) {
        vertical = run(e.c, column(e), at.place.y);
    }
    if (horizontal.endless || vertical.endless) {
        return Sample(f32(e.c.lit), NO_TABLE, NO_TABLE);
    }
    let dom = dominance(e);
    let key = table_key(e.H, e.V, 0u, horizontal.kind, vertical.kind, dom.H, dom.V);
    let result = smsr_key_case(key, horizontal.position, vertical.position, at.place.x, at.place.y);
    return Sample(result.value, result.case_id, key);
}
