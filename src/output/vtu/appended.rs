//! The appended data section of VTK XML files: compressed blocks, base64-coded.

use base64::engine::general_purpose::STANDARD;
use base64::Engine;
use miniz_oxide::deflate::compress_to_vec_zlib;

/// Bytes of an array that are compressed as one; a reader holds one block at a time.
const BLOCK: usize = 1 << 18;

/// zlib's usual trade of speed for size.
const LEVEL: u8 = 6;

/// Arrays one after the other.
#[derive(Default)]
pub struct Appended(String);

impl Appended {
    /// Adds an array and returns its offset, counted from after the section's `_`.
    ///
    /// The header (number of blocks, block size, size of the last block if partial, compressed
    /// sizes; UInt64 each) is a base64 run of its own, the blocks together are another.
    pub fn push(&mut self, bytes: &[u8]) -> usize {
        let offset = self.0.len();
        let blocks: Vec<Vec<u8>> = bytes.chunks(BLOCK).map(|b| compress_to_vec_zlib(b, LEVEL)).collect();
        let mut header: Vec<u64> = vec![blocks.len() as u64, BLOCK as u64, (bytes.len() % BLOCK) as u64];
        header.extend(blocks.iter().map(|b| b.len() as u64));
        let header: Vec<u8> = header.into_iter().flat_map(u64::to_le_bytes).collect();
        STANDARD.encode_string(header, &mut self.0);
        STANDARD.encode_string(blocks.concat(), &mut self.0);
        offset
    }

    /// All of it.
    pub fn as_str(&self) -> &str {
        &self.0
    }
}
