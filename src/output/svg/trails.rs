//! Edges of a triangulation or mesh as few long polylines, for short path data.

use crate::numerics::NONE;

/// Trails that together pass every one of `edges` once, as lists of vertices below `vertices`.
pub fn trails(vertices: usize, edges: &[[u32; 2]]) -> Vec<Vec<u32>> {
    // Edges at each vertex, in the order given.
    let mut first = vec![0; vertices + 1];
    for v in edges.iter().flatten() {
        first[*v as usize + 1] += 1;
    }
    for v in 0..vertices {
        first[v + 1] += first[v];
    }
    let mut next = first.clone();
    let mut at = vec![NONE; 2 * edges.len()];
    for (e, ends) in edges.iter().enumerate() {
        for v in ends {
            at[next[*v as usize]] = e as u32;
            next[*v as usize] += 1;
        }
    }
    // Walk along edges not yet passed until there is none; then from the next vertex that has one.
    let mut passed = vec![false; edges.len()];
    let mut seen = first[..vertices].to_vec();
    let mut found = Vec::new();
    for start in 0..vertices {
        loop {
            let mut trail = vec![start as u32];
            let mut v = start;
            while seen[v] < first[v + 1] {
                let e = at[seen[v]] as usize;
                seen[v] += 1;
                if !passed[e] {
                    passed[e] = true;
                    let [a, b] = edges[e];
                    v = (if a as usize == v { b } else { a }) as usize;
                    trail.push(v as u32);
                }
            }
            if trail.len() < 2 {
                break;
            }
            found.push(trail);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::trails;
    use std::collections::BTreeMap;

    #[test]
    fn every_edge_is_passed_once() {
        // A wheel: hub 0, rim 1 to 7.
        let mut edges: Vec<[u32; 2]> = (1..8).map(|k| [0, k]).collect();
        edges.extend((1..8).map(|k| [k % 7 + 1, k]));
        let found = trails(9, &edges);
        let mut count: BTreeMap<[u32; 2], usize> = BTreeMap::new();
        for step in found.iter().flat_map(|t| t.windows(2)) {
            *count.entry([step[0].min(step[1]), step[0].max(step[1])]).or_default() += 1;
        }
        assert_eq!(count.len(), edges.len());
        assert!(count.values().all(|c| *c == 1));
        // All eight vertices have odd degree: four trails at least.
        assert!(found.len() >= 4 && found.len() <= 7, "{} trails", found.len());
    }
}
