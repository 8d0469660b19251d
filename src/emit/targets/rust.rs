//! Rust modules: functions, and what a host needs around them.

use super::{Definition, SiblingFile};
use crate::emit::host::{self, Host};
use crate::prove::Proved;

pub(super) static PLAIN: Definition = Definition {
    name: "rust",
    extension: "rs",
    default: true,
    constant: None,
    write: |plans, siblings| Ok(write(plans, Host::Plain, siblings)),
};

pub(super) static BYTEMUCK: Definition = Definition {
    name: "rust_bytemuck",
    extension: "bytemuck.rs",
    default: false,
    constant: None,
    write: |plans, siblings| Ok(write(plans, Host::Bytemuck, siblings)),
};

pub(super) static WGPU: Definition = Definition {
    name: "rust_wgpu",
    extension: "wgpu.rs",
    default: false,
    constant: None,
    write: |plans, siblings| Ok(write(plans, Host::Wgpu, siblings)),
};

fn write(plans: &[Proved<'_>], host: Host, siblings: &[SiblingFile]) -> Vec<u8> {
    let embedded: Vec<String> = siblings.iter().filter_map(SiblingFile::constant).collect();
    host::modules(plans, host, &embedded).into_bytes()
}
