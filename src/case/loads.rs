//! The loads of a phase: dead ones on curves, and those that follow the surface of the material points.

use super::check::Checker;
use super::checked::{Numerics, Pressure, Restore, Surface, SurfaceLoad, Traction};
use super::locate::{At, Path};
use super::raw;
use super::structure::suggest;
use crate::time_value::TimeValue;

/// What names the surface of all material points.
const ALL: &str = "all";

impl Checker {
    /// The loads of a phase on curves and on the surface.
    pub(super) fn loads(
        &mut self,
        phase: &raw::Phase,
        file: &raw::CaseFile,
        numerics: &Numerics,
        path: &Path,
    ) -> (Vec<Traction>, Vec<SurfaceLoad>) {
        let (mut tractions, mut surface_loads) = (Vec::new(), Vec::new());
        for (i, traction) in phase.tractions.iter().enumerate() {
            let path = path.index(i);
            match (&traction.on, &traction.surface) {
                (Some(curve), None) => tractions.push(self.traction(curve, traction, file, numerics, &path)),
                (None, Some(surface)) => {
                    let load = self.surface_load(surface, traction, file, &path);
                    if numerics.solver.restore == Restore::Never && !load.is_pressure_all_around() {
                        let problem = "on a grid that is never restored the surface of the soil lies on curves";
                        let remedy = "load these with `on` in place of `surface`, or take `restore: never` out";
                        self.issue(&path.key("surface"), At::Key, problem, remedy);
                    }
                    surface_loads.push(load);
                }
                _ => {
                    let remedy = "name a physical curve with `on`, or a region of kind mpm or `all` with `surface`";
                    self.issue(&path, At::Value, "a load acts on a curve or on a surface, one of the two", remedy);
                }
            }
        }
        (tractions, surface_loads)
    }

    fn traction(
        &mut self,
        curve: &str,
        traction: &raw::Traction,
        file: &raw::CaseFile,
        numerics: &Numerics,
        path: &Path,
    ) -> Traction {
        let of_elements = |kind| matches!(kind, raw::RegionKind::Fem | raw::RegionKind::Structure);
        let with_elements = file.regions.values().any(|region| of_elements(region.kind));
        // Whether the curve is one of finite elements, only the mesh can tell.
        if numerics.solver.restore != Restore::Never && !with_elements {
            let problem = "a traction on a curve needs finite elements, or a grid that moves with the material";
            let remedy = "load the `surface` of the soil in place of a curve, set `restore: never` under `numerics`, \
                or make the region beside it `kind: fem`";
            self.issue(&path.key("on"), At::Value, problem, remedy);
        }
        let of_surfaces = [
            ("pressure", traction.pressure.is_some()),
            ("shear", traction.shear.is_some()),
            ("factor", traction.factor.is_some()),
            ("where", traction.within.is_some()),
        ];
        for (key, _) in of_surfaces.iter().filter(|(_, there)| *there) {
            let remedy = "give `tx` and `ty`, or load a `surface` in place of a curve";
            self.issue(&path.key(key), At::Key, "a load on a curve does not have this", remedy);
        }
        if traction.tx.is_none() && traction.ty.is_none() {
            self.issue(path, At::Value, "there is no load", "add `tx: …` or `ty: …`");
        }
        Traction { curve: curve.to_owned(), components: self.components(traction, path) }
    }

    fn components(&mut self, traction: &raw::Traction, path: &Path) -> [TimeValue; 2] {
        [("tx", &traction.tx), ("ty", &traction.ty)].map(|(key, value)| self.or_zero(value.as_ref(), &path.key(key)))
    }

    fn or_zero(&mut self, value: Option<&raw::InTime>, path: &Path) -> TimeValue {
        value.map_or(TimeValue::Constant(0.0), |value| self.in_time(value, path))
    }

    /// The surface of material points that the entry at `path` names, `all` or a region of kind mpm; `None` after a mistake.
    pub fn surface(&mut self, name: &str, file: &raw::CaseFile, path: &Path) -> Option<Surface> {
        if name == ALL {
            return Some(Surface::All);
        }
        let filled = |region: &raw::Region| region.kind == raw::RegionKind::Mpm;
        if let Some(region) = file.regions.iter().position(|(known, region)| known == name && filled(region)) {
            return Some(Surface::Of(region));
        }
        let known =
            file.regions.iter().filter(|(_, region)| filled(region)).map(|(name, _)| name.as_str()).chain([ALL]);
        self.issue(path, At::Value, format!("`{name}` is not a region of kind mpm"), suggest(name, known));
        None
    }

    fn surface_load(
        &mut self,
        surface: &str,
        traction: &raw::Traction,
        file: &raw::CaseFile,
        path: &Path,
    ) -> SurfaceLoad {
        let of = self.surface(surface, file, &path.key("surface"));
        let loads = [traction.tx.is_some(), traction.ty.is_some(), traction.shear.is_some()];
        if !loads.contains(&true) && traction.pressure.is_none() {
            self.issue(path, At::Value, "there is no load", "add `pressure: …`, `shear: …`, `tx: …` or `ty: …`");
        }
        SurfaceLoad {
            region: of.and_then(Surface::region),
            pressure: self.pressure(traction, path),
            shear: self.or_zero(traction.shear.as_ref(), &path.key("shear")),
            components: self.components(traction, path),
            within: traction.within.map(|window| {
                [("x", window.x), ("y", window.y)].map(|(key, range)| {
                    let Some([from, to]) = range else { return [f64::NEG_INFINITY, f64::INFINITY] };
                    if from >= to {
                        let problem = format!("the range from {from} to {to} is empty");
                        self.issue(&path.key("where").key(key), At::Value, problem, "give the smaller one first");
                    }
                    [from, to]
                })
            }),
        }
    }

    fn pressure(&mut self, traction: &raw::Traction, path: &Path) -> Option<Pressure> {
        let profile = matches!(traction.pressure, Some(raw::Load::Profile(_)));
        if traction.factor.is_some() && !profile {
            let remedy = "let `pressure` itself vary in time, or give it as {top, gradient, datum}";
            self.issue(&path.key("factor"), At::Key, "a factor is for a pressure that grows with depth", remedy);
        }
        match traction.pressure.as_ref()? {
            raw::Load::InTime(value) => Some(Pressure {
                top: self.in_time(value, &path.key("pressure")),
                gradient: TimeValue::Constant(0.0),
                datum: 0.0,
            }),
            raw::Load::Profile(profile) => {
                self.profile_grows(profile, &path.key("pressure"));
                let one = TimeValue::Constant(1.0);
                let factor = traction.factor.as_ref().map_or(one, |f| self.in_time(f, &path.key("factor")));
                let [top, gradient] = [profile.top, profile.gradient].map(|value| factor.scaled(value));
                Some(Pressure { top, gradient, datum: profile.datum })
            }
        }
    }
}
