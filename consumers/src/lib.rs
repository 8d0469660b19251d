//! Nothing: this package exists for its tests, which hand generated files to
//! the tools and crates that they are made for.
