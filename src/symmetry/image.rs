//! A symmetry of the boundary: where each chain and each junction goes.

use super::isometry::{direction, product, Isometry};
use crate::domain::{Boundary, BoundaryPoint, Chain, Place};
use crate::error::Result;
use crate::mesh::ExactCurve;
use crate::numerics::tolerances::SYMMETRY_ANGLE;
use crate::numerics::{left_normal, Point, Vector};

/// Where a symmetry takes a chain: arc length s goes to `offset` + s, or − s if `backwards`, of `chain`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChainImage {
    pub chain: u32,
    pub offset: f64,
    pub backwards: bool,
}

/// A rotation or mirror that takes the boundary onto itself.
#[derive(Debug, Clone, PartialEq)]
pub struct Symmetry {
    pub map: Isometry,
    /// The image of each chain, and of each junction.
    pub chains: Vec<ChainImage>,
    pub junctions: Vec<u32>,
}

/// Points to which an isometry is fitted, about.
const FIT_POINTS: usize = 256;
/// Newton steps to the foot of a point on a chain.
const FOOT_STEPS: usize = 8;

impl ChainImage {
    /// The arc length that `s` goes to, not wrapped.
    pub fn image(&self, s: f64) -> f64 {
        if self.backwards {
            self.offset - s
        } else {
            self.offset + s
        }
    }

    /// The arc length that goes to `s`, not wrapped.
    pub fn origin(&self, s: f64) -> f64 {
        if self.backwards {
            self.offset - s
        } else {
            s - self.offset
        }
    }
}

impl Symmetry {
    /// The symmetry that moves nothing.
    pub fn identity(boundary: &Boundary) -> Self {
        let own = |chain| ChainImage { chain, offset: 0.0, backwards: false };
        Symmetry {
            map: Isometry::identity(),
            chains: (0..boundary.chains.len() as u32).map(own).collect(),
            junctions: (0..boundary.junctions.len() as u32).collect(),
        }
    }

    /// `map`, if it takes `boundary` onto itself within `tolerance`: junctions to junctions, and all that bears one
    /// name to all that bears one (the same or another: top and bottom may change places).
    pub fn of(boundary: &Boundary, map: Isometry, tolerance: f64) -> Option<Self> {
        let mut by_radius: Vec<(f64, u32)> =
            boundary.junctions.iter().zip(0..).map(|(j, i)| (j.point.coords.norm(), i)).collect();
        by_radius.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut junctions = Vec::with_capacity(boundary.junctions.len());
        for junction in &boundary.junctions {
            let (image, radius) = (map.point(junction.point), junction.point.coords.norm());
            let from = by_radius.partition_point(|x| x.0 < radius - 2.0 * tolerance);
            let close = by_radius[from..].iter().take_while(|x| x.0 <= radius + 2.0 * tolerance);
            let alike = |&(_, i): &(f64, u32)| {
                let other = &boundary.junctions[i as usize];
                let near = (other.point - image).norm() <= tolerance;
                (near && (other.angle - junction.angle).abs() <= SYMMETRY_ANGLE).then_some(i)
            };
            junctions.push(close.filter_map(alike).next()?);
        }
        let closed = (0..).zip(&boundary.chains).filter(|(_, c)| c.ends.is_none());
        let discs: Vec<Disc> = closed.map(|(chain, c)| Disc::around(chain, c)).collect();
        let mut names = NameImages::new(boundary.names.len());
        let mut chains = Vec::with_capacity(boundary.chains.len());
        for chain in &boundary.chains {
            let image = match chain.ends {
                Some(ends) => {
                    let ends = ends.map(|j| junctions[j as usize]);
                    let [start, end] = if map.mirror { [ends[1], ends[0]] } else { ends };
                    let index = boundary.junctions[start as usize].chain_out;
                    let to = &boundary.chains[index as usize];
                    let offset = if map.mirror { to.length } else { 0.0 };
                    let image = ChainImage { chain: index, offset, backwards: map.mirror };
                    (to.ends == Some([start, end]) && same(chain, to, image, &map, tolerance))
                        .then_some(image)
                }
                None => discs.iter().find_map(|disc| {
                    let to = &boundary.chains[disc.chain as usize];
                    let start = map.point(chain.point(0.0));
                    if (start - disc.center).norm() > disc.radius + tolerance {
                        return None;
                    }
                    let offset = foot(to, start, tolerance)?;
                    let image = ChainImage { chain: disc.chain, offset, backwards: map.mirror };
                    same(chain, to, image, &map, tolerance).then_some(image)
                }),
            };
            let image = image?;
            names.add(chain.name, boundary.chains[image.chain as usize].name)?;
            chains.push(image);
        }
        Some(Symmetry { map, chains, junctions })
    }

    /// Its isometry turned a little, to where the exact boundary lies best on its image (a Gauss-Newton step of the
    /// distances across the boundary: how far along it the places are right does not matter).
    ///
    /// # Errors
    /// What `exact` reports.
    pub fn fitted(&self, boundary: &Boundary, exact: &dyn ExactCurve) -> Result<Isometry> {
        let (mut sum, mut weight) = (0.0, 0.0);
        let entries: usize = boundary.chains.iter().map(|c| c.samples.len()).sum();
        let step = entries.div_ceil(FIT_POINTS).max(1);
        for (chain, image) in boundary.chains.iter().zip(&self.chains) {
            let to = &boundary.chains[image.chain as usize];
            for sample in chain.samples.iter().step_by(step) {
                let p = self.map.point(sample.point);
                let s = to.wrap(image.image(sample.s));
                let q = boundary.frame.to_canonical(exact.point(BoundaryPoint { chain: image.chain, s })?);
                let normal = left_normal(to.tangent(s));
                let gain = normal.dot(&left_normal(p.coords));
                sum += gain * normal.dot(&(q - p));
                weight += gain * gain;
            }
        }
        let angle = if weight > 0.0 { sum / weight } else { 0.0 };
        Ok(Isometry { turn: product(direction(angle), self.map.turn).normalize(), ..self.map })
    }

    /// The image of a place on the boundary.
    pub fn place(&self, boundary: &Boundary, place: Place) -> Place {
        match place {
            Place::Interior => Place::Interior,
            Place::Junction(j) => Place::Junction(self.junctions[j as usize]),
            Place::Boundary(p) => Place::Boundary(self.point(boundary, p)),
        }
    }

    /// The image of a boundary point.
    pub fn point(&self, boundary: &Boundary, p: BoundaryPoint) -> BoundaryPoint {
        let image = self.chains[p.chain as usize];
        let s = boundary.chains[image.chain as usize].wrap(image.image(p.s));
        BoundaryPoint { chain: image.chain, s }
    }
}

/// A disc that holds a closed chain: of many holes most are out of the question at once.
struct Disc {
    chain: u32,
    center: Point,
    radius: f64,
}

impl Disc {
    fn around(chain: u32, table: &Chain) -> Self {
        let sum: Vector = table.samples.iter().map(|s| s.point.coords).sum();
        let center = Point::from(sum / table.samples.len() as f64);
        let farthest = table.samples.iter().map(|s| (s.point - center).norm()).fold(0.0, f64::max);
        // The curve bulges a little between the table's entries.
        Disc { chain, center, radius: 1.1 * farthest }
    }
}

/// Which name goes to which: one to one.
struct NameImages([Vec<Option<u32>>; 2]);

impl NameImages {
    fn new(count: usize) -> Self {
        NameImages([vec![None; count], vec![None; count]])
    }

    /// Adds that `from` goes to `to`; `None` if that contradicts what was added before.
    fn add(&mut self, from: u32, to: u32) -> Option<()> {
        let [images, origins] = &mut self.0;
        let (image, origin) = (images.get_mut(from as usize)?, origins.get_mut(to as usize)?);
        (*image.get_or_insert(to) == to && *origin.get_or_insert(from) == from).then_some(())
    }
}

/// Whether every table entry of `chain` goes to its image on `to`; a table entry is a point of the exact curve.
fn same(chain: &Chain, to: &Chain, image: ChainImage, map: &Isometry, tolerance: f64) -> bool {
    (chain.length - to.length).abs() <= tolerance
        && chain
            .samples
            .iter()
            .all(|sample| (map.point(sample.point) - to.point(image.image(sample.s))).norm() <= tolerance)
}

/// The arc length at which `p` lies on `chain`.
fn foot(chain: &Chain, p: Point, tolerance: f64) -> Option<f64> {
    let nearest = chain
        .samples
        .iter()
        .min_by(|a, b| (a.point - p).norm_squared().total_cmp(&(b.point - p).norm_squared()))?;
    let mut s = nearest.s;
    for _ in 0..FOOT_STEPS {
        let (q, v) = chain.evaluate(s);
        s = chain.wrap(s + (p - q).dot(&v) / v.norm_squared());
    }
    ((chain.point(s) - p).norm() <= tolerance).then_some(s)
}
