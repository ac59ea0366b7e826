//! Arrays in VTK XML files: compressed blocks, base64-coded, in the place of their element.

use base64::engine::general_purpose::STANDARD;
use base64::Engine;
use miniz_oxide::deflate::compress_to_vec_zlib;

/// Bytes of an array that are compressed as one; a reader holds one block at a time.
const BLOCK: usize = 1 << 18;

/// zlib's usual trade of speed for size.
const LEVEL: u8 = 6;

/// Appends an array's text to `xml`: the header (number of blocks, block size, size of the last block if
/// partial, compressed sizes; UInt64 each) is a base64 run of its own, the blocks together are another.
pub fn push(xml: &mut String, bytes: &[u8]) {
    let blocks: Vec<Vec<u8>> = bytes.chunks(BLOCK).map(|b| compress_to_vec_zlib(b, LEVEL)).collect();
    let mut header: Vec<u64> = vec![blocks.len() as u64, BLOCK as u64, (bytes.len() % BLOCK) as u64];
    header.extend(blocks.iter().map(|b| b.len() as u64));
    let header: Vec<u8> = header.into_iter().flat_map(u64::to_le_bytes).collect();
    STANDARD.encode_string(header, xml);
    STANDARD.encode_string(blocks.concat(), xml);
}
