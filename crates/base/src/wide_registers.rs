//! Code for processors with wide registers, in a program that runs on those without them.
//!
//! The compiler makes a function twice, once for processors with AVX2; which one is called is found out when it runs. Both do the same
//! operations in the same order, none of them fused: results are equal to the bit.

/// The value of `$any`, or what `$wide` gives of these arguments where the processor has AVX2: the same as a function with
/// `#[target_feature(enable = "avx2")]`.
#[macro_export]
macro_rules! wide_registers {
    ($any:expr, $wide:path, $($argument:ident),+) => {{
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx2") {
            #[expect(unsafe_code, reason = "the processor has what the function is compiled for")]
            // SAFETY: it was asked just now.
            return unsafe { $wide($($argument),+) };
        }
        $any
    }};
}
