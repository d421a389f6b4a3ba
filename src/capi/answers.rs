//! Errors and buffers at the border to C. No panic crosses it.

use std::cell::RefCell;
use std::ffi::{CStr, CString, c_char};
use std::panic::{AssertUnwindSafe, catch_unwind};

thread_local! {
    static LAST: RefCell<CString> = RefCell::default();
}

/// What went wrong last on this thread.
pub(super) fn last_error() -> *const c_char {
    LAST.with_borrow(|last| last.as_ptr())
}

/// The answer of some work, or `failed` with the error noted.
pub(super) fn answer<T>(failed: T, work: impl FnOnce() -> Result<T, String>) -> T {
    // What a panic leaves half done is the caller's buffers alone, which hold plain numbers.
    let error = match catch_unwind(AssertUnwindSafe(work)) {
        Ok(Ok(answer)) => return answer,
        Ok(Err(error)) => error,
        Err(_) => "an error of the library; please report it".to_owned(),
    };
    let error = CString::new(error.replace('\0', " ")).unwrap_or_default();
    LAST.set(error);
    failed
}

/// A text of the caller's.
///
/// # Safety
/// `text` is NULL or ends with a zero byte, and outlives the answer.
pub(super) unsafe fn text<'a>(text: *const c_char, name: &str) -> Result<&'a str, String> {
    if text.is_null() {
        return Err(format!("{name} is NULL"));
    }
    // SAFETY: the caller's promise.
    unsafe { CStr::from_ptr(text) }.to_str().map_err(|error| format!("{name} is not UTF-8: {error}"))
}

/// A text of the caller's, or None for NULL.
///
/// # Safety
/// As [`text`].
pub(super) unsafe fn optional_text<'a>(words: *const c_char, name: &str) -> Result<Option<&'a str>, String> {
    // SAFETY: the caller's promise.
    if words.is_null() { Ok(None) } else { unsafe { text(words, name) }.map(Some) }
}

/// A buffer to read.
///
/// # Safety
/// `first` is NULL or begins `count` valid values that outlive the answer and do not change meanwhile.
pub(super) unsafe fn input<'a, T>(first: *const T, count: usize, name: &str) -> Result<&'a [T], String> {
    if count == 0 {
        return Ok(&[]);
    }
    checked(first, count, name)?;
    // SAFETY: the caller's promise.
    Ok(unsafe { std::slice::from_raw_parts(first, count) })
}

/// A buffer to write.
///
/// # Safety
/// `first` is NULL or begins `count` values that outlive the answer and that nothing else reads or writes meanwhile.
pub(super) unsafe fn output<'a, T>(first: *mut T, count: usize, name: &str) -> Result<&'a mut [T], String> {
    if count == 0 {
        return Ok(&mut []);
    }
    checked(first, count, name)?;
    // SAFETY: the caller's promise. All types of buffers are plain numbers, for which any bytes are valid.
    Ok(unsafe { std::slice::from_raw_parts_mut(first, count) })
}

/// A buffer to write, or an empty one for NULL.
///
/// # Safety
/// As [`output`].
pub(super) unsafe fn optional_output<'a, T>(first: *mut T, count: usize, name: &str) -> Result<&'a mut [T], String> {
    // SAFETY: the caller's promise.
    if first.is_null() { Ok(&mut []) } else { unsafe { output(first, count, name) } }
}

pub(super) fn at_least_zero(value_m: f64, name: &str) -> Result<f64, String> {
    if value_m >= 0.0 && value_m.is_finite() { Ok(value_m) } else { Err(format!("{name} is {value_m}; use 0 or more")) }
}

fn checked<T>(first: *const T, count: usize, name: &str) -> Result<(), String> {
    if first.is_null() {
        return Err(format!("{name} is NULL"));
    }
    if !first.is_aligned() {
        return Err(format!("{name} is not aligned to {} bytes", align_of::<T>()));
    }
    match count.checked_mul(size_of::<T>()) {
        Some(bytes) if bytes <= isize::MAX as usize => Ok(()),
        _ => Err(format!("{name} cannot hold {count} values")),
    }
}
