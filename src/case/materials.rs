//! The materials of a case: which entries a model needs, and its density from a unit weight.

use super::check::Checker;
use super::checked::{Law, Material};
use super::locate::{At, Path};
use super::raw;
use crate::material::Profile;

impl Checker {
    /// The checked material `name`; `gravity` [m/s²] turns a unit weight into a density.
    pub(super) fn material(
        &mut self,
        name: &str,
        material: &raw::Material,
        gravity: &[f64; 2],
        path: &Path,
    ) -> Material {
        let density = self.density(material, gravity, path);
        let young = self.in_depth(material.young, 0.0, true, &path.key("young"));
        Material { name: name.to_owned(), young, poisson: material.poisson, density, law: self.law(material, path) }
    }

    fn density(&mut self, material: &raw::Material, gravity: &[f64; 2], path: &Path) -> Profile {
        match (material.density, material.unit_weight) {
            (Some(density), None) => self.in_depth(density, 0.0, false, &path.key("density")),
            (None, Some(weight)) => {
                let path = path.key("unit_weight");
                let weight = self.in_depth(weight, 0.0, false, &path);
                let g = gravity[0].hypot(gravity[1]);
                if g == 0.0 {
                    let remedy = "set `gravity`, or give `density` in place of `unit_weight`";
                    self.issue(&path, At::Key, "a unit weight without gravity gives no density", remedy);
                    return Profile::constant(0.0);
                }
                Profile { top: weight.top / g, gradient: weight.gradient / g, datum: weight.datum }
            }
            (Some(_), Some(_)) => {
                let path = path.key("unit_weight");
                self.issue(&path, At::Key, "`density` and `unit_weight` are both given", "keep one of them");
                Profile::constant(0.0)
            }
            (None, None) => {
                let remedy = "add `density: …` [t/m³] or `unit_weight: …` [kN/m³]";
                self.issue(path, At::Key, "neither `density` nor `unit_weight` is given", remedy);
                Profile::constant(0.0)
            }
        }
    }

    fn law(&mut self, _material: &raw::Material, _path: &Path) -> Law {
        Law::LinearElastic
    }
}
