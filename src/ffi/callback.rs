//! The pointer that comes with callbacks.

use super::domain::quadrel_destroy_fn;
use libc::c_void;

/// The caller's `user` pointer; dropping it calls `destroy`.
pub struct User {
    pointer: *mut c_void,
    destroy: quadrel_destroy_fn,
}

// SAFETY: the header promises that callbacks run, and objects are freed, on threads that the caller chooses:
// it is the caller who keeps `user` fit for them. quadrel starts no threads.
unsafe impl Send for User {}
unsafe impl Sync for User {}

impl User {
    /// Takes `user` over. To be made first of all in every function that takes one, so that no way out
    /// misses `destroy`.
    pub fn new(pointer: *mut c_void, destroy: quadrel_destroy_fn) -> Self {
        User { pointer, destroy }
    }

    pub fn pointer(&self) -> *mut c_void {
        self.pointer
    }
}

impl Drop for User {
    fn drop(&mut self) {
        if let Some(destroy) = self.destroy {
            // SAFETY: the caller gave the function for this pointer; it is called here alone.
            unsafe { destroy(self.pointer) };
        }
    }
}
