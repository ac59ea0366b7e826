//! The invariants of a [`Triangulation`].

use super::Triangulation;
use crate::domain::Place;
use crate::numerics::{Point, NONE};

impl Triangulation {
    /// Checks that every triangle is positively oriented (by an exact predicate), neighbours are
    /// mutual, the border is the loops, border vertices alone have a place on the boundary, and
    /// Euler's number is 1 − holes. `Err`: the defect in words and where it is.
    pub fn check(&self) -> Result<(), (String, Point)> {
        let n = self.vertices.len();
        let start = self.vertices.first().map_or(Point::origin(), |v| v.point);
        if self.triangles.is_empty() || self.neighbors.len() != self.triangles.len() {
            return Err(("no triangles, or not as many neighbours".into(), start));
        }
        if self.triangles.iter().flatten().chain(self.loops.iter().flatten()).any(|&v| v as usize >= n) {
            return Err(("a vertex number is out of range".into(), start));
        }
        let mut successor = vec![NONE; n];
        let mut border = 0;
        for own in &self.loops {
            for (i, &v) in own.iter().enumerate() {
                let at = self.vertices[v as usize].point;
                if successor[v as usize] != NONE {
                    return Err((format!("border vertex {v} occurs twice"), at));
                }
                successor[v as usize] = own[(i + 1) % own.len()];
                border += 1;
            }
        }
        let mut found = 0;
        let mut inner_halves = 0;
        for (t, corners) in self.triangles.iter().enumerate() {
            let [a, b, c] = corners.map(|v| self.vertices[v as usize].point);
            let coord = |p: Point| robust::Coord { x: p.x, y: p.y };
            if robust::orient2d(coord(a), coord(b), coord(c)) <= 0.0 {
                return Err((format!("triangle {t} is not counter-clockwise"), a));
            }
            for i in 0..3 {
                let (from, to) = (corners[i], corners[(i + 1) % 3]);
                let at = self.vertices[from as usize].point;
                let other = self.neighbors[t][i];
                if other == NONE {
                    found += 1;
                    if successor[from as usize] != to {
                        return Err((format!("border edge {from}-{to} is not in the loops"), at));
                    }
                    continue;
                }
                inner_halves += 1;
                let mutual = self.triangles.get(other as usize).is_some_and(|o| {
                    (0..3).any(|j| {
                        o[j] == to && o[(j + 1) % 3] == from && self.neighbors[other as usize][j] == t as u32
                    })
                });
                if !mutual {
                    return Err((format!("triangles {t} and {other} are not mutual neighbours"), at));
                }
            }
        }
        if found != border {
            return Err((format!("{found} border edges for {border} in the loops"), start));
        }
        let mut used = vec![false; n];
        self.triangles.iter().flatten().for_each(|&v| used[v as usize] = true);
        for (v, vertex) in self.vertices.iter().enumerate() {
            if !used[v] {
                return Err((format!("vertex {v} is in no triangle"), vertex.point));
            }
            if (successor[v] == NONE) != (vertex.place == Place::Interior) {
                return Err((format!("vertex {v} has the wrong place"), vertex.point));
            }
        }
        let euler = n as i64 - (border + inner_halves / 2) as i64 + self.triangles.len() as i64;
        if euler != 2 - self.loops.len() as i64 {
            return Err((format!("Euler number {euler} with {} loops", self.loops.len()), start));
        }
        Ok(())
    }
}
