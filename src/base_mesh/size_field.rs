//! The wanted length of base edges at a point.

use super::place_tree::PlaceTree;
use super::Request;
use crate::numerics::Point;

/// A usual length, and places that want less around them.
pub(super) struct SizeField {
    usual: f64,
    uniform: bool,
    places: PlaceTree,
}

impl SizeField {
    pub fn new(request: &Request, usual: f64) -> Self {
        let numbered = || (0u32..).zip(&request.refine).map(|(i, (p, h))| (*p, *h, i));
        // Places where others ask for as much are left out: later rounds ask for less at about the same places.
        let all = PlaceTree::new(numbered());
        let needed = |(p, h, i): &(Point, f64, u32)| !all.covered(*p, *h, *i);
        SizeField {
            usual,
            uniform: request.refine.is_empty(),
            places: PlaceTree::new(numbered().filter(needed)),
        }
    }

    /// Whether no place wants less than the usual length.
    pub fn is_uniform(&self) -> bool {
        self.uniform
    }

    /// The usual length.
    pub fn usual(&self) -> f64 {
        self.usual
    }

    /// The wanted length at `p`: the least that a place asks for there.
    pub fn at(&self, p: Point) -> f64 {
        self.places.least(p, self.usual)
    }
}

#[cfg(test)]
mod tests {
    use super::super::place_tree::grown;
    use super::*;

    #[test]
    fn tree_finds_what_a_full_search_finds() {
        let place = |i: u32| {
            let (x, y) = (f64::from(i * 7919 % 101) / 101.0, f64::from(i * 104_729 % 97) / 97.0);
            (Point::new(x - 0.5, y - 0.5), 0.001 + 0.0005 * f64::from(i % 40))
        };
        let request = Request { size: None, refine: (0..300).map(place).collect() };
        let field = SizeField::new(&request, 0.03);
        for i in 0..1000 {
            let p = Point::new(f64::from(i % 37) / 37.0 - 0.5, f64::from(i % 41) / 41.0 - 0.5);
            let full =
                request.refine.iter().fold(0.03, |least: f64, &(q, h)| least.min(grown(h, (p - q).norm())));
            // What the left-out places ask for, others ask for but for their core.
            assert!(full <= field.at(p) && field.at(p) < 1.5 * full, "{full} {}", field.at(p));
        }
    }
}
