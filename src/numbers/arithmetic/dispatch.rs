//! Run-time choice of vector instructions: the one file of this crate that may use `unsafe`.
//!
//! [`vectorised`] runs a closure inside a function that is compiled for AVX-512 or AVX2 when the machine has
//! it, so that a plain release build (baseline x86-64) still uses wide vectors in the loops over
//! [`super::lane::F64x8`]. Fused multiply-add is *not* used (Rust never contracts a * b + c by itself): the
//! digits are those of the baseline.

#![allow(unsafe_code)]

/// Runs `f` with the widest vector instructions that the machine has and this crate was written for.
///
/// `f` and what it calls must be `#[inline(always)]` to profit; the result is the same either way.
#[inline(always)]
pub fn vectorised<R>(f: impl FnOnce() -> R) -> R {
    #[cfg(target_arch = "x86_64")]
    {
        if has_avx512() {
            // SAFETY: `with_avx512` requires the features that `has_avx512` has just found, and nothing else.
            return unsafe { with_avx512(f) };
        }
        if std::arch::is_x86_feature_detected!("avx2") {
            // SAFETY: `with_avx2` requires AVX2, which was just found, and nothing else.
            return unsafe { with_avx2(f) };
        }
    }
    f()
}

#[cfg(target_arch = "x86_64")]
#[inline(always)]
fn has_avx512() -> bool {
    std::arch::is_x86_feature_detected!("avx512f")
        && std::arch::is_x86_feature_detected!("avx512vl")
        && std::arch::is_x86_feature_detected!("avx512dq")
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512vl,avx512dq")]
fn with_avx512<R>(f: impl FnOnce() -> R) -> R {
    f()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn with_avx2<R>(f: impl FnOnce() -> R) -> R {
    f()
}
