use quadrel::*;
use std::path::Path;
fn main() {
    let args: Vec<String> = std::env::args().collect();
    for path in &args[1..] {
        let model = match input::read(Path::new(path), None) {
            Ok(m) => m,
            Err(e) => {
                println!("{path}: INPUT {e}");
                continue;
            }
        };
        let mut o = Options::default();
        if std::env::var("LAYOUT").is_ok() {
            o.progress = progress::Progress::new(|s, _| s != progress::Stage::Refine)
        }
        if path.contains("Gingerbread") {
            o.tolerance = options::Tolerance::Absolute(1e-2)
        }
        let mut stages = stages::Stages::default();
        let t = std::time::Instant::now();
        let r = generate(&model.domain, &o, &mut stages);
        println!(
            "{path}: tri {} sing {} sep {} regions {} fallback {} {:.2}s {:?}",
            stages.triangulation.as_ref().map_or(0, |t| t.triangles.len()),
            stages.singularities.len(),
            stages.separatrices.len(),
            stages.block_layout.as_ref().map_or(0, |t| t.regions.len()),
            stages.fallback,
            t.elapsed().as_secs_f64(),
            stages.seconds.map(|s| (s * 1e3) as u32)
        );
        for x in &stages.rounds {
            println!(
                "   {} {} sj {:.3} err {:.2}",
                x.action, x.elements, x.scaled_jacobian, x.boundary_error
            );
        }
        match r {
            Ok(m) => println!(
                "  OK elements {} minsj {:.3}",
                m.elements.len(),
                m.scaled_jacobian.iter().fold(1.0f64, |a, &b| a.min(b))
            ),
            Err(e) => println!("  ERR {e}"),
        }
    }
}
