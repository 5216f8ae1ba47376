//! Ranges of numbers in a script, `{1:10}` or `{0:1:0.1}`, which Gmsh makes a list of or repeats a loop for.

use super::token::{Kind, Token};

/// The most numbers of a range: far more than a geometry can use.
const MOST: f64 = 1e7;

/// The line and the count of numbers of the first range that is too long. What is computed, only the limits of the process stop.
pub fn too_long(tokens: &[Token]) -> Option<(usize, f64)> {
    (0..tokens.len()).find_map(|i| {
        if !matches!(tokens[i].kind, Kind::Symbol(b'{' | b'(' | b'[' | b',')) {
            return None;
        }
        let (first, next) = number(tokens, i + 1)?;
        let (last, next) = number(tokens, colon(tokens, next)?)?;
        let (step, next) = match colon(tokens, next) {
            Some(next) => number(tokens, next)?,
            None => (1.0, next),
        };
        let ends = matches!(tokens.get(next)?.kind, Kind::Symbol(b'}' | b')' | b']' | b','));
        let count = ((last - first) / step).abs();
        (ends && count > MOST).then_some((tokens[i].line, count))
    })
}

/// The number at `i`, with its sign, and where it ends.
fn number(tokens: &[Token], i: usize) -> Option<(f64, usize)> {
    match (tokens.get(i)?.kind, tokens.get(i + 1).map(|token| token.kind)) {
        (Kind::Number(text), _) => Some((value(text)?, i + 1)),
        (Kind::Symbol(b'-'), Some(Kind::Number(text))) => Some((-value(text)?, i + 2)),
        _ => None,
    }
}

fn value(text: &[u8]) -> Option<f64> {
    std::str::from_utf8(text).ok()?.parse().ok()
}

fn colon(tokens: &[Token], i: usize) -> Option<usize> {
    (tokens.get(i)?.kind == Kind::Symbol(b':')).then_some(i + 1)
}
