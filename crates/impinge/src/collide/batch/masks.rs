//! Transposition of masks: from one bit per pair to one byte per pair.
//!
//! ```text
//!   row r, bit lane   --per_pair-->   byte lane, bit r
//! ```

/// Transposes 8 masks, each with a bit per pair, into a byte for each pair.
#[inline(always)]
pub(super) const fn per_pair(rows: [u8; 8]) -> [u8; 8] {
    transposed(u64::from_le_bytes(rows)).to_le_bytes()
}

/// Transposes a matrix of 8 by 8 bits (H. S. Warren, "Hacker's Delight", 7-3): transposes each
/// block of 2 by 2 bits, then swaps blocks of 2 by 2 bits within 4 by 4, then blocks of 4 by 4
/// within 8 by 8.
#[inline(always)]
const fn transposed(mut x: u64) -> u64 {
    let swapped = (x ^ x >> 7) & 0x00aa_00aa_00aa_00aa;
    x ^= swapped ^ swapped << 7;
    let swapped = (x ^ x >> 14) & 0x0000_cccc_0000_cccc;
    x ^= swapped ^ swapped << 14;
    let swapped = (x ^ x >> 28) & 0x0000_0000_f0f0_f0f0;
    x ^ swapped ^ swapped << 28
}
