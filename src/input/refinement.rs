//! The refinement regions of HOHQMesh's control files as a size function.
//!
//! A REFINEMENT_CENTER at x0, or a REFINEMENT_LINE from x0 to x1, asks for size h; `smooth` ones for h · 3^{d/w} at
//! distance d (three times as much at the distance w, and so on), others for h up to the distance w and for
//! nothing beyond. A line counts only for points that have a foot on it. The least size holds.

use super::blocks::{Block, Located};
use super::control::{number, point};
use crate::error::Result;
use crate::numerics::Point;
use crate::options::SizeFunction;

/// A size that stands for none: far above any domain's, and still a number.
const ANY: f64 = 1e300;
/// Most places by which one line is told to the sampling.
const MOST_PLACES: f64 = 200.0;

struct Region {
    from: Point,
    /// The end of a line.
    to: Option<Point>,
    size: f64,
    width: f64,
    smooth: bool,
}

/// The size that the REFINEMENT_REGIONS of CONTROL_INPUT ask for; `None` if there are none.
pub(super) fn size_function(control: &Block) -> Result<Option<SizeFunction>> {
    let mut regions = Vec::new();
    let within = |b: &&Block| b.name == "REFINEMENT_REGIONS";
    for block in
        control.children.iter().chain(control.children.iter().filter(within).flat_map(|b| &b.children))
    {
        match block.name.as_str() {
            "REFINEMENT_CENTER" => regions.push(region(block, false)?),
            "REFINEMENT_LINE" => regions.push(region(block, true)?),
            _ => {}
        }
    }
    if regions.is_empty() {
        return Ok(None);
    }
    let places = regions.iter().flat_map(places).collect();
    let size = move |[x, y]: [f64; 2]| regions.iter().map(|r| r.at(Point::new(x, y))).fold(ANY, f64::min);
    Ok(Some(SizeFunction::new(size).with_places(places)))
}

fn region(block: &Block, line: bool) -> Result<Region> {
    let length = |key: &str| {
        let value: &Located = block.need(key)?;
        match number(value)? {
            x if x > 0.0 => Ok(x),
            _ => Err(value.error(format!("the {key} of a refinement region must be above 0"))),
        }
    };
    let smooth = block.get("type").is_some_and(|t| t.text.eq_ignore_ascii_case("smooth"));
    let to = if line { Some(point(block.need("x1")?)?) } else { None };
    Ok(Region { from: point(block.need("x0")?)?, to, size: length("h")?, width: length("w")?, smooth })
}

impl Region {
    /// The distance of `p`; `None` beyond the ends of a line.
    fn distance(&self, p: Point) -> Option<f64> {
        let Some(to) = self.to else { return Some((p - self.from).norm()) };
        let along = to - self.from;
        let share = (p - self.from).dot(&along) / along.norm_squared();
        (0.0..=1.0).contains(&share).then(|| (p - (self.from + along * share)).norm())
    }

    fn at(&self, p: Point) -> f64 {
        match self.distance(p) {
            Some(d) if self.smooth => (self.size * 3f64.powf(d / self.width)).min(ANY),
            Some(d) if d < self.width => self.size,
            _ => ANY,
        }
    }
}

/// Points so close that no part of the region is missed.
fn places(region: &Region) -> Vec<[f64; 2]> {
    let Some(to) = region.to else { return vec![[region.from.x, region.from.y]] };
    let along = to - region.from;
    let count = (along.norm() / region.size.min(region.width)).ceil().clamp(1.0, MOST_PLACES);
    let at = |k: usize| region.from + along * ((k as f64 + 0.5) / count);
    (0..count as usize).map(|k| [at(k).x, at(k).y]).collect()
}
