//! Meshes the unit disc, its boundary given as a function, and writes disc.vtu for ParaView.
//!
//! `cargo run --release --example disc`

use quadrel::domain::{Domain, LoopKind};
use quadrel::stages::Stages;
use quadrel::{generate, output, Options};
use std::f64::consts::TAU;
use std::path::Path;

fn main() -> quadrel::Result<()> {
    // The curve's point at t in 0..=1, in one closed segment; a second closure could give d/dt.
    let circle = |t: f64| Ok([(TAU * t).cos(), (TAU * t).sin()]);
    let mut builder = Domain::builder();
    builder.begin_loop(LoopKind::Outer, "wall")?;
    builder.add_callback(Box::new(circle), None, "")?;
    builder.end_loop()?;
    let disc = builder.build()?;

    let mesh = generate(&disc, &Options::default(), &mut Stages::default())?;

    let worst = mesh.scaled_jacobian.iter().copied().fold(1.0, f64::min);
    println!("{} elements of order {}, {} vertices", mesh.elements.len(), mesh.order, mesh.vertices.len());
    println!("least scaled Jacobian {worst:.3}");
    output::write(&mesh, output::Format::Vtu, Path::new("disc.vtu"))
}
