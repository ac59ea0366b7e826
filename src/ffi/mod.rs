//! quadrel makes curved all-quadrilateral meshes of planar domains for spectral element methods.
//!
//! Describe the domain's boundary (or read it from a file), choose order and tolerance, generate, read the
//! mesh through its arrays or write it to a file. This header is the manual of the C interface; quadrel.hpp
//! is the same for C++17.
//!
//! ```c
//! quadrel_domain *disc = quadrel_domain_new();
//! quadrel_mesh *mesh = NULL;
//! const double center[2] = {0.0, 0.0};
//! quadrel_domain_begin_loop(disc, QUADREL_LOOP_OUTER, "wall");
//! quadrel_domain_add_arc(disc, center, 1.0, 0.0, 6.283185307179586, NULL);
//! quadrel_domain_end_loop(disc);
//! if (quadrel_generate(disc, NULL, NULL, &mesh) != QUADREL_OK)
//!     fprintf(stderr, "%s\n", quadrel_last_error_message());
//! quadrel_mesh_write(mesh, QUADREL_FORMAT_VTU, "disc.vtu");
//! quadrel_mesh_free(mesh);
//! quadrel_domain_free(disc);
//! ```
//!
//! Ownership. `quadrel_X_new`, `quadrel_domain_read` and `quadrel_generate` hand an object to the caller;
//! `quadrel_X_free` takes it back and accepts NULL. Every `const T *` that a getter returns is a borrowed,
//! read-only view that lives until its object is freed (or, for stages, used in another run). A mesh needs
//! neither its domain nor its options any more.
//!
//! Errors. What can fail returns a `quadrel_status` and writes its outputs only on `QUADREL_OK` (stages
//! excepted: they are filled as far as generation came). A NULL argument is `QUADREL_ERROR_NULL` and an
//! unknown number `QUADREL_ERROR_INVALID_ARGUMENT`, never a crash. Getters answer 0 or NULL where there is
//! nothing, also for NULL. `quadrel_last_error_message` says in words what failed last on this thread and
//! `quadrel_last_error_location` where in the domain. A defect of quadrel itself is caught and becomes
//! `QUADREL_ERROR_INTERNAL`.
//!
//! Threads. There is no global state. Different objects may be used on different threads at once. One object
//! may be read (by functions that take it as `const`) on many threads at once, or changed on one. The mesh
//! depends on domain and options alone: the same input gives the same bits.
//!
//! Callbacks. They run on the thread that called quadrel, inside that call, one at a time. They must not
//! unwind or longjmp through quadrel, nor change the object they serve; they may call quadrel for other
//! objects. `user` is passed through as it is. A function that takes `user` together with a `destroy`
//! function calls `destroy(user)` exactly once: when `user` is needed no more, also if the call itself fails.
//!
//! Units. Lengths are in the caller's unit, angles in radians. Indices count from 0; -1 stands for none.
//! Numbers are passed as `int32_t` constants, never as C enumerations. `[n][2]` describes an array of n
//! pairs, without gaps: point k is at 2k and 2k + 1. Text is UTF-8 and ends with a zero byte.
//!
//! Meshes. Corners 0 to 3 of an element are counter-clockwise; side s joins corner s to corner (s + 1) % 4.
//! Nodes of an element are indexed [j][i], both from 0 to N: i grows along side 0 (from corner 0 to corner
//! 1), j along side 3 backwards (from corner 0 to corner 3); they are the images of the Gauss-Lobatto points
//! of the square [-1, 1] x [-1, 1]. Both elements at an edge share its nodes.
#![allow(unsafe_code)]
// The names are C's; the first comment of the header says for all functions what makes a call safe.
#![allow(non_camel_case_types, clippy::missing_safety_doc)]
// The comments are the header's: brackets are shapes of arrays.
#![allow(rustdoc::broken_intra_doc_links)]

mod base_triangulation;
mod callback;
mod domain;
mod domain_file;
mod generate;
mod guard;
mod mesh;
mod mesh_arrays;
mod options;
mod progress;
mod quality;
mod size;
mod stage_arrays;
mod stages;
mod status;
mod write;

pub use base_triangulation::*;
pub use domain::*;
pub use domain_file::*;
pub use generate::*;
pub use mesh::*;
pub use options::*;
pub use progress::*;
pub use quality::*;
pub use size::*;
pub use stages::*;
pub use status::*;
pub use write::*;
