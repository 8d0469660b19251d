// Counts which line of the table gives each result. The table calls this once for each of them.
// The counters are those of light.wgsl, which counts cases only while it shows them.

fn TABLE_hit(number: u32) {
    atomicAdd(&counts[number], 1u);
}
