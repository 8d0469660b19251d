//! The decision function and the values it returns, in any language.

pub(crate) mod body;
mod levels;
pub(crate) mod lookup;
pub(crate) mod outline;
mod scope;
pub(crate) mod special;
pub(crate) mod terms;
pub(crate) mod values;
mod whole;
