//! A cone that is pushed into sand, through the program.

use crate::support::{column, solve};
use std::fs;

/// Newton's method finds the equilibria on the way without cutting the steps down: with a ghost penalty of the elastic stiffness, which saturated at a
/// strain of 10⁻⁵ near the surface, they were halved twenty times over this way. The force is the same, 1.04 to 1.08 kN.
#[test]
fn sand_around_a_cone_flows_in_long_steps() {
    let folder = solve("tests/data/cone_in_sand", &[]);
    let log = fs::read_to_string(folder.path().join("solve.log")).unwrap();
    let halvings = log.matches("halved").count();
    assert!(halvings <= 4, "{halvings}");
    let force = column(folder.path(), "tip.contact_y [kN]").pop().unwrap();
    assert!((0.97..1.13).contains(&force), "{force} kN");
}
