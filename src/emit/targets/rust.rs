//! Rust modules: functions, and what a host needs around them.

use super::Definition;
use crate::emit::host::{self, Host};

pub(super) static PLAIN: Definition = Definition {
    name: "rust",
    extension: "rs",
    default: true,
    constant: None,
    write: |plans, siblings| Ok(host::modules(plans, Host::Plain, siblings).into_bytes()),
};

pub(super) static BYTEMUCK: Definition = Definition {
    name: "rust_bytemuck",
    extension: "bytemuck.rs",
    default: false,
    constant: None,
    write: |plans, siblings| Ok(host::modules(plans, Host::Bytemuck, siblings).into_bytes()),
};

pub(super) static WGPU: Definition = Definition {
    name: "rust_wgpu",
    extension: "wgpu.rs",
    default: false,
    constant: None,
    write: |plans, siblings| Ok(host::modules(plans, Host::Wgpu, siblings).into_bytes()),
};
