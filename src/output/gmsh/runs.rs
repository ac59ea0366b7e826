//! The boundary as runs of edges of one name.

use crate::mesh::HighOrderMesh;
use crate::numerics::NONE;
use std::collections::BTreeMap;

/// Consecutive boundary edges of one name along a loop.
pub struct Run {
    /// The name's number; `NONE` for edges without one.
    pub boundary: u32,
    /// In the loop's direction, the domain to their left.
    pub edges: Vec<u32>,
    /// First and last vertex; `None` where the run is the whole loop.
    pub ends: Option<[u32; 2]>,
}

/// All runs, loop by loop in the order of the loops' first edges.
pub fn boundary_runs(mesh: &HighOrderMesh) -> Vec<Run> {
    let border = || (0u32..).zip(&mesh.edges).filter(|(_, e)| e.elements[1] == NONE);
    let next: BTreeMap<u32, u32> = border().map(|(k, e)| (e.vertices[0], k)).collect();
    let mut waiting: Vec<bool> = mesh.edges.iter().map(|e| e.elements[1] == NONE).collect();
    let mut runs = Vec::new();
    for (first, _) in border() {
        let mut around = Vec::new();
        let mut at = Some(first);
        while let Some(e) = at.filter(|e| std::mem::replace(&mut waiting[*e as usize], false)) {
            around.push(e);
            at = next.get(&mesh.edges[e as usize].vertices[1]).copied();
        }
        let name = |e: u32| mesh.edges[e as usize].boundary;
        let changes = |k: usize| name(around[k]) != name(around[(k + around.len() - 1) % around.len()]);
        // Starting where the name changes keeps runs whole.
        match (0..around.len()).find(|k| changes(*k)) {
            Some(start) => around.rotate_left(start),
            None if around.is_empty() => continue,
            None => {
                runs.push(Run { boundary: name(around[0]), edges: around, ends: None });
                continue;
            }
        }
        for edges in around.chunk_by(|a, b| name(*a) == name(*b)) {
            let ends = [
                mesh.edges[edges[0] as usize].vertices[0],
                mesh.edges[edges[edges.len() - 1] as usize].vertices[1],
            ];
            runs.push(Run { boundary: name(edges[0]), edges: edges.to_vec(), ends: Some(ends) });
        }
    }
    runs
}
