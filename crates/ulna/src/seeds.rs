//! Seeds for work that is cut into pieces: each piece has its own, whoever does it.

/// Two numbers into one seed (SplitMix64's constants, Steele 2014).
pub(crate) fn mix(seed: u64, run: u64) -> u64 {
    let z = seed.wrapping_add(run.wrapping_mul(0x9E37_79B9_7F4A_7C15));
    (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9)
}
