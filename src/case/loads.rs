//! The loads of a phase: those on curves, and those that follow the surface of the material points.

use super::check::Checker;
use super::checked::{LoadField, LoadProfile, Numerics, Restore, Surface, SurfaceLoad, Traction};
use super::locate::{At, Path};
use super::raw;
use super::structure::suggest;
use crate::expression::Expression;
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
                (Some(curve), None) => {
                    tractions.push(Traction { entry: i, ..self.traction(curve, traction, file, numerics, &path) });
                }
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
        let at_point = traction.fx.is_some() || traction.fy.is_some();
        let of_elements = |kind| matches!(kind, raw::RegionKind::Fem | raw::RegionKind::Structure);
        let with_elements = file.regions.values().any(|region| of_elements(region.kind));
        // Whether the curve is one of finite elements, only the mesh can tell.
        if numerics.solver.restore != Restore::Never && !with_elements && !at_point {
            let problem = "a load on a curve needs finite elements, or a grid that moves with the material";
            let remedy = "load the `surface` of the soil in place of a curve, set `restore: never` under `numerics`, \
                or make the region beside it `kind: fem`";
            self.issue(&path.key("on"), At::Value, problem, remedy);
        }
        if at_point {
            return self.point_load(curve, traction, path);
        }
        let of_surfaces = [("shear", traction.shear.is_some()), ("where", traction.within.is_some())];
        for (key, _) in of_surfaces.iter().filter(|(_, there)| *there) {
            let remedy = "give `pressure`, `tx` and `ty`, or load a `surface` in place of a curve";
            self.issue(&path.key(key), At::Key, "a load on a curve does not have this", remedy);
        }
        if traction.tx.is_none() && traction.ty.is_none() && traction.pressure.is_none() {
            let remedy = "add `pressure: …`, `tx: …` or `ty: …` on a curve, `fx: …` or `fy: …` at a point";
            self.issue(path, At::Value, "there is no load", remedy);
        }
        let factor = self.factor(traction, path);
        let loads = [("tx", &traction.tx), ("ty", &traction.ty)];
        let fields = loads.map(|(key, load)| self.field(load.as_ref()?, &factor, &path.key(key)));
        let components = loads.map(|(key, load)| match load {
            Some(load @ (raw::Load::InTime(_) | raw::Load::Profile(_))) => {
                self.load_profile(load, &factor, false, &path.key(key))
            }
            _ => LoadProfile::uniform(TimeValue::Constant(0.0)),
        });
        let pressure = traction.pressure.as_ref();
        let pressure = pressure.map(|load| self.load_profile(load, &factor, true, &path.key("pressure")));
        Traction { entry: 0, curve: curve.to_owned(), force: None, components, fields, pressure }
    }

    /// A force at a point.
    fn point_load(&mut self, point: &str, traction: &raw::Traction, path: &Path) -> Traction {
        let others = [
            ("tx", traction.tx.is_some()),
            ("ty", traction.ty.is_some()),
            ("pressure", traction.pressure.is_some()),
            ("shear", traction.shear.is_some()),
            ("factor", traction.factor.is_some()),
            ("where", traction.within.is_some()),
        ];
        for (key, _) in others.iter().filter(|(_, there)| *there) {
            let remedy = "take it out here, or make two loads of it";
            self.issue(&path.key(key), At::Key, "a force at a point does not have this", remedy);
        }
        let force = [("fx", &traction.fx), ("fy", &traction.fy)];
        let force = force.map(|(key, value)| self.or_zero(value.as_ref(), &path.key(key)));
        let none = || LoadProfile::uniform(TimeValue::Constant(0.0));
        Traction {
            entry: 0,
            curve: point.to_owned(),
            force: Some(force),
            components: [none(), none()],
            fields: [None, None],
            pressure: None,
        }
    }

    /// The components of a load on the surface, which do not vary with depth.
    fn components(&mut self, traction: &raw::Traction, path: &Path) -> [TimeValue; 2] {
        [("tx", &traction.tx), ("ty", &traction.ty)].map(|(key, load)| match load {
            None => TimeValue::Constant(0.0),
            Some(raw::Load::InTime(value)) => self.in_time(value, &path.key(key)),
            Some(_) => {
                let remedy = "give a value in time, or vary the `pressure` with depth";
                let problem = "on a surface a traction in a fixed direction does not vary from place to place";
                self.issue(&path.key(key), At::Value, problem, remedy);
                TimeValue::Constant(0.0)
            }
        })
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
        for (key, _) in [("fx", &traction.fx), ("fy", &traction.fy)].iter().filter(|(_, value)| value.is_some()) {
            let remedy = "name a physical point with `on` in place of the surface, or give `tx` and `ty`";
            self.issue(&path.key(key), At::Key, "a force acts at a point", remedy);
        }
        let of = self.surface(surface, file, &path.key("surface"));
        let loads = [traction.tx.is_some(), traction.ty.is_some(), traction.shear.is_some()];
        let misplaced = traction.fx.is_some() || traction.fy.is_some();
        if !loads.contains(&true) && traction.pressure.is_none() && !misplaced {
            self.issue(path, At::Value, "there is no load", "add `pressure: …`, `shear: …`, `tx: …` or `ty: …`");
        }
        let factor = self.factor(traction, path);
        let pressure = traction.pressure.as_ref();
        SurfaceLoad {
            region: of.and_then(Surface::region),
            pressure: pressure.map(|load| self.load_profile(load, &factor, true, &path.key("pressure"))),
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

    /// A component of a load on a curve that is a formula or a table along the curve.
    fn field(&mut self, load: &raw::Load, factor: &TimeValue, path: &Path) -> Option<LoadField> {
        match load {
            raw::Load::InTime(_) | raw::Load::Profile(_) => None,
            raw::Load::Formula(text) => match Expression::parse(text) {
                Ok(formula) => Some(LoadField::Formula(formula)),
                Err(problem) => {
                    let remedy = "write a formula such as `-10*(1 + 0.1*x)*sin(2*pi*t)`";
                    self.issue(path, At::Value, format!("the formula has a mistake: {problem}"), remedy);
                    None
                }
            },
            raw::Load::Along(raw::Along { along, values }) => {
                if let Some(i) = values.windows(2).position(|pair| pair[1][0] <= pair[0][0]) {
                    let problem = format!("the coordinate {} does not come after {}", values[i + 1][0], values[i][0]);
                    let path = path.key("values").index(i + 1);
                    self.issue(&path, At::Value, problem, "sort the table by the coordinate, each once");
                }
                Some(LoadField::Along { axis: *along as usize, values: values.clone(), factor: factor.clone() })
            }
        }
    }

    /// The factor on the profiles and tables of a load.
    fn factor(&mut self, traction: &raw::Traction, path: &Path) -> TimeValue {
        let Some(factor) = &traction.factor else { return TimeValue::Constant(1.0) };
        let mut loads = [&traction.pressure, &traction.tx, &traction.ty].into_iter().flatten();
        if !loads.any(|load| matches!(load, raw::Load::Profile(_) | raw::Load::Along(_))) {
            let remedy = "let the load itself vary in time, or give it as {top, gradient, datum} or {along, values}";
            self.issue(
                &path.key("factor"),
                At::Key,
                "a factor is for a load that varies with depth or along a curve",
                remedy,
            );
        }
        self.in_time(factor, &path.key("factor"))
    }

    /// A load as the entry at `path` has it, a profile times `factor`; one that only `grows` has no negative gradient.
    fn load_profile(&mut self, load: &raw::Load, factor: &TimeValue, grows: bool, path: &Path) -> LoadProfile {
        let profile = match load {
            raw::Load::InTime(value) => return LoadProfile::uniform(self.in_time(value, path)),
            raw::Load::Profile(profile) => profile,
            raw::Load::Formula(_) | raw::Load::Along(_) => {
                let remedy = "give a value in time or {top, gradient, datum}, or `tx` and `ty` on a curve";
                self.issue(path, At::Value, "a pressure varies in time or with depth alone", remedy);
                return LoadProfile::uniform(TimeValue::Constant(0.0));
            }
        };
        if grows {
            self.profile_grows(profile, path);
        } else if profile.least.is_some() {
            let remedy = "take `least` out; a traction may have any sign";
            self.issue(&path.key("least"), At::Key, "a traction has no least value", remedy);
        }
        let [top, gradient] = [profile.top, profile.gradient].map(|value| factor.scaled(value));
        LoadProfile { top, gradient, datum: profile.datum }
    }
}

impl LoadProfile {
    fn uniform(top: TimeValue) -> Self {
        Self { top, gradient: TimeValue::Constant(0.0), datum: 0.0 }
    }
}
