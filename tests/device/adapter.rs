//! That there is an adapter at all. Without one the tests that run shaders
//! would prove nothing, so there is no way to skip this.

use crate::support::OrPanic as _;
use umbrage::gpu::{AdapterChoice, Gpu};

#[test]
fn an_adapter_can_be_used() {
    let gpu = Gpu::open(&AdapterChoice::Any).or_panic();
    println!("adapter: {}", gpu.describe());
}
