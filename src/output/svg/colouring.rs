//! Fills for the regions of a layout such that neighbours differ.

use super::palette::FILLS;

/// A colour for each of `count` regions: greedily the first that no neighbour has, shifted
/// from region to region so that all colours get used. `pairs` are neighbours.
pub fn fills(count: usize, pairs: impl Iterator<Item = (usize, usize)>) -> Vec<&'static str> {
    let mut neighbours = vec![Vec::new(); count];
    for (a, b) in pairs.filter(|(a, b)| a != b && *a < count && *b < count) {
        neighbours[a].push(b);
        neighbours[b].push(a);
    }
    let mut chosen: Vec<Option<usize>> = vec![None; count];
    for region in 0..count {
        let taken = |c: usize| neighbours[region].iter().any(|n| chosen[*n] == Some(c));
        let first = region % FILLS.len();
        let free = (0..FILLS.len()).map(|k| (first + k) % FILLS.len()).find(|c| !taken(*c));
        // A region with eight neighbours of all colours has to share one.
        chosen[region] = Some(free.unwrap_or(first));
    }
    chosen.into_iter().flatten().map(|c| FILLS[c]).collect()
}
