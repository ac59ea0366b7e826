//! Generation

use super::domain::quadrel_domain;
use super::guard::{copy_out, free, guard, required, Failure};
use super::mesh_arrays::MeshArrays;
use super::options::quadrel_options;
use super::stage_arrays::StageArrays;
use super::status::quadrel_status;
use crate::error::Error;
use crate::mesh::HighOrderMesh;
use crate::numerics::Point;
use crate::options::Options;
use crate::stages::Stages;
use crate::statistics::Statistics;
use std::ffi::CString;
use std::sync::Arc;
use std::time::Instant;

/// A finished mesh; it never changes.
pub struct quadrel_mesh {
    pub(super) mesh: Arc<HighOrderMesh>,
    pub(super) arrays: MeshArrays,
    pub(super) names: Vec<CString>,
    pub(super) statistics: CString,
}

/// What the stages of one run made.
#[derive(Default)]
pub struct quadrel_stages {
    pub(super) stages: Stages,
    pub(super) mesh: Option<Arc<HighOrderMesh>>,
    pub(super) failure: Option<Point>,
    pub(super) arrays: StageArrays,
    pub(super) statistics: Option<CString>,
}

impl quadrel_stages {
    pub(super) fn new(
        stages: Stages,
        mesh: Option<Arc<HighOrderMesh>>,
        failure: Option<Point>,
        statistics: &str,
    ) -> Self {
        let arrays = StageArrays::new(&stages);
        quadrel_stages { stages, mesh, failure, arrays, statistics: Some(c_text(statistics)) }
    }
}

/// Text for C: zero bytes inside are left out.
pub(super) fn c_text(text: &str) -> CString {
    let bytes = text.bytes().filter(|b| *b != 0).collect::<Vec<u8>>();
    CString::new(bytes).unwrap_or_default()
}

impl quadrel_mesh {
    pub(super) fn new(mesh: Arc<HighOrderMesh>, statistics: &str) -> Self {
        let arrays = MeshArrays::new(&mesh);
        let names = mesh.boundary_names.iter().map(|name| c_text(name)).collect();
        quadrel_mesh { mesh, arrays, names, statistics: c_text(statistics) }
    }
}

/// An object for quadrel_generate to fill.
#[no_mangle]
pub extern "C" fn quadrel_stages_new() -> *mut quadrel_stages {
    Box::into_raw(Box::default())
}

/// Frees stages.
#[no_mangle]
pub unsafe extern "C" fn quadrel_stages_free(stages: *mut quadrel_stages) {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe { free(stages) }
}

/// Makes the mesh of domain. options may be NULL: the defaults. stages may be NULL; else it forgets what it
/// held and is filled as far as generation came, also on failure. On QUADREL_OK mesh_out receives the mesh,
/// which is conforming, its Jacobians proven positive everywhere and its boundary edges within the tolerance;
/// on failure it receives nothing.
#[no_mangle]
pub unsafe extern "C" fn quadrel_generate(
    domain: *const quadrel_domain,
    options: *const quadrel_options,
    stages: *mut quadrel_stages,
    mesh_out: *mut *mut quadrel_mesh,
) -> quadrel_status {
    guard(|| {
        // SAFETY: the caller's promise (first comment of the header).
        let (domain, options, stages) =
            unsafe { (required(domain, "the domain")?, options.as_ref(), stages.as_mut()) };
        if mesh_out.is_null() {
            return Err(Failure::null("mesh_out"));
        }
        let defaults = Options::default();
        let options = options.map_or(&defaults, |o| &o.options);
        let mesh = generate(domain, options, stages)?;
        // SAFETY: the caller's promise (first comment of the header).
        unsafe { copy_out(mesh_out, &[Box::into_raw(Box::new(mesh))]) };
        Ok(())
    })
}

fn generate(
    domain: &quadrel_domain,
    options: &Options,
    mut kept: Option<&mut quadrel_stages>,
) -> Result<quadrel_mesh, Error> {
    if let Some(kept) = &mut kept {
        **kept = quadrel_stages::default();
    }
    let started = Instant::now();
    let mut stages = Stages::default();
    let result = make(domain, options, &mut stages);
    let statistics = Statistics::new(&stages, &result, started.elapsed().as_secs_f64()).to_json_text();
    let place = result.as_ref().err().and_then(Error::place);
    let mesh = result.map(Arc::new);
    if let Some(kept) = kept {
        *kept = quadrel_stages::new(stages, mesh.as_ref().ok().cloned(), place, &statistics);
    }
    Ok(quadrel_mesh::new(mesh?, &statistics))
}

fn make(domain: &quadrel_domain, options: &Options, stages: &mut Stages) -> Result<HighOrderMesh, Error> {
    let (domain, warnings) = domain.checked()?;
    let result = crate::generate(&domain, options, stages);
    stages.put_first(warnings);
    result
}

/// Frees a mesh.
#[no_mangle]
pub unsafe extern "C" fn quadrel_mesh_free(mesh: *mut quadrel_mesh) {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe { free(mesh) }
}
