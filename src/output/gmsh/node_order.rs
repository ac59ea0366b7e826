//! Gmsh's order of the nodes of an element.

/// The nodes of a line, counted along it from 0 to `order`: its ends, then the inner ones.
pub fn line_order(order: usize) -> Vec<usize> {
    [0, order].into_iter().chain(1..order).collect()
}

/// The nodes (i, j) of a quadrilateral, each from 0 to `order`: the corners counter-clockwise, the
/// inner nodes of the four sides, all walking round, and then the inside as a quadrilateral of order − 2.
pub fn quadrilateral_order(order: usize) -> Vec<(usize, usize)> {
    let mut list = Vec::with_capacity((order + 1) * (order + 1));
    let (mut low, mut high) = (0, order);
    while low < high {
        list.extend([(low, low), (high, low), (high, high), (low, high)]);
        list.extend((low + 1..high).map(|i| (i, low)));
        list.extend((low + 1..high).map(|j| (high, j)));
        list.extend((low + 1..high).rev().map(|i| (i, high)));
        list.extend((low + 1..high).rev().map(|j| (low, j)));
        (low, high) = (low + 1, high - 1);
    }
    if low == high {
        list.push((low, low));
    }
    list
}
