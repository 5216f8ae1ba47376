//! Which frames a command shows, and what of them.

use crate::error::{Error, Result};
use crate::io::frame::Info;

/// Numbers with commas between them.
fn numbers<const N: usize>(text: &str) -> std::result::Result<[f64; N], String> {
    let numbers: std::result::Result<Vec<f64>, _> = text.split(',').map(|number| number.trim().parse()).collect();
    let numbers = numbers.map_err(|e| e.to_string())?;
    let found: [f64; N] = numbers.try_into().map_err(|all: Vec<f64>| format!("{} numbers for {N}", all.len()))?;
    if found.iter().all(|v| v.is_finite()) { Ok(found) } else { Err("they must be finite".into()) }
}

fn growing<const N: usize>(found: [f64; N]) -> std::result::Result<[f64; N], String> {
    let grows = (0..N / 2).all(|d| found[d] < found[d + N / 2]);
    if grows { Ok(found) } else { Err("the second is not above the first".into()) }
}

/// `LOW,HIGH`.
pub fn range(text: &str) -> std::result::Result<[f64; 2], String> {
    growing(numbers(text)?)
}

/// `X0,Y0,X1,Y1` of a box: its lower left and its upper right corner.
pub fn box_of(text: &str) -> std::result::Result<[f64; 4], String> {
    growing(numbers(text)?)
}

/// `X0,Y0,X1,Y1` of the ends of a line.
pub fn ends(text: &str) -> std::result::Result<[f64; 4], String> {
    let found: [f64; 4] = numbers(text)?;
    if found[..2] == found[2..] { Err("the line has no length".into()) } else { Ok(found) }
}

/// A time with as many digits as one wants to read.
pub fn short(time: f64) -> String {
    let text = format!("{time:.6}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// The frames that are nearest to some times (s).
pub fn at(infos: &[Info], times: &[f64]) -> Result<Vec<usize>> {
    let nearest = |time: &f64| {
        let off = |i: &usize| (infos[*i].time - time).abs();
        (0..infos.len())
            .min_by(|a, b| off(a).total_cmp(&off(b)))
            .ok_or_else(|| Error::input("--time", format!("there is no frame at {time} s"), "run `mpm solve` first"))
    };
    times.iter().map(nearest).collect()
}

pub fn numbered(infos: &[Info], number: &str) -> Result<usize> {
    let last = infos.len() - 1;
    let found = if number == "last" { Some(last) } else { number.parse().ok().filter(|&i| i <= last) };
    found.ok_or_else(|| {
        Error::input(
            "--frame",
            format!("there is no frame {number}"),
            format!("it is `last`, or a number from 0 to {last}"),
        )
    })
}
