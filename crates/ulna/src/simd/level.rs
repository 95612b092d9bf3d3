//! The instruction set in use.

use pulp::{Arch, Simd, WithSimd};

/// Which instruction set the kernels run on: `avx512`, `avx2`, `neon` or `scalar`.
pub fn simd_level() -> &'static str {
    struct Level;
    impl WithSimd for Level {
        type Output = &'static str;
        fn with_simd<S: Simd>(self, _: S) -> &'static str {
            match S::F64_LANES {
                8 => "avx512",
                4 => "avx2",
                2 => "neon",
                _ => "scalar",
            }
        }
    }
    Arch::new().dispatch(Level)
}
