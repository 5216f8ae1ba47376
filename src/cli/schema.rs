//! `mpm schema`: the JSON schema of `case.yaml`.

use super::print::{Outcome, print};
use crate::case::Keys;

pub fn run(keys: &Keys) -> Outcome {
    print(&format!("{:#}\n", keys.schema()))
}
