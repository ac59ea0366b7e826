//! SVG's elliptic arcs, given by their end points (SVG 1.1, appendix F.6), in centre form.

use crate::domain::EllipticArc;
use crate::numerics::{Point, Vector};

/// An arc in centre form, in SVG's coordinates.
pub(crate) struct CenterArc(EllipticArc);

impl CenterArc {
    /// `None`: a radius is 0 (the arc is a straight line) or the ends coincide. Radii too small for the end points are
    /// enlarged, `rotation` is in degrees.
    pub fn from_end_points(
        from: [f64; 2],
        to: [f64; 2],
        radii: [f64; 2],
        rotation: f64,
        large: bool,
        sweep: bool,
    ) -> Option<Self> {
        let [mut a, mut b] = radii.map(f64::abs);
        if a == 0.0 || b == 0.0 || from == to {
            return None;
        }
        let (p, q) = (Vector::from(from), Vector::from(to));
        let (s, c) = rotation.to_radians().sin_cos();
        let half = (p - q) / 2.0;
        let (x, y) = (c * half.x + s * half.y, -s * half.x + c * half.y);
        let excess = (x / a).powi(2) + (y / b).powi(2);
        if excess > 1.0 {
            a *= excess.sqrt();
            b *= excess.sqrt();
        }
        // (a²b² − a²y² − b²x²) / (a²y² + b²x²), whose numerator would cancel for half circles.
        let mut factor = if excess < 1.0 { (1.0 / excess - 1.0).sqrt() } else { 0.0 };
        if large == sweep {
            factor = -factor;
        }
        let (cx, cy) = (factor * a * y / b, -factor * b * x / a);
        let center = Vector::new(c * cx - s * cy, s * cx + c * cy) + (p + q) / 2.0;
        let start = ((y - cy) / b).atan2((x - cx) / a);
        let mut turn = ((-y - cy) / b).atan2((-x - cx) / a) - start;
        if sweep && turn < 0.0 {
            turn += 2.0 * std::f64::consts::PI;
        } else if !sweep && turn > 0.0 {
            turn -= 2.0 * std::f64::consts::PI;
        }
        Some(CenterArc(EllipticArc {
            center: Point::from(center),
            u: Vector::new(a * c, a * s),
            v: Vector::new(-b * s, b * c),
            start,
            end: start + turn,
        }))
    }

    /// The same arc with the y axis turned up.
    pub fn flipped(self) -> EllipticArc {
        let up = |v: Vector| Vector::new(v.x, -v.y);
        let arc = self.0;
        EllipticArc { center: Point::from(up(arc.center.coords)), u: up(arc.u), v: up(arc.v), ..arc }
    }
}
