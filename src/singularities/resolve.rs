//! Steps 1 to 3 together: refine the base mesh until it resolves the field.

use super::{find, gate, CornerFan, Singularity};
use crate::base_mesh::{triangulate, usual_size, Request, Triangulation};
use crate::cross_field::{solve, CrossField};
use crate::domain::Boundary;
use crate::error::Result;
use crate::numerics::tolerances::LEAST_REFINEMENT;
use crate::options::FieldMethod;

/// Most rounds of refinement.
const ROUNDS: usize = 4;

/// Base mesh, field and singularities that belong together.
#[derive(Debug, Clone, PartialEq)]
pub struct Resolved {
    pub mesh: Triangulation,
    pub field: CrossField,
    pub singularities: Vec<Singularity>,
    pub corners: Vec<CornerFan>,
    /// The request that gave this base mesh: later stages add their places and come back.
    pub request: Request,
}

/// Triangulates, solves and finds singularities, and refines the base mesh where [`gate`] asks for it,
/// a bounded number of times; what [`find`] accepts after that is taken.
pub fn resolve(boundary: &Boundary, mut request: Request, method: FieldMethod) -> Result<Resolved> {
    let least =
        LEAST_REFINEMENT * request.size.unwrap_or_else(|| usual_size(boundary)).min(usual_size(boundary));
    let mut round = 0;
    loop {
        let mesh = triangulate(boundary, &request)?;
        let field = solve(&mesh, boundary, method)?;
        let found = find(&mesh, boundary, &field);
        let known = found.as_ref().map_or(&[][..], |(singularities, _)| singularities);
        match gate(&mesh, boundary, &field, known, least) {
            Err(places) if round < ROUNDS => request.refine.extend(places),
            _ => {
                let (singularities, corners) = found?;
                return Ok(Resolved { mesh, field, singularities, corners, request });
            }
        }
        round += 1;
    }
}
