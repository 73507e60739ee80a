//! The SIMD level: detected at run time, or forced.

use crate::error::RasterError;
use fearless_simd::Level;
use std::fmt;

/// Evaluates an expression with the vectors of a level: like [`fearless_simd::dispatch`], but only for the levels used
/// here.
macro_rules! with_vectors {
    ($level:expr, $simd:ident => $draw:expr) => {
        match $level {
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            fearless_simd::Level::Avx512($simd) => $draw,
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            fearless_simd::Level::Avx2($simd) => $draw,
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            level => {
                match level.as_sse2() {
                    Some($simd) => $draw,
                    None => unreachable!("every x86 CPU that runs this has SSE2"),
                }
            }
            #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
            level => fearless_simd::dispatch!(level, $simd => $draw),
        }
    };
}
pub(crate) use with_vectors;

/// The environment variable that forces a SIMD level by its name.
pub const WIDTH_VARIABLE: &str = "HALFWAY_SIMD";

/// The vectors that a CPU has. Pictures are the same to the bit on all of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum VectorWidth {
    /// 16 numbers: AVX-512 as of Ice Lake and Zen 4.
    Avx512,
    /// 8 numbers: AVX2 with fused multiply-add, most x86 CPUs since 2013.
    Avx2,
    /// 4 numbers: 64-bit ARM.
    Neon,
    /// Vectors that every CPU of the target has; 4 numbers, and a fused multiply-add that is emulated exactly.
    Plain,
}

impl VectorWidth {
    const ALL: [Self; 4] = [Self::Avx512, Self::Avx2, Self::Neon, Self::Plain];

    /// The levels of this CPU, the widest first. There is always one.
    pub fn available() -> impl Iterator<Item = Self> {
        Self::ALL.into_iter().filter(|width| width.level().is_some())
    }

    /// The widest of this CPU, or the one that [`WIDTH_VARIABLE`] names.
    ///
    /// # Errors
    /// The variable names a width that is unknown or that this CPU does not have.
    pub fn from_environment() -> Result<Self, RasterError> {
        match std::env::var(WIDTH_VARIABLE) {
            Ok(name) if !name.is_empty() => Self::named(&name),
            _ => Ok(Self::available().next().unwrap_or(Self::Plain)),
        }
    }

    /// The level of this name: `avx512`, `avx2`, `neon` or `plain`, in any case.
    ///
    /// # Errors
    /// The name is unknown, or this CPU does not have it.
    pub fn named(name: &str) -> Result<Self, RasterError> {
        Self::available().find(|width| width.to_string().eq_ignore_ascii_case(name)).ok_or_else(|| {
            let names: Vec<_> = Self::available().map(|width| width.to_string()).collect();
            RasterError::Width { asked: name.to_owned(), available: names.join(", ") }
        })
    }

    /// The number of lanes of a vector.
    pub fn lanes(self) -> usize {
        match self {
            Self::Avx512 => 16,
            Self::Avx2 => 8,
            Self::Neon | Self::Plain => 4,
        }
    }

    /// The proof that this CPU has it.
    pub(crate) fn level(self) -> Option<Level> {
        let best = Level::new();
        match self {
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            Self::Avx512 => best.as_avx512().map(Level::Avx512),
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            Self::Avx2 => best.as_avx2().map(Level::Avx2),
            #[cfg(target_arch = "aarch64")]
            Self::Neon => best.as_neon().map(Level::Neon),
            #[cfg(not(target_arch = "aarch64"))]
            Self::Plain => Some(Level::baseline()),
            _ => {
                let _ = best;
                None
            }
        }
    }
}

impl fmt::Display for VectorWidth {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Avx512 => "avx512",
            Self::Avx2 => "avx2",
            Self::Neon => "neon",
            Self::Plain => "plain",
        })
    }
}
