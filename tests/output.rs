//! Files: `.vtu` read back, pictures parsed, and writing whole or not at all.

#[path = "support/disc.rs"]
mod disc;
#[path = "support/grid.rs"]
mod grid;
#[path = "support/vtu.rs"]
mod vtu;

use grid::grid_mesh;
use quadrel::mesh::Quality;
use quadrel::numerics::{Point, NONE};
use quadrel::output::{self, svg, Format};
use std::path::{Path, PathBuf};

/// A polynomial map of degree 2 in each direction with a positive Jacobian on the grid.
fn bent(x: f64, y: f64) -> Point {
    Point::new(x + 0.1 * y * y - 0.02 * x * x * y, y + 0.07 * x * x + 0.03 * x * y * y)
}

fn skew(x: f64, y: f64) -> Point {
    Point::new(2.0 * x + 0.3 * y + 0.1 * x * y, y - 0.2 * x)
}

fn folder(name: &str) -> PathBuf {
    let dir = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&dir);
    std::fs::create_dir_all(&dir).unwrap();
    dir
}

/// VTK's order of the nodes of a Lagrange quadrilateral, as a list of (i, j): corners, then the
/// edges bottom, right, top, left, each with growing index, then the inside with i fastest.
fn vtk_order(n: usize) -> Vec<(usize, usize)> {
    let mut list = vec![(0, 0), (n, 0), (n, n), (0, n)];
    list.extend((1..n).map(|i| (i, 0)));
    list.extend((1..n).map(|j| (n, j)));
    list.extend((1..n).map(|i| (i, n)));
    list.extend((1..n).map(|j| (0, j)));
    list.extend((1..n).flat_map(|j| (1..n).map(move |i| (i, j))));
    list
}

#[test]
fn vtk_node_index_is_the_closed_form() {
    for n in 1..=12 {
        for (place, (i, j)) in vtk_order(n).into_iter().enumerate() {
            assert_eq!(output::vtu::lagrange_index(n, i, j), place, "order {n}, node ({i}, {j})");
        }
    }
}

#[test]
fn vtu_nodes_are_equispaced_shared_and_in_order() {
    for (order, map) in [(1, skew as fn(f64, f64) -> Point), (2, bent), (3, bent), (5, bent), (9, bent)] {
        let (mesh, corners) = grid_mesh(3, 2, order, map);
        let file = vtu::read(&Format::Vtu.render(&mesh).unwrap());
        let (faces, edges) = (mesh.elements.len(), mesh.edges.len());
        let inside = order - 1;
        assert_eq!(file.points.len(), mesh.vertices.len() + edges * inside + faces * inside * inside);
        assert_eq!(file.types, vec![70; faces]);
        let list = vtk_order(order);
        let mut used = vec![false; file.points.len()];
        for (e, corner) in corners.iter().enumerate() {
            let cell = &file.connectivity[e * list.len()..(e + 1) * list.len()];
            assert_eq!(file.offsets[e], ((e + 1) * list.len()) as i64);
            for (&index, &(i, j)) in cell.iter().zip(&list) {
                used[index as usize] = true;
                let share = |k: usize| k as f64 / order as f64;
                let (x, y) = corner.at(share(i), share(j));
                let (expected, found) = (map(x, y), file.points[index as usize]);
                assert!(
                    (found[0] - expected.x).hypot(found[1] - expected.y) < 1e-12 && found[2] == 0.0,
                    "order {order}, element {e}, node ({i}, {j}): {found:?} for {expected:?}"
                );
            }
            assert_eq!(cell[..4].iter().map(|v| *v as u32).collect::<Vec<_>>(), mesh.elements[e]);
        }
        assert!(used.into_iter().all(|u| u), "a point belongs to no element");
    }
}

#[test]
fn vtu_carries_quality_blocks_and_boundaries() {
    let (mut mesh, _) = grid_mesh(3, 2, 4, bent);
    mesh.boundary_names = vec!["south & east".into(), "Übriges".into()];
    let file = vtu::read(&Format::Vtu.render(&mesh).unwrap());
    assert_eq!(file.doubles("scaled_jacobian"), mesh.scaled_jacobian);
    assert_eq!(file.integers("block"), mesh.blocks.iter().map(|b| *b as i32).collect::<Vec<_>>());
    let ratios = file.doubles("jacobian_ratio");
    assert!(ratios.len() == 6 && ratios.iter().all(|r| 0.3 < *r && *r < 1.0), "{ratios:?}");
    // The same measure as everywhere: over the element, not at its nodes.
    let quality = Quality::new(mesh.order);
    let measured = mesh.nodes.chunks_exact(25).map(|nodes| quality.measure(nodes).jacobian_ratio);
    assert_eq!(ratios, measured.collect::<Vec<_>>());
    let sides = file.integers("boundary");
    let mut outer = 0;
    for (e, edges) in mesh.element_edges.iter().enumerate() {
        for (s, edge) in edges.iter().enumerate() {
            let expected = match mesh.edges[*edge as usize].boundary {
                NONE => -1,
                name => name as i32,
            };
            assert_eq!(sides[4 * e + s], expected);
            let name = mesh.boundary_names.get(expected as usize).map_or("", String::as_str);
            assert_eq!(file.boundary_names[4 * e + s], name);
            outer += i32::from(expected >= 0);
        }
    }
    assert_eq!(outer, 10, "the grid has 10 outer sides");
}

#[test]
fn vtu_arrays_longer_than_a_block_are_whole() {
    let (mesh, _) = grid_mesh(40, 30, 5, bent);
    let file = vtu::read(&Format::Vtu.render(&mesh).unwrap());
    assert!(file.points.len() * 24 > 2 * (1 << 18));
    let last = file.points.last().unwrap();
    assert!(last.iter().all(|c| c.is_finite()));
    assert_eq!(file.connectivity.len(), 1200 * 36);
}

#[test]
fn bytes_depend_on_the_mesh_alone() {
    let (mesh, _) = grid_mesh(4, 3, 5, bent);
    for format in Format::ALL {
        assert_eq!(format.render(&mesh), format.render(&mesh.clone()), "{}", format.name());
    }
}

#[test]
fn formats_are_known_by_name_and_extension() {
    for format in Format::ALL {
        assert_eq!(Format::from_name(format.name()), Ok(format));
        let path = format!("some.dir/mesh.{}", format.name().to_uppercase());
        assert_eq!(Format::from_path(Path::new(&path)), Ok(format));
    }
    assert_eq!(Format::from_path(Path::new("a.mesh")), Ok(Format::IsmV2));
    for wrong in ["mesh.stl", "mesh", "vtu"] {
        let error = Format::from_path(Path::new(wrong)).unwrap_err();
        assert_eq!(error.name(), "unsupported");
        assert!(error.to_string().contains("vtu") && error.to_string().contains("svg"), "{error}");
    }
}

#[test]
fn files_are_written_all_or_none() {
    let dir = folder("files");
    let (first, missing) = (dir.join("a.vtu"), dir.join("no/such/folder/b.vtu"));
    std::fs::write(&first, "before").unwrap();
    let error =
        output::write_files(&[(first.clone(), b"new".to_vec()), (missing.clone(), vec![])]).unwrap_err();
    assert!(error.name() == "io" && error.to_string().contains("no/such/folder"), "{error}");
    assert_eq!(std::fs::read(&first).unwrap(), b"before");
    assert_eq!(std::fs::read_dir(&dir).unwrap().count(), 1, "a temporary file was left");

    output::write_files(&[(first.clone(), b"new".to_vec()), (dir.join("c.svg"), b"c".to_vec())]).unwrap();
    assert_eq!(std::fs::read(&first).unwrap(), b"new");
    assert_eq!(std::fs::read_dir(&dir).unwrap().count(), 2);
    assert!(output::write_files(&[(dir.clone(), vec![])]).is_err(), "a folder was taken for a file");
}

#[cfg(unix)]
#[test]
fn a_link_keeps_being_a_link() {
    let dir = folder("link");
    let (target, link) = (dir.join("target.vtu"), dir.join("link.vtu"));
    std::fs::write(&target, "before").unwrap();
    std::os::unix::fs::symlink(&target, &link).unwrap();
    output::write_files(&[(link.clone(), b"new".to_vec())]).unwrap();
    assert!(std::fs::symlink_metadata(&link).unwrap().is_symlink());
    assert_eq!(std::fs::read(&target).unwrap(), b"new");
    output::write_files(&[("/dev/null".into(), b"gone".to_vec())]).unwrap();
    assert!(!std::fs::metadata("/dev/null").unwrap().is_file());
}

/// Number of SVG elements of that name, after checking that the text is XML.
fn count(svg: &str, name: &str) -> usize {
    let document = roxmltree::Document::parse(svg).unwrap();
    document.descendants().filter(|n| n.has_tag_name(name)).count()
}

#[test]
fn mesh_picture_shows_elements_and_irregular_vertices() {
    let (mesh, _) = grid_mesh(3, 2, 5, bent);
    let picture = svg::mesh(&mesh);
    // Six elements, interior edges, boundary edges.
    assert_eq!(count(&picture, "path"), 6 + 2);
    assert_eq!(count(&picture, "polygon"), 0, "a regular grid has no irregular vertex");
    let square = |e: usize, a: f64, b: f64| Point::new(a + f64::from(e == 1), b + f64::from(e == 2));
    let points = [[0, 0], [1, 0], [2, 0], [0, 1], [1, 1], [2, 1], [0, 2], [1, 2]];
    let points = points.map(|p| Point::new(f64::from(p[0]), f64::from(p[1])));
    let elements = vec![[0, 1, 4, 3], [1, 2, 5, 4], [3, 4, 7, 6]];
    let shape = grid::assemble(2, points.to_vec(), elements, |_, _| 0, square);
    assert_eq!(count(&svg::mesh(&shape), "polygon"), 0, "three elements are right at a corner of 270°");
    // Cut into a single element, a corner has one element where two belong.
    let dart = [[0.0, 0.0], [2.0, 0.1], [1.1, 1.1], [0.1, 2.0]].map(Point::from);
    let flat = move |_: usize, a: f64, b: f64| {
        let mix = |c: usize| {
            (1.0 - a) * (1.0 - b) * dart[0][c]
                + a * (1.0 - b) * dart[1][c]
                + a * b * dart[2][c]
                + (1.0 - a) * b * dart[3][c]
        };
        Point::new(mix(0), mix(1))
    };
    let shape = grid::assemble(2, dart.to_vec(), vec![[0, 1, 2, 3]], |_, _| 0, flat);
    assert_eq!(count(&svg::mesh(&shape), "polygon"), 1, "one element at a corner of 174°");
    let disc = disc::mesh(5);
    let picture = svg::mesh(&disc);
    assert_eq!(count(&picture, "polygon"), 4, "the disc's four three-valent vertices");
    assert!(picture.contains("5 elements of order 5"));
}

/// The points of a path of one absolute move and relative lines.
fn corners(data: &str) -> Vec<(f64, f64)> {
    let numbers = |step: &str| -> Vec<f64> {
        step.replace('-', " -").split_whitespace().map(|x| x.parse().unwrap()).collect()
    };
    let mut at = (0.0, 0.0);
    let steps = data.trim_start_matches('M').trim_end_matches('Z').split('l');
    steps
        .map(|step| {
            let d = numbers(step);
            at = (at.0 + d[0], at.1 + d[1]);
            at
        })
        .collect()
}

#[test]
fn y_points_up() {
    // A triangle-like grid that is wider at its upper end.
    let (mesh, _) = grid_mesh(1, 1, 1, |x, y| Point::new((x - 0.5) * (0.2 + y), y));
    let picture = svg::mesh(&mesh);
    let document = roxmltree::Document::parse(&picture).unwrap();
    let path = document.descendants().find(|n| n.has_tag_name("path")).unwrap();
    let points = corners(path.attribute("d").unwrap());
    let (bottom, top) = (&points[0..2], &points[2..4]);
    assert!(bottom[0].1 > top[0].1, "SVG's y grows downwards: {points:?}");
    assert!((top[0].0 - top[1].0).abs() > (bottom[0].0 - bottom[1].0).abs());
}

#[test]
fn every_stage_has_its_picture() {
    let stages = disc::stages();
    let draw = |p| svg::stage(&stages, p, None).unwrap_or_else(|| panic!("no picture of {p:?}"));
    for picture in svg::Picture::ALL {
        assert_eq!(count(&draw(picture), "text"), 1, "{picture:?} has its caption");
    }
    assert_eq!(count(&draw(svg::Picture::Singularities), "polygon"), 4);
    // Five regions, the inner arcs, the boundary.
    assert_eq!(count(&draw(svg::Picture::Regions), "path"), 5 + 2);
    assert_eq!(count(&draw(svg::Picture::Blocks), "path"), 5 + 2);
    let overview = svg::overview(&stages, Some(&disc::mesh(5)), None);
    assert_eq!(count(&overview, "g"), 6, "five stages and the mesh");
}

#[test]
fn pictures_stop_where_the_run_stopped() {
    let mut stages = disc::stages();
    stages.block_layout = None;
    stages.quad_layout = None;
    stages.separatrices.clear();
    let at = Point::new(0.5, 0.5);
    assert!(svg::stage(&stages, svg::Picture::Separatrices, None).is_none());
    assert!(svg::stage(&stages, svg::Picture::Blocks, None).is_none());
    let plain = svg::stage(&stages, svg::Picture::Triangles, None).unwrap();
    let circled = svg::stage(&stages, svg::Picture::Triangles, Some(at)).unwrap();
    assert_eq!(count(&circled, "circle"), count(&plain, "circle") + 1);
    let empty = svg::overview(&quadrel::stages::Stages::default(), None, None);
    assert_eq!(count(&empty, "svg"), 1);
}

#[test]
fn pictures_are_small() {
    let stages = disc::stages();
    let circle = svg::stage(&stages, svg::Picture::Boundary, None).unwrap();
    assert!(circle.len() < 4_000, "{} bytes for a circle", circle.len());
    let (mesh, _) = grid_mesh(10, 10, 5, bent);
    let picture = svg::mesh(&mesh);
    assert!(picture.len() < 100 * 700, "{} bytes for 100 elements", picture.len());
}
