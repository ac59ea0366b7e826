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
        if let (Ok(dump), Some(m)) = (std::env::var("DUMP"), &stages.quad_mesh) {
            let mut out = String::new();
            let b = stages.boundary.as_ref().unwrap();
            let o = smooth::Optimiser::new(b, 5, None);
            let q = o.quality(m);
            for (i, quad) in m.quads.iter().enumerate() {
                out += &format!("{}", q.elements[i].jacobian_ratio);
                for k in 0..4 {
                    let e = m.quad_edges[i][k] as usize;
                    let edge = &m.edges[e];
                    let mut pts = vec![];
                    for j in 0..=8 {
                        let t = j as f64 / 8.0;
                        let p = match edge.span {
                            Some(s) => b.chains[s.chain as usize].point(s.start + (s.end - s.start) * t),
                            None => {
                                let [x, y] = edge.vertices.map(|v| m.vertices[v as usize].point);
                                let mut p = x + (y - x) * t;
                                let u = 2.0 * t - 1.0;
                                let leg = [1.0, u, 1.5 * u * u - 0.5, 2.5 * u * u * u - 1.5 * u];
                                for (c, l) in edge.bubbles.iter().zip(leg) {
                                    p += c * (4.0 * t * (1.0 - t) * l);
                                }
                                p
                            }
                        };
                        pts.push(p);
                    }
                    if edge.vertices[0] != quad[k] {
                        pts.reverse();
                    }
                    for p in pts {
                        out += &format!(" {} {}", p.x, p.y);
                    }
                }
                out += "\n";
            }
            std::fs::write(dump, out).unwrap();
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
