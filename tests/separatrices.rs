//! Step 4: the traces end where they say, and divide the domain into regions of four corners.

mod shapes;

use quadrel::base_mesh::Request;
use quadrel::domain::{Boundary, BoundaryPoint};
use quadrel::layout::t_mesh::{build, Traced};
use quadrel::layout::BlockLayout;
use quadrel::options::FieldMethod;
use quadrel::separatrices::{trace, Separatrix, TraceEnd};
use quadrel::singularities::{resolve, Resolved};
use shapes::all;

fn traced(b: &Boundary) -> (Resolved, Vec<Separatrix>, BlockLayout) {
    let r = resolve(b, Request::default(), FieldMethod::Diffused).unwrap();
    let mut seeds: Vec<BoundaryPoint> = Vec::new();
    loop {
        let traces = trace(&r.mesh, &r.field, b, &r.singularities, &r.corners, &seeds).unwrap();
        match build(b, &r.singularities, &r.corners, &traces).unwrap() {
            Traced::Layout(layout) => return (r, traces, layout),
            Traced::Seeds(more) => {
                assert!(seeds.len() < 20);
                seeds.extend(more);
            }
        }
    }
}

#[test]
fn every_shape_is_divided_into_regions() {
    for (name, b) in all() {
        let (r, traces, layout) = traced(&b);
        let tips = r.corners.iter().filter(|c| c.quads == 0).count();
        let triangles = layout.regions.iter().filter(|x| x.sides.len() == 3).count();
        let quads = layout.regions.iter().filter(|x| x.sides.len() == 4).count();
        assert_eq!(triangles, tips, "{name}");
        assert_eq!(triangles + quads, layout.regions.len(), "{name}");
        let launched: usize = r.singularities.iter().map(|s| s.valence as usize).sum::<usize>()
            + r.corners.iter().map(|c| (c.quads as usize).saturating_sub(1)).sum::<usize>();
        assert!(traces.len() >= launched, "{name}: {} of {launched}", traces.len());
    }
}

#[test]
fn traces_stop_where_their_hosts_say() {
    for (name, b) in all() {
        let (_, traces, _) = traced(&b);
        let mut stops = vec![0; traces.len()];
        for (i, host) in traces.iter().enumerate() {
            for stop in &host.stops {
                assert_eq!(traces[stop.stem as usize].to, TraceEnd::Separatrix { on: i as u32 }, "{name}");
                assert!((traces[stop.stem as usize].points.last().unwrap() - stop.point).norm() < 1e-12);
                stops[stop.stem as usize] += 1;
            }
        }
        for (trace, n) in traces.iter().zip(stops) {
            assert_eq!(matches!(trace.to, TraceEnd::Separatrix { .. }), n == 1, "{name}");
        }
    }
}
