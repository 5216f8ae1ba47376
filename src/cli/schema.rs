//! `mpm schema`: the JSON schema of `case.yaml`.

use super::print::{Outcome, print};
use crate::case;

pub fn run() -> Outcome {
    print(&format!("{:#}\n", case::schema()))
}
