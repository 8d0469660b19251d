//! Documents, examples and build scripts do what they say.
#![allow(clippy::unwrap_used)]

mod build_script;
mod documents;
mod editors;
mod examples;
