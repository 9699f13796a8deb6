//! Run-time choice of vector instructions: the one file of this crate that may use `unsafe`.
//!
//! [`vectorised`] runs a closure inside a function that is compiled for AVX2 when the machine has it, so
//! that a plain release build (baseline x86-64) still uses 256-bit vectors in the loops over
//! [`super::lane::F64x8`]. Fused multiply-add is *not* switched on: the digits are those of the baseline.

#![allow(unsafe_code)]

/// Runs `f` with the widest vector instructions that the machine has and this crate was written for.
///
/// `f` and what it calls must be `#[inline(always)]` to profit; the result is the same either way.
#[inline(always)]
pub fn vectorised<R>(f: impl FnOnce() -> R) -> R {
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("avx2") {
        // SAFETY: the only requirement of `with_avx2` is that the processor has AVX2, which was just asked.
        return unsafe { with_avx2(f) };
    }
    f()
}

/// The name of the instruction set that [`vectorised`] uses on this machine.
pub fn instruction_set() -> &'static str {
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("avx2") {
        return "AVX2";
    }
    "baseline"
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn with_avx2<R>(f: impl FnOnce() -> R) -> R {
    f()
}
