//! Reproducible changes of files.

use mpm::io::container::Data;

/// SplitMix64 (Steele, Lea & Flood 2014).
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number below `count`; 0 below none.
    pub fn below(&mut self, count: usize) -> usize {
        if count == 0 { 0 } else { (self.next() % count as u64) as usize }
    }

    pub fn pick<'a, T>(&mut self, from: &'a [T]) -> &'a T {
        &from[self.below(from.len())]
    }
}

/// What a number in a text becomes.
const TOKENS: [&str; 22] = [
    "0",
    "-0",
    "1",
    "-1",
    "2",
    "1e308",
    "-1e308",
    "1e-320",
    "1e999",
    "NaN",
    ".nan",
    "inf",
    "-.inf",
    "255",
    "65535",
    "65536",
    "2147483648",
    "4294967295",
    "4294967296",
    "18446744073709551615",
    "1e9",
    "0x10",
];

/// What a number in an array becomes.
const NUMBERS: [f64; 16] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    1e-3,
    0.5,
    2.0,
    1e3,
    1e308,
    -1e308,
    1e-320,
    1e16,
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::MIN_POSITIVE,
];
const WHOLE: [u64; 14] =
    [0, 1, 2, 3, 7, 8, 100, 255, 65535, 0x7fff_ffff, 0xffff_fffe, 0xffff_ffff, u64::MAX >> 1, u64::MAX];

/// Changes some bytes; pieces may come from the files of the corpus.
pub fn bytes(random: &mut Random, file: &mut Vec<u8>, corpus: &[Vec<u8>]) {
    let other = random.below(corpus.len());
    for _ in 0..=random.below(3) {
        one(random, file, &corpus[other]);
    }
}

fn one(random: &mut Random, file: &mut Vec<u8>, other: &[u8]) {
    if file.is_empty() {
        file.extend_from_slice(other);
        return;
    }
    let at = random.below(file.len());
    let end = (at + 1 + random.below(64)).min(file.len());
    match random.below(10) {
        0 => file[at] ^= 1 << random.below(8),
        1 => {
            file[at] =
                *random.pick(&[0, 1, 0x7f, 0x80, 0xff, b'\n', b' ', b'-', b'"', b'{', b'[', b':', b'<', b'&', b'*'])
        }
        2 => digit(random, file, at),
        3 | 4 => number(random, file, at),
        5 => drop(file.drain(at..end)),
        6 => {
            let piece = file[at..end].to_vec();
            let to = random.below(file.len());
            drop(file.splice(to..to, piece));
        }
        7 => {
            let piece: Vec<u8> = (0..=random.below(8)).map(|_| random.next() as u8).collect();
            drop(file.splice(at..at, piece));
        }
        8 => file.truncate(at),
        _ => {
            let from = random.below(other.len());
            let to = (from + 1 + random.below(256)).min(other.len());
            drop(file.splice(at..end, other[from..to].to_vec()));
        }
    }
}

/// Changes a digit, the next one from `at` on.
fn digit(random: &mut Random, file: &mut [u8], at: usize) {
    if let Some(byte) = file[at..].iter_mut().find(|b| b.is_ascii_digit()) {
        *byte = b'0' + random.below(10) as u8;
    }
}

/// Puts another number in place of the next one from `at` on.
fn number(random: &mut Random, file: &mut Vec<u8>, at: usize) {
    let Some(first) = file[at..].iter().position(u8::is_ascii_digit).map(|i| at + i) else { return };
    let part_of = |b: &u8| b.is_ascii_digit() || matches!(b, b'.' | b'e' | b'E' | b'-' | b'+');
    let start = file[..first].iter().rposition(|b| !part_of(b)).map_or(0, |i| i + 1);
    let end = file[first..].iter().position(|b| !part_of(b)).map_or(file.len(), |i| first + i);
    drop(file.splice(start..end, random.pick(&TOKENS).bytes()));
}

/// Changes an array of tuples of `components` numbers.
pub fn array(random: &mut Random, data: &mut Data, components: usize) {
    let tuples = data.len() / components;
    let to = random.below(tuples + 1);
    match (random.below(10), &mut *data) {
        (0, data) => resize(data, to * components),
        (1, data) => resize(data, (tuples + 1 + random.below(3)) * components),
        (_, Data::F64(v)) => number_of(random, v, &NUMBERS),
        (_, Data::U64(v)) => number_of(random, v, &WHOLE),
        (_, Data::I64(v)) => number_of(random, v, &WHOLE.map(|n| n as i64)),
        (_, Data::U32(v)) => number_of(random, v, &WHOLE.map(|n| n as u32)),
        (_, Data::U16(v)) => number_of(random, v, &WHOLE.map(|n| n as u16)),
        (_, Data::U8(v)) => number_of(random, v, &[0, 1, 2, 255]),
    }
}

/// Gives a number another value, of `values` or from elsewhere in the array.
fn number_of<T: Copy>(random: &mut Random, numbers: &mut [T], values: &[T]) {
    if numbers.is_empty() {
        return;
    }
    let at = random.below(numbers.len());
    numbers[at] = if random.below(4) == 0 { *random.pick(numbers) } else { *random.pick(values) };
}

/// Cuts an array or repeats its last number.
pub fn resize(data: &mut Data, count: usize) {
    fn to<T: Copy + Default>(v: &mut Vec<T>, count: usize) {
        v.resize(count, v.last().copied().unwrap_or_default());
    }
    match data {
        Data::F64(v) => to(v, count),
        Data::U64(v) => to(v, count),
        Data::I64(v) => to(v, count),
        Data::U32(v) => to(v, count),
        Data::U16(v) => to(v, count),
        Data::U8(v) => to(v, count),
    }
}
