//! Where the wanted element size is looked at: the base mesh's vertices, and points between them where the
//! caller's size function is finer or changes faster than they can tell.

use super::Triangulation;
use crate::error::Result;
use crate::numerics::Point;
use std::collections::{HashMap, VecDeque};

/// Longest edge between samples in the function's own sizes, even where it seems constant: a dip narrower
/// than that is nobody's wish for elements.
const COARSE: f64 = 4.0;
/// The same where the function changes, and the ratio of its values that counts as a change.
const FINE: f64 = 0.7;
const CHANGE: f64 = 1.2;
/// Most samples; detail beyond them is left out evenly.
const MOST_SAMPLES: usize = 60_000;

/// The samples: a graph of points with the size asked for at each.
pub(super) struct SizeSamples {
    /// The first ones are the base mesh's vertices.
    pub points: Vec<Point>,
    /// What the caller asks for there; infinite if nothing.
    pub asked: Vec<f64>,
    /// The two samples that each later one lies between.
    pub between: Vec<[u32; 2]>,
    /// Triangles without gaps or overlaps, though not conforming.
    pub triangles: Vec<[u32; 3]>,
}

impl SizeSamples {
    /// Samples `ask` over `mesh`; triangles are divided into four until they resolve it. `places`: points that
    /// must be resolved.
    pub fn new(
        mesh: &Triangulation,
        places: &[Point],
        ask: &mut dyn FnMut(Point) -> Result<f64>,
    ) -> Result<Self> {
        let points: Vec<Point> = mesh.vertices.iter().map(|v| v.point).collect();
        let asked = points.iter().map(|p| ask(*p)).collect::<Result<Vec<f64>>>()?;
        let mut samples = SizeSamples { points, asked, between: Vec::new(), triangles: Vec::new() };
        let mut queue: VecDeque<_> =
            mesh.triangles.iter().map(|t| (*t, Vec::<(Point, f64)>::new())).collect();
        for place in places {
            // One outside of the domain is of no use to sampling, nor is it to be called for.
            if let Some((_, list)) = queue.iter_mut().find(|(t, _)| samples.inside(*t, *place)) {
                list.push((*place, ask(*place)?));
            }
        }
        let mut middles: HashMap<[u32; 2], u32> = HashMap::new();
        while let Some((t, places)) = queue.pop_front() {
            if !samples.resolved(t, &places, ask)? && samples.points.len() < MOST_SAMPLES {
                let mut middle = |a: u32, b: u32| -> Result<u32> {
                    let key = [a.min(b), a.max(b)];
                    if let Some(m) = middles.get(&key) {
                        return Ok(*m);
                    }
                    let m = samples.insert_between(key, ask)?;
                    middles.insert(key, m);
                    Ok(m)
                };
                let [a, b, c] = t;
                let [ab, bc, ca] = [middle(a, b)?, middle(b, c)?, middle(c, a)?];
                for part in [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]] {
                    let own = places.iter().copied().filter(|(p, _)| samples.inside(part, *p)).collect();
                    queue.push_back((part, own));
                }
                continue;
            }
            samples.triangles.push(t);
        }
        Ok(samples)
    }

    fn insert_between(&mut self, ends: [u32; 2], ask: &mut dyn FnMut(Point) -> Result<f64>) -> Result<u32> {
        let [a, b] = ends.map(|v| self.points[v as usize]);
        let point = nalgebra::center(&a, &b);
        self.asked.push(ask(point)?);
        self.points.push(point);
        self.between.push(ends);
        Ok(self.points.len() as u32 - 1)
    }

    /// Whether the corners of `t` tell what is asked for inside.
    fn resolved(
        &self,
        t: [u32; 3],
        places: &[(Point, f64)],
        ask: &mut dyn FnMut(Point) -> Result<f64>,
    ) -> Result<bool> {
        let [a, b, c] = t.map(|v| self.points[v as usize]);
        let longest = (b - a).norm().max((c - b).norm()).max((a - c).norm());
        let center = ask(Point::from((a.coords + b.coords + c.coords) / 3.0))?;
        let values = t.iter().map(|v| self.asked[*v as usize]);
        let (least, most) = values
            .chain([center])
            .chain(places.iter().map(|p| p.1))
            .fold((f64::INFINITY, 0.0f64), |(least, most), x| (least.min(x), most.max(x)));
        let allowed = if most > CHANGE * least { FINE * least } else { COARSE * least };
        Ok(longest <= allowed)
    }

    fn inside(&self, t: [u32; 3], p: Point) -> bool {
        let [a, b, c] = t.map(|v| self.points[v as usize]);
        let left = |a: Point, b: Point| (b.x - a.x) * (p.y - a.y) >= (b.y - a.y) * (p.x - a.x);
        left(a, b) && left(b, c) && left(c, a)
    }
}
