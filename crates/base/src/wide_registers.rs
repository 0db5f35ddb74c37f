//! Code for processors with wide registers, in a program that also runs on others.
//!
//! The compiler generates a function twice, once for processors with AVX2; the choice is made at run time. Both versions perform the
//! same operations in the same order, without fused ones: results are equal to the bit.

/// The value of `$any`, or on a processor with AVX2 the result of `$wide` with these arguments: the same function, but with
/// `#[target_feature(enable = "avx2")]`.
#[macro_export]
macro_rules! wide_registers {
    ($any:expr, $wide:path, $($argument:ident),+) => {{
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx2") {
            #[expect(unsafe_code, reason = "the processor has what the function is compiled for")]
            // SAFETY: the processor has just been checked for the feature.
            return unsafe { $wide($($argument),+) };
        }
        $any
    }};
}
