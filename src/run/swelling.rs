//! Soil whose volume has grown beyond what soil does: it dilates without end, or is torn apart.

use super::warning::WARNING;
use crate::step::{Scene, State};

/// The volume over that when seeded (-) beyond which it is told: the loosest sand has half as much again as the densest.
const MOST: f64 = 1.5;

/// Warnings after a step, one a region, at the point that has grown most.
pub fn found<const D: usize>(scene: &Scene<D>, state: &State<D>) -> Vec<String> {
    let mut most: Vec<(u16, f64, usize)> = Vec::new();
    for (p, deformation) in state.points.deformation.iter().enumerate() {
        let (ratio, region) = (deformation.determinant(), state.points.region[p]);
        if ratio <= MOST {
            continue;
        }
        match most.iter_mut().find(|of| of.0 == region) {
            Some(of) if ratio > of.1 => (of.1, of.2) = (ratio, p),
            Some(_) => {}
            None => most.push((region, ratio, p)),
        }
    }
    let phase = scene.phases.get(state.phase).map_or("", |phase| phase.name.as_str());
    // The volume of a region over that when seeded (-).
    let growth = |region: u16| {
        let own = (0..state.points.len()).filter(|&p| state.points.region[p] == region);
        let [now, first] = own
            .fold([0.0; 2], |[now, first], p| [now + state.points.volume(p), first + state.points.initial_volume[p]]);
        now / first
    };
    let warning = |(region, ratio, p): (u16, f64, usize)| {
        format!(
            "{WARNING}phase `{phase}`: soil of region `{}` has grown to {ratio:.2} times its volume near {:.3?} m, which no soil does, and to {:.2} times as a \
             whole: where it dilates give its material a `dilation_cutoff`; where it is torn apart its stress is meaningless, and it lands looser than it was",
            scene.mesh.regions[usize::from(region)],
            state.points.position[p],
            growth(region)
        )
    };
    most.into_iter().map(warning).collect()
}
