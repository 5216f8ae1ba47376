//! Arrays as compressed blocks of bytes; the layout is described in the parent module.

use super::data::Scalar;

/// Most bytes of a block before compression, unless a single tuple is longer.
const BLOCK: usize = 1 << 18;
/// The bit of a block's length that says that it is not compressed.
const UNCOMPRESSED: u32 = 1 << 31;
/// LZ4 cannot compress further than this.
const MAX_RATIO: usize = 256;

/// Compresses arrays one after the other, in the same memory.
#[derive(Default)]
pub(super) struct Compressor {
    plain: Vec<u8>,
    sorted: Vec<u8>,
    packed: Vec<u8>,
}

impl Compressor {
    /// Appends the blocks of an array to `out`.
    pub(super) fn compress<T: Scalar>(&mut self, values: &[T], components: usize, out: &mut Vec<u8>) {
        let stride = components * T::SIZE;
        let per_block = (BLOCK / stride).max(1) * components;
        for block in values.chunks(per_block) {
            let bytes = block.len() * T::SIZE;
            let plain = room(&mut self.plain, bytes);
            for (bytes, v) in plain.chunks_exact_mut(T::SIZE).zip(block) {
                v.store(bytes);
            }
            let sorted = room(&mut self.sorted, bytes);
            let tuples = block.len() / components;
            for (j, lane) in sorted.chunks_exact_mut(tuples).enumerate() {
                for (byte, tuple) in lane.iter_mut().zip(plain.chunks_exact(stride)) {
                    *byte = tuple[j];
                }
            }
            let packed = room(&mut self.packed, lz4_flex::block::get_maximum_output_size(bytes));
            match lz4_flex::block::compress_into(sorted, packed) {
                Ok(n) if n < bytes => {
                    out.extend_from_slice(&(n as u32).to_le_bytes());
                    out.extend_from_slice(&packed[..n]);
                }
                _ => {
                    out.extend_from_slice(&(bytes as u32 | UNCOMPRESSED).to_le_bytes());
                    out.extend_from_slice(sorted);
                }
            }
        }
    }
}

/// The first `length` bytes of a buffer, which grows where it is shorter.
fn room(buffer: &mut Vec<u8>, length: usize) -> &mut [u8] {
    if buffer.len() < length {
        buffer.resize(length, 0);
    }
    &mut buffer[..length]
}

/// The numbers of an array from its stored bytes, if they are whole.
pub(super) fn decompress<T: Scalar>(stored: &[u8], components: usize, count: usize) -> Option<Vec<T>> {
    let stride = components * T::SIZE;
    let per_block = (BLOCK / stride).max(1) * components;
    if !count.is_multiple_of(components) || count.checked_mul(T::SIZE)? > stored.len().saturating_mul(MAX_RATIO) {
        return None;
    }
    let mut values = Vec::with_capacity(count);
    let mut rest = stored;
    let mut sorted = Vec::new();
    while values.len() < count {
        let numbers = per_block.min(count - values.len());
        let (length, after) = rest.split_at_checked(4)?;
        let length = <u32 as Scalar>::load(length);
        let (block, after) = after.split_at_checked((length & !UNCOMPRESSED) as usize)?;
        rest = after;
        sorted.resize(numbers * T::SIZE, 0);
        if length & UNCOMPRESSED != 0 {
            if block.len() != sorted.len() {
                return None;
            }
            sorted.copy_from_slice(block);
        } else if lz4_flex::block::decompress_into(block, &mut sorted).ok()? != sorted.len() {
            return None;
        }
        let tuples = numbers / components;
        let mut number = [0; 8];
        for i in 0..numbers {
            let (tuple, first) = (i / components, i % components * T::SIZE);
            for (k, byte) in number[..T::SIZE].iter_mut().enumerate() {
                *byte = sorted[(first + k) * tuples + tuple];
            }
            values.push(T::load(&number[..T::SIZE]));
        }
    }
    rest.is_empty().then_some(values)
}
