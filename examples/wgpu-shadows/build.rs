//! Compiles the tables when the program is built: five plans of each into WGSL, one of them also so that it counts,
//! and into Rust what their cases are called; and takes the skeletons around them.

use umbrage::emit::Target;
use umbrage::plan::Shape;

fn main() -> Result<(), umbrage::build::Errors> {
    let tables = umbrage::build::Tables::new("../../tables/rsmss.ron")
        .also("../../tables/smsr.ron")
        .wgsl()
        .target(Target::WgslCounting)
        .rust()
        .plan(Shape::Ladder)
        .plan(Shape::Ordered)
        .plan(Shape::Gathered)
        .plan(Shape::Switch)
        .plan(Shape::Tree);
    ["hard", "pcf", "smsr", "rsmss", "rpcf"]
        .into_iter()
        .fold(tables, |tables, name| tables.skeleton(name))
        .compile()?;
    Ok(())
}
