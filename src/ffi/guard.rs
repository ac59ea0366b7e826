//! The border: panics are caught, failures noted, pointers turned into references.

use super::status::{
    quadrel_status, QUADREL_ERROR_INTERNAL, QUADREL_ERROR_INVALID_ARGUMENT, QUADREL_ERROR_NULL, QUADREL_OK,
};
use crate::error::Error;
use libc::c_char;
use std::cell::RefCell;
use std::ffi::CStr;
use std::panic::{catch_unwind, AssertUnwindSafe};

/// Room for the text of the last error, with its zero byte. It is fixed: a text that moves would be read
/// after its end in `printf("%d %s", call(), quadrel_last_error_message())`.
const ROOM: usize = 1024;

/// Why a call failed.
#[derive(Debug, PartialEq)]
pub struct Failure {
    pub status: quadrel_status,
    pub text: String,
    pub place: Option<[f64; 2]>,
}

impl Failure {
    /// A required pointer is NULL.
    pub fn null(what: &str) -> Self {
        Failure { status: QUADREL_ERROR_NULL, text: format!("{what} is NULL"), place: None }
    }

    /// An argument is out of its range.
    pub fn argument(what: &'static str, value: impl ToString, allowed: &'static str) -> Self {
        Error::InvalidArgument { what, value: value.to_string(), allowed }.into()
    }
}

struct LastError {
    text: [u8; ROOM],
    place: Option<[f64; 2]>,
}

thread_local! {
    // Without a destructor it can be read until the very end of the thread.
    static LAST: RefCell<LastError> = const { RefCell::new(LastError { text: [0; ROOM], place: None }) };
}

/// Notes a failure for this thread; a text that is too long is cut between two characters.
fn note(failure: &Failure) {
    LAST.with_borrow_mut(|last| {
        let mut end = failure.text.len().min(ROOM - 1);
        while !failure.text.is_char_boundary(end) {
            end -= 1;
        }
        last.text[..end].copy_from_slice(&failure.text.as_bytes()[..end]);
        // A zero byte inside would end the text early, no more.
        last.text[end..].fill(0);
        last.place = failure.place;
    });
}

pub fn last_error_text() -> *const c_char {
    LAST.with(|last| {
        let last: *const LastError = last.as_ptr();
        // SAFETY: this only computes the address of a field of a live thread-local.
        unsafe { (&raw const (*last).text).cast() }
    })
}

pub fn last_error_location() -> Option<[f64; 2]> {
    LAST.with_borrow(|last| last.place)
}

/// Runs `work`; its failure, or its panic, is noted and becomes the status.
pub fn guard(work: impl FnOnce() -> Result<(), Failure>) -> quadrel_status {
    let result = catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|panic| {
        let reason = panic
            .downcast_ref::<String>()
            .cloned()
            .or_else(|| panic.downcast_ref::<&str>().map(|s| s.to_string()))
            .unwrap_or_else(|| "a panic".to_string());
        Err(Error::Internal { reason }.into())
    });
    match result {
        Ok(()) => QUADREL_OK,
        Err(failure) => {
            note(&failure);
            failure.status
        }
    }
}

/// Runs what cannot fail; a panic is noted and `otherwise` returned.
pub fn answer<T>(otherwise: T, work: impl FnOnce() -> T) -> T {
    let mut result = otherwise;
    let status = guard(|| {
        result = work();
        Ok(())
    });
    debug_assert!(status == QUADREL_OK || status == QUADREL_ERROR_INTERNAL);
    result
}

/// A caller's object, or the failure that names it.
///
/// # Safety
/// `pointer` is NULL or valid for reads while the result is used.
pub unsafe fn required<'a, T>(pointer: *const T, what: &str) -> Result<&'a T, Failure> {
    // SAFETY: by the condition above.
    unsafe { pointer.as_ref() }.ok_or_else(|| Failure::null(what))
}

/// The same for an object that is to be changed.
///
/// # Safety
/// `pointer` is NULL or valid, and nothing else uses the object while the result is used.
pub unsafe fn required_mut<'a, T>(pointer: *mut T, what: &str) -> Result<&'a mut T, Failure> {
    // SAFETY: by the condition above.
    unsafe { pointer.as_mut() }.ok_or_else(|| Failure::null(what))
}

/// `count` values from a caller's array; NULL is an empty array if `count` is 0.
///
/// # Safety
/// `pointer` is NULL or valid for reads of `count` values while the result is used.
pub unsafe fn array<'a, T>(pointer: *const T, count: usize, what: &'static str) -> Result<&'a [T], Failure> {
    if count == 0 {
        return Ok(&[]);
    }
    if pointer.is_null() {
        return Err(Failure::null(what));
    }
    if count > isize::MAX as usize / size_of::<T>() {
        return Err(Failure::argument(what, count, "a number of entries that fits into memory"));
    }
    // SAFETY: by the condition above.
    Ok(unsafe { std::slice::from_raw_parts(pointer, count) })
}

/// Text of the caller.
///
/// # Safety
/// `pointer` is NULL or a text that ends with a zero byte, valid while the result is used.
pub unsafe fn text<'a>(pointer: *const c_char, what: &'static str) -> Result<&'a str, Failure> {
    // SAFETY: by the condition above.
    unsafe { optional_text(pointer, what) }?.ok_or_else(|| Failure::null(what))
}

/// Text of the caller, which may be NULL.
///
/// # Safety
/// As [`text`].
pub unsafe fn optional_text<'a>(
    pointer: *const c_char,
    what: &'static str,
) -> Result<Option<&'a str>, Failure> {
    if pointer.is_null() {
        return Ok(None);
    }
    // SAFETY: by the condition above.
    match unsafe { CStr::from_ptr(pointer) }.to_str() {
        Ok(text) => Ok(Some(text)),
        Err(_) => Err(Failure {
            status: QUADREL_ERROR_INVALID_ARGUMENT,
            text: format!("{what} is not UTF-8"),
            place: None,
        }),
    }
}

/// Copies values to the caller, unless `to` is NULL.
///
/// # Safety
/// `to` is NULL or valid for writes of as many values.
pub unsafe fn copy_out<T: Copy>(to: *mut T, values: &[T]) {
    if !to.is_null() {
        // SAFETY: by the condition above; the caller's memory is not ours.
        unsafe { std::ptr::copy_nonoverlapping(values.as_ptr(), to, values.len()) };
    }
}

/// Takes an object back from the caller and drops it; a panic there is noted, not passed on.
///
/// # Safety
/// `pointer` is NULL or was given out by [`Box::into_raw`] and is not used any more.
pub unsafe fn free<T>(pointer: *mut T) {
    answer((), || {
        if !pointer.is_null() {
            // SAFETY: by the condition above.
            drop(unsafe { Box::from_raw(pointer) });
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    fn last() -> String {
        // SAFETY: the text ends with a zero byte and lives as long as the thread.
        unsafe { CStr::from_ptr(last_error_text()) }.to_str().unwrap().to_string()
    }

    #[test]
    fn a_panic_becomes_a_status() {
        assert_eq!(guard(|| panic!("number {}", 7)), QUADREL_ERROR_INTERNAL);
        assert!(last().contains("number 7") && last().contains("report"), "{}", last());
        assert_eq!(answer(3, || -> i32 { panic!("static") }), 3);
        assert!(last().contains("static"));
    }

    #[test]
    fn a_long_text_is_cut_between_characters_and_the_pointer_stays() {
        let before = last_error_text();
        let long = Failure { text: "é".repeat(ROOM), ..Failure::null("x") };
        assert_eq!(guard(|| Err(long)), QUADREL_ERROR_NULL);
        assert_eq!(last(), "é".repeat((ROOM - 1) / 2));
        guard(|| Err(Failure { place: Some([1.0, 2.0]), ..Failure::null("the mesh") }));
        assert_eq!((last().as_str(), last_error_location()), ("the mesh is NULL", Some([1.0, 2.0])));
        guard(|| Err(Failure::null("the mesh")));
        assert_eq!((last_error_text(), last_error_location()), (before, None));
    }

    #[test]
    fn other_threads_do_not_see_it() {
        guard(|| Err(Failure::null("here")));
        std::thread::spawn(|| assert_eq!(last(), "")).join().unwrap();
        assert_eq!(last(), "here is NULL");
    }

    #[test]
    fn arrays_beyond_memory_are_refused() {
        let one = [0.0f64; 2];
        // SAFETY: nothing is read: the call is refused.
        let refused = unsafe { array(one.as_ptr(), usize::MAX, "the points") };
        assert_eq!(refused.unwrap_err().status, QUADREL_ERROR_INVALID_ARGUMENT);
    }
}
