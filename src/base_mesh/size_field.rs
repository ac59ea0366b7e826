//! The wanted length of base edges at a point.

use super::Request;
use crate::numerics::Point;

/// Growth of the wanted length with the distance from a place: what triangles of 26° can follow.
const GROWTH: f64 = 0.35;
/// The full wish holds within so many edges of the place.
const CORE: f64 = 2.0;

/// A usual length, and places that want less around them; found by a grid.
pub(super) struct SizeField<'a> {
    usual: f64,
    places: &'a [(Point, f64)],
    /// Wider than any place's influence.
    cell: f64,
    /// (cell, place), sorted.
    cells: Vec<([i64; 2], u32)>,
}

impl<'a> SizeField<'a> {
    pub fn new(request: &'a Request, usual: f64) -> Self {
        // At this distance the smallest wish has grown to the usual length.
        let cell = CORE * usual + usual / GROWTH;
        let mut field = SizeField { usual, places: &request.refine, cell, cells: Vec::new() };
        field.cells = (0u32..).zip(&request.refine).map(|(i, (p, _))| (field.cell_of(*p), i)).collect();
        field.cells.sort_unstable();
        // Places where others ask for as much: later rounds ask for less at about the same places.
        let needed = |i: u32| {
            let (p, h) = field.places[i as usize];
            !field.near(p).any(|k| {
                let (q, g) = field.places[k as usize];
                (g < h || (g == h && k < i)) && wish((q, g), p) <= h
            })
        };
        field.cells = field.cells.iter().copied().filter(|&(_, i)| needed(i)).collect();
        field
    }

    fn cell_of(&self, p: Point) -> [i64; 2] {
        [p.x, p.y].map(|x| (x / self.cell).floor() as i64)
    }

    /// Whether any place wants less than the usual length.
    pub fn is_uniform(&self) -> bool {
        self.places.is_empty()
    }

    /// The usual length.
    pub fn usual(&self) -> f64 {
        self.usual
    }

    /// The wanted length at `p`: the least that a place asks for there.
    pub fn at(&self, p: Point) -> f64 {
        self.near(p).fold(self.usual, |least, i| least.min(wish(self.places[i as usize], p)))
    }

    /// The places whose influence may reach `p`.
    fn near(&self, p: Point) -> impl Iterator<Item = u32> + '_ {
        let [x, y] = self.cell_of(p);
        (x - 1..=x + 1).flat_map(move |column| {
            let from = self.cells.partition_point(|&(c, _)| c < [column, y - 1]);
            let column_end = [column, y + 1];
            self.cells[from..].iter().take_while(move |&&(c, _)| c <= column_end).map(|&(_, i)| i)
        })
    }
}

/// What place `q` asks for at `p`.
fn wish((q, h): (Point, f64), p: Point) -> f64 {
    h + GROWTH * ((p - q).norm() - CORE * h).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grid_finds_what_a_full_search_finds() {
        let place = |i: u32| {
            let (x, y) = (f64::from(i * 7919 % 101) / 101.0, f64::from(i * 104_729 % 97) / 97.0);
            (Point::new(x - 0.5, y - 0.5), 0.001 + 0.0005 * f64::from(i % 40))
        };
        let request = Request { size: None, refine: (0..300).map(place).collect() };
        let field = SizeField::new(&request, 0.03);
        for i in 0..1000 {
            let p = Point::new(f64::from(i % 37) / 37.0 - 0.5, f64::from(i % 41) / 41.0 - 0.5);
            let full = request.refine.iter().fold(0.03, |least: f64, &place| least.min(wish(place, p)));
            // What the left-out places ask for, others ask for but for their core.
            assert!(full <= field.at(p) && field.at(p) < 1.5 * full, "{full} {}", field.at(p));
        }
    }
}
