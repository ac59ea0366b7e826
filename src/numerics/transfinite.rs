//! The transfinite map of a quadrilateral with four curved sides.
//!
//! Reference: W. J. Gordon, C. A. Hall, *Transfinite element methods*, Numer. Math. 21 (1973);
//! S. A. Coons, *Surfaces for computer-aided design of space forms*, 1967.

use super::Point;

/// Nodes of an element from its four sides by the bilinearly blended Coons map.
///
/// `reference` are the N + 1 nodes in [-1, 1] (symmetric), `sides[s]` the N + 1 points of side s
/// from corner s to corner s + 1, counter-clockwise; consecutive sides share their corner. `out` is
/// replaced by the (N + 1)² points `[j][i]`, i along side 0; those on a side are copies of the side's.
pub fn coons_map(reference: &[f64], sides: [&[Point]; 4], out: &mut Vec<Point>) {
    let n = reference.len() - 1;
    out.clear();
    out.reserve((n + 1) * (n + 1));
    let [c0, c1, c2, c3] = [0, 1, 2, 3].map(|s| sides[s][0].coords);
    for j in 0..=n {
        let eta = 0.5 * (1.0 + reference[j]);
        let (left, right) = (sides[3][n - j], sides[1][j]);
        for i in 0..=n {
            let (bottom, top) = (sides[0][i], sides[2][n - i]);
            out.push(match (i, j) {
                (_, 0) => bottom,
                (_, j) if j == n => top,
                (0, _) => left,
                (i, _) if i == n => right,
                _ => {
                    let xi = 0.5 * (1.0 + reference[i]);
                    let ruled = bottom.coords * (1.0 - eta)
                        + top.coords * eta
                        + left.coords * (1.0 - xi)
                        + right.coords * xi;
                    let bilinear =
                        (c0 * (1.0 - xi) + c1 * xi) * (1.0 - eta) + (c3 * (1.0 - xi) + c2 * xi) * eta;
                    Point::from(ruled - bilinear)
                }
            });
        }
    }
}
