//! Domains on which something once went wrong, by what it was.

use quadrel::stages::Stages;
use quadrel::{generate, input, Options};
use std::path::Path;
use std::time::{Duration, Instant};

/// Elements of the mesh of a domain of the collection, its least scaled Jacobian, and the time it took.
fn shaped(file: &str) -> (usize, f64, Duration) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/domains").join(file);
    let domain = input::read(&path, None).unwrap().domain;
    let start = Instant::now();
    let mesh = generate(&domain, &Options::default(), &mut Stages::default());
    let mesh = mesh.unwrap_or_else(|e| panic!("{file}: {e}"));
    let least = mesh.scaled_jacobian.iter().copied().fold(f64::INFINITY, f64::min);
    (mesh.elements.len(), least, start.elapsed())
}

/// Elements of the mesh of a domain of the collection, and the time it took.
fn mesh(file: &str) -> (usize, Duration) {
    let (elements, _, time) = shaped(file);
    (elements, time)
}

/// Elements that are few enough and none poor.
fn assert_shape(file: &str, least: f64, most: usize) {
    let (elements, scaled_jacobian, _) = shaped(file);
    assert!(scaled_jacobian > least, "{file}: scaled Jacobian {scaled_jacobian}");
    assert!(elements <= most, "{file}: {elements} elements");
}

/// Two windows of one closed chain took room from each other without end: one placed the whole chain from its
/// first vertex, the other from another.
#[test]
fn respacing_ends_on_a_short_closed_chain() {
    let (elements, time) = mesh("glyphs/NotoSerifDevanagari/u0919-2.svg");
    assert!(elements <= 20, "{elements} elements");
    assert!(time < Duration::from_secs(20), "{time:?}");
}

/// Thousands of layout quads of which hundreds are inverted: untangled with straight sides first, each tangled part
/// by itself.
#[test]
fn tangles_of_a_coast_come_undone() {
    let (elements, _) = mesh("coast/sea-aeolian.svg");
    assert!(elements <= 1400, "{elements} elements");
}

/// A five-valent singularity sat right before a tip to which the field gave no quad, and sent a separatrix into
/// it: a later attempt gives every tip its quad.
#[test]
fn a_singularity_before_a_sharp_tip_becomes_the_tip_s_quad() {
    let (elements, _) = mesh("icons/mdi/flag-variant-minus-outline-1.svg");
    assert!(elements <= 40, "{elements} elements");
}

/// Two corners a thousandth of the ring's width apart. The region that winds around the ring was cut near its end by
/// a curve between its two borders, half way to the far side of the hole.
#[test]
fn a_cut_of_a_ring_keeps_to_the_near_border() {
    let (elements, _) = mesh("icons/bootstrap/sign-turn-slight-right-1.svg");
    assert!(elements <= 400, "{elements} elements");
}

/// Junctions on the two sides of a stroke were joined by lines from one to another several widths away, which nothing
/// could straighten afterwards: a scaled Jacobian of 0.41.
#[test]
fn junctions_far_apart_on_two_sides_of_a_stroke_are_not_joined() {
    assert_shape("glyphs/NotoSansJavanese/ua98e.svg", 0.7, 40);
}

/// The same around a ring: the point across from a junction right behind the cut was found right before it, a whole
/// turn further, and the lines between the borders were wound around the hole (0.014; 0.3 with 150 elements on another
/// base mesh).
#[test]
fn lines_across_a_ring_are_not_wound_around_its_hole() {
    assert_shape("glyphs/AmiriQuran/u06e0.svg", 0.9, 16);
}

/// Two long blocks along a bend were smoothed into a fold that nothing undid (0.55): finer blocks are not.
#[test]
fn finer_blocks_are_tried_where_an_element_is_poor() {
    assert_shape("glyphs/NotoSansCJK/ubf54.svg", 0.8, 50);
}

/// A neck of three thousandths between two corners, in one line with the wall beside it: the edge across it joins two
/// junctions and had to stay straight, so that its element had a flat corner, whose rounding counted as valid.
#[test]
fn an_edge_across_a_neck_in_line_with_the_wall_bends() {
    let (elements, _) = mesh("glyphs/NotoSansCJK/u9b10.svg");
    assert!(elements <= 90, "{elements} elements");
}
