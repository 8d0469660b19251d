// SMSR: what stands around the table `smsr`.

// A shadowed texel stays as it is.
const LIT_ONLY: bool = true;
const ISOLATED_SIDES: bool = false;
const NEEDS_NEIGHBOURS: bool = false;
const ISOLATED_ENDS: bool = false;

fn revectorise(at: Centre) -> Sample {
    let e = look(at);
    let plain = Sample(f32(e.c.lit), NO_TABLE, NO_TABLE);
    if (e.H == NONE && e.V == NONE) {
        return plain;
    }
    let found = runs(e, at.place);
    if (found.horizontal.endless || found.vertical.endless) {
        return plain;
    }
    let dom = dominance(e);
    let key = table_key(e.H, e.V, 0u, found.horizontal.kind, found.vertical.kind, dom.x, dom.y);
    let result = smsr_key_case(key, found.horizontal.position, found.vertical.position, at.place.x, at.place.y);
    return Sample(result.value, result.case_id, key);
}
