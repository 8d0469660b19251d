//! Compiles `tables/terrain.ron` into a Rust module, and into WGSL for whoever draws this map on a GPU.

fn main() -> Result<(), umbrage::build::Errors> {
    umbrage::build::Tables::new("tables").wgsl().rust().compile()?;
    Ok(())
}
