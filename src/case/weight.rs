//! Whether what gravity acts on has weight.

use super::check::Checker;
use super::checked::Case;
use super::locate::{At, Path};
use super::{plates, raw};
use std::collections::HashSet;

impl Checker {
    /// Gravity must act on something, and an initial stress be that of soil with weight. Soil without weight under a
    /// heavy structure is an idealisation.
    pub(super) fn weight(&mut self, case: &Case, file: &raw::CaseFile) {
        // Water has a weight of its own.
        if case.gravity == [0.0; 2] || case.water.is_some() {
            return;
        }
        let plates: Vec<String> = file.regions.keys().map(|name| plates::material(name)).collect();
        let begun = file.regions.iter().zip(&plates).filter_map(|((name, region), of_plate)| {
            Some((name, region.material.as_ref().or(region.plate.as_ref().map(|_| of_plate))?))
        });
        let used: Vec<_> = begun.chain(file.phases.iter().flat_map(raw::Phase::assigned)).collect();
        let of = |wanted: fn(raw::RegionKind) -> bool| -> HashSet<&str> {
            let filled = used.iter().filter(|(name, _)| file.regions.get(*name).is_some_and(|r| wanted(r.kind)));
            filled.map(|(_, material)| material.as_str()).collect()
        };
        let soils = of(|kind| matches!(kind, raw::RegionKind::Mpm | raw::RegionKind::Fem));
        let all = of(|_| true);
        let nothing_weighs = !case.materials.iter().any(|m| m.has_mass() && all.contains(m.name.as_str()));
        let (wanted, problem) = match (nothing_weighs, case.k0.is_some()) {
            (true, _) => (all, "nothing has weight, so gravity does nothing"),
            (false, true) => (soils, "soil without weight has no stress at rest for k0"),
            (false, false) => return,
        };
        for material in case.materials.iter().filter(|m| !m.has_mass() && wanted.contains(m.name.as_str())) {
            let root = Path::default();
            let plate = case.named_plates().find(|(name, _)| plates::material(name) == material.name);
            let (path, key) = match plate {
                Some((name, _)) => (root.key("regions").key(name).key("plate"), "weight"),
                None => (root.key("materials").key(&material.name), "density"),
            };
            let remedy = format!("give it a `{key}` above 0, or take `gravity` and `initial_stress` out");
            self.issue(&path.key(key), At::Value, problem, remedy);
        }
    }
}
