//! VTK's order of the nodes of a cell.

/// The place of node (i, j), each in 0..=`order`, in VTK's list of the nodes of a Lagrange
/// quadrilateral: corners, then edges bottom, right, top, left (all with growing i or j), then the
/// inside with i fastest.
pub fn lagrange_index(order: usize, i: usize, j: usize) -> usize {
    let n = order;
    let inside = n.saturating_sub(1);
    match (i == 0 || i == n, j == 0 || j == n) {
        (true, true) => match (i > 0, j > 0) {
            (false, false) => 0,
            (true, false) => 1,
            (true, true) => 2,
            (false, true) => 3,
        },
        (false, true) => 4 + (i - 1) + if j > 0 { 2 * inside } else { 0 },
        (true, false) => 4 + (j - 1) + if i > 0 { inside } else { 3 * inside },
        (false, false) => 4 + 4 * inside + (i - 1) + inside * (j - 1),
    }
}

/// The numbers of a cell's nodes, `[j][i]`, in VTK's order.
pub fn in_lagrange_order(order: usize, numbers: &[u32]) -> Vec<u32> {
    let row = order + 1;
    let mut cell = vec![0; numbers.len()];
    for (k, &number) in numbers.iter().enumerate() {
        cell[lagrange_index(order, k % row, k / row)] = number;
    }
    cell
}
