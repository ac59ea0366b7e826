//! Text formats: what they hold agrees with the mesh; what they cannot hold is refused.

#[path = "support/grid.rs"]
mod grid;

use grid::grid_mesh;
use quadrel::mesh::HighOrderMesh;
use quadrel::numerics::{Point, NONE};
use quadrel::output::{gmsh, Format};
use std::collections::BTreeMap;

fn bent(x: f64, y: f64) -> Point {
    Point::new(x + 0.1 * y * y - 0.02 * x * x * y, y + 0.07 * x * x + 0.03 * x * y * y)
}

fn lines(mesh: &HighOrderMesh, format: Format) -> Vec<String> {
    let text = String::from_utf8(format.render(mesh).unwrap()).unwrap();
    text.lines().map(str::to_string).collect()
}

#[test]
fn orders_that_a_format_cannot_hold_are_refused() {
    for order in [1, 2, 10, 11, 16] {
        let (mesh, _) = grid_mesh(2, 1, order, bent);
        for format in Format::ALL {
            let possible = format != Format::Msh || order <= 10;
            assert_eq!(format.check_order(order).is_ok(), possible, "{format:?}, order {order}");
            match format.render(&mesh) {
                Ok(bytes) => assert!(possible && !bytes.is_empty()),
                Err(error) => {
                    assert!(!possible && error.name() == "unsupported", "{error}");
                    assert!(error.to_string().contains("1 to 10"), "{error}");
                }
            }
        }
    }
}

#[test]
fn gmsh_orders_take_every_node_once() {
    for n in 1..=10 {
        let mut list = gmsh::quadrilateral_order(n);
        assert_eq!(list[..4], [(0, 0), (n, 0), (n, n), (0, n)]);
        list.sort_unstable();
        let all: Vec<_> = (0..=n).flat_map(|i| (0..=n).map(move |j| (i, j))).collect();
        assert_eq!(list, all, "order {n}");
        let mut line = gmsh::line_order(n);
        assert_eq!(line[..2], [0, n]);
        line.sort_unstable();
        assert_eq!(line, (0..=n).collect::<Vec<_>>());
    }
}

#[test]
fn awkward_names_stay_different_words() {
    let (mut mesh, _) = grid_mesh(3, 2, 3, bent);
    mesh.boundary_names = vec!["two words".into(), "two_words".into()];
    for format in [Format::Ism, Format::IsmV2, Format::IsmMm, Format::Inp] {
        let text = String::from_utf8(format.render(&mesh).unwrap()).unwrap();
        let names: Vec<&str> = text.split_whitespace().filter(|w| w.starts_with("two_words")).collect();
        let first = names.iter().filter(|w| **w == "two_words").count();
        let second = names.iter().filter(|w| **w == "two_words_2").count();
        assert_eq!((first, second, names.len()), (5, 5, 10), "{format:?}");
    }
    for (awkward, word) in [("", "boundary_1"), ("---", "boundary_1"), (" a,b\tc ", "a_b_c")] {
        mesh.boundary_names[0] = awkward.into();
        let file = lines(&mesh, Format::Ism);
        assert_eq!(file.iter().flat_map(|l| l.split(' ')).filter(|w| *w == word).count(), 5, "{awkward:?}");
    }
    mesh.boundary_names = vec!["\"quoted\"\n".into(), "ä".repeat(100)];
    let file = lines(&mesh, Format::Msh);
    assert!(file.contains(&"1 1 \"'quoted'\"".into()));
    assert!(file.contains(&format!("1 2 \"{}\"", "ä".repeat(63))), "a name has at most 127 bytes");
}

/// The edge list of ISM-v2 agrees with the elements.
#[test]
fn ism_edges_name_their_sides() {
    let (mesh, _) = grid_mesh(4, 3, 2, bent);
    let file = lines(&mesh, Format::IsmV2);
    assert_eq!(file[..2], ["ISM-V2".to_string(), format!("{} {} 12 2", 5 * 4, 4 * 4 + 3 * 5)]);
    // A side's first and last corner, 1 from its corner 1 to 2, 2 from 2 to 3, 3 from 4 to 3, 4 from 1 to 4.
    let ends = |element: i64, side: i64| {
        let corners = mesh.elements[element as usize - 1].map(|v| i64::from(v) + 1);
        let [a, b] = [[0, 1], [1, 2], [3, 2], [0, 3]][side as usize - 1];
        [corners[a], corners[b]]
    };
    let mut sides = BTreeMap::new();
    for line in &file[22..22 + mesh.edges.len()] {
        let numbers: Vec<i64> = line.split(' ').map(|n| n.parse().unwrap()).collect();
        let [a, b, left, right, left_side, right_side] = numbers[..] else { panic!("{line}") };
        assert_eq!(ends(left, left_side), [a, b], "{line}");
        *sides.entry((left, left_side)).or_insert(0) += 1;
        if right == 0 {
            assert_eq!(right_side, 0, "{line}");
            continue;
        }
        let same = if right_side > 0 { [a, b] } else { [b, a] };
        assert_eq!(ends(right, right_side.abs()), same, "{line}");
        *sides.entry((right, right_side.abs())).or_insert(0) += 1;
    }
    assert!(sides.len() == 48 && sides.values().all(|n| *n == 1), "every side has one edge");
}

/// Sides that are straight have flag 0 and no points; both elements at a side agree.
#[test]
fn straight_sides_have_no_points() {
    let (skewed, _) = grid_mesh(3, 2, 4, |x, y| Point::new(1e3 + 2.0 * x + 0.3 * y, y - 0.2 * x));
    let flags = |mesh: &HighOrderMesh| -> Vec<u32> {
        let first = 1 + mesh.vertices.len();
        let (mut at, mut found) = (first, Vec::new());
        let file = lines(mesh, Format::Ism);
        for _ in &mesh.elements {
            let own: Vec<u32> = file[at + 1].split(' ').map(|f| f.parse().unwrap()).collect();
            at += 3 + own.iter().sum::<u32>() as usize * (mesh.order + 1);
            found.extend(own);
        }
        assert_eq!(at, file.len(), "nothing follows");
        found
    };
    assert!(flags(&skewed).iter().all(|f| *f == 0));
    let (wavy, _) = grid_mesh(3, 2, 4, |x, y| Point::new(x, y + 0.1 * x * x * y));
    let found = flags(&wavy);
    // The two bottom sides' line y = 0 and all lines x = const stay straight.
    assert_eq!(found.iter().sum::<u32>(), 6 + 3);
    for (e, sides) in wavy.element_edges.iter().enumerate() {
        for (s, edge) in sides.iter().enumerate() {
            let other = wavy.edges[*edge as usize].elements.into_iter().find(|o| *o != e as u32);
            let Some(other) = other.filter(|o| *o != NONE) else { continue };
            let side = wavy.element_edges[other as usize].iter().position(|x| x == edge).unwrap();
            assert_eq!(found[4 * e + s], found[4 * other as usize + side]);
        }
    }
}
