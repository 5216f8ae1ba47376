//! What a scheme of the material point method can be used on.

use super::check::Checker;
use super::checked::{self, Case, Content, Order, Phase, Restore, Source, Touching};
use super::layout::farthest;
use super::locate::{At, Path};
use super::parts::carries;
use crate::error::{Error, Result};
use crate::interpolation::Basis;
use crate::mesh::Mesh;
use crate::mesh::shape::CellKind;
use std::collections::HashSet;

impl Checker {
    /// Refuses cells of an order that the scheme does not support, and points of which no part of a cell can be the domain.
    pub(super) fn scheme(&mut self, case: &Case) {
        let basis = case.numerics.basis;
        if let Some(order) = case.mesh.order {
            self.order(case, order);
        }
        for region in case.regions.iter().filter(|_| basis.domain_size() > 0) {
            let Content::Mpm { points_per_cell, .. } = region.content else { continue };
            if points_per_cell.isqrt().pow(2) != points_per_cell {
                let path = Path::default().key("regions").key(&region.name).key("points_per_cell");
                let problem = format!(
                    "{} needs points that fill their cells, and {points_per_cell} are those of a quadrature rule",
                    basis.name()
                );
                self.issue(&path, At::Value, problem, "use 4, 9, 16 or 25, or choose `gradient: mpm`");
            }
        }
    }

    /// Refuses cells of an order that the scheme does not support.
    fn order(&mut self, case: &Case, order: Order) {
        let basis = case.numerics.basis;
        let (kinds, name, cure) = match order {
            Order::First => ([CellKind::T3, CellKind::Q4], "first order", "set `order: 2` under"),
            Order::Second => ([CellKind::T6, CellKind::Q9], "second order", "set `order: 1` under"),
            Order::SecondIncomplete if basis.takes(CellKind::Q9) => {
                ([CellKind::T6, CellKind::Q8], "second order without a centre node", "take `incomplete` out of")
            }
            Order::SecondIncomplete => ([CellKind::T6, CellKind::Q8], "second order", "set `order: 1` under"),
            Order::Third => ([CellKind::Q16; 2], "third order", "set `order: 2` under"),
        };
        if !kinds.iter().any(|&kind| basis.takes(kind)) {
            let problem = format!("{} does not support cells of {name}", basis.name());
            let other = if order == Order::Third { "bspline" } else { "mpm" };
            let remedy = format!("{cure} `mesh`, or choose `gradient: {other}`");
            self.issue(&Path::default().key("numerics").key("gradient"), At::Value, problem, remedy);
        }
        // The boundaries of structures and finite elements are those of cells of first and second order.
        for region in case.regions.iter().filter(|_| order == Order::Third) {
            if matches!(region.content, Content::Fem { .. } | Content::Structure { .. }) {
                let path = Path::default().key("regions").key(&region.name).key("kind");
                let problem = "cells of third order hold material points only, and no finite elements or structures";
                self.issue(&path, At::Value, problem, "set `order: 2` under `mesh`");
            }
        }
        if order == Order::Third && !case.contacts.is_empty() {
            let problem = "contact is with boundaries of cells of first and second order";
            self.issue(&Path::default().key("contacts"), At::Value, problem, "set `order: 2` under `mesh`");
        }
        let refused = |phase: &Phase| {
            let loaded = phase.surface_loads.iter().any(|load| !load.is_pressure_all_around());
            order == Order::Third && loaded
        };
        for (k, _) in case.own_phases().filter(|(_, phase)| refused(phase)) {
            let problem = "on cells of third order the only load on a surface is a `pressure` on `surface: all`";
            let path = Path::default().key("phases").index(k).key("tractions");
            self.issue(&path, At::Key, problem, "set `order: 2` under `mesh`");
        }
        let places = |phase: &Phase| order == Order::Third && phase.coming().next().is_some();
        for (k, _) in case.own_phases().filter(|(_, phase)| places(phase)) {
            let problem =
                "new soil needs the surface of the soil that is there, which is not followed on cells of third order";
            let path = Path::default().key("phases").index(k);
            self.issue(&path, At::Key, problem, "set `order: 2` under `mesh`");
        }
    }
}

/// Refuses a mesh that is given if its cells are of another order than the case has them.
///
/// # Errors
/// `Input`: one of another order, or of the third where the case does not say so.
pub fn check_order(wanted: &checked::Mesh, mesh: &Mesh<2>) -> Result<()> {
    let Source::Mesh(file) = &wanted.source else { return Ok(()) };
    let order = mesh.cells.kind.first().map_or(0, |kind| kind.order());
    let (fits, remedy) = match wanted.order {
        None => (order < 3, "set `order: 3` under `mesh`"),
        Some(Order::First) => (order == 1, "take `order` out of `mesh`"),
        Some(Order::Second) => (order == 2, "take `order` out of `mesh`"),
        Some(Order::SecondIncomplete) => {
            (order == 2 && !mesh.cells.kind.contains(&CellKind::Q9), "take `order` and `incomplete` out of `mesh`")
        }
        Some(Order::Third) => (order == 3, "take `order` out of `mesh`"),
    };
    let kind = mesh.cells.kind.first().map_or_else(String::new, |kind| format!(" ({kind:?})"));
    if fits {
        Ok(())
    } else {
        Err(Error::input(file.display(), format!("its cells are of order {order}{kind}"), remedy))
    }
}

/// Refuses a mesh of the grid, and one of finite elements, that a scheme does not support.
///
/// # Errors
/// `Input`: what it does not support.
pub(super) fn check(basis: &dyn Basis<2>, mesh: &Mesh<2>, fem: Option<&Mesh<2>>) -> Result<()> {
    let refuse = |problem: String, remedy: &str| {
        Err(Error::input("numerics.gradient", format!("{} {problem}", basis.name()), remedy))
    };
    if let Some([problem, remedy]) = basis.refusal(mesh) {
        return refuse(problem, &remedy);
    }
    if let Some(kind) = mesh.cells.kind.iter().find(|&&kind| !basis.takes(kind)) {
        let kinds: Vec<String> = [CellKind::T3, CellKind::T6, CellKind::Q4, CellKind::Q8, CellKind::Q9, CellKind::Q16]
            .iter()
            .filter(|&&kind| basis.takes(kind))
            .map(|kind| format!("{kind:?}"))
            .collect();
        let remedy = format!("mesh with {}, or choose `gradient: mpm`", kinds.join(" or "));
        return refuse(format!("does not support {kind:?} cells"), &remedy);
    }
    let of_grid: HashSet<u32> = mesh.cells.nodes.iter().copied().collect();
    if basis.wants_first_shape() && fem.is_some_and(|fem| fem.cells.nodes.iter().any(|n| of_grid.contains(n))) {
        let problem = "needs a grid that keeps its shape, and finite elements that share nodes with it change that";
        return refuse(
            problem.into(),
            "make the region `kind: mpm` or `kind: structure` (apart from the grid, with a contact), or choose `gradient: mpm`",
        );
    }
    Ok(())
}

/// How far (-) soil may move from a curve that stays in place, in cells: so much of the cells beside it is left.
const LEFT: f64 = 0.5;

/// Refuses to move a curve of a grid that is reset and that the scheme wants in its first shape: the soil on the curve would leave it.
///
/// # Errors
/// `Input`: the first such curve that moves farther than half a cell.
pub(super) fn check_moved_curves(case: &Case, grid: &Mesh<2>, fem: Option<&Mesh<2>>) -> Result<()> {
    let basis = case.numerics.basis;
    if !basis.wants_first_shape() || case.numerics.solver.restore == Restore::Never {
        return Ok(());
    }
    let is_wall = |curve: &str| case.contacts.iter().any(|c| c.structure == Touching::Wall(curve.to_owned()));
    let moved = case.phases.iter().flat_map(|phase| phase.prescribed.iter().map(move |moved| (phase, moved)));
    for (phase, moved) in moved.filter(|(_, moved)| moved.component < 2 && !is_wall(&moved.curve)) {
        let Some(curve) = grid.group(&moved.curve).filter(|curve| fem.is_none_or(|fem| !carries(fem, curve))) else {
            continue;
        };
        let beside = (0..grid.cells.len()).filter(|&c| grid.cells.nodes(c).iter().any(|n| curve.nodes.contains(n)));
        let length = |c: usize| {
            let along = grid.cells.corners(c).iter().map(|&n| grid.nodes[n as usize][moved.component]);
            let [low, high] = along.fold([f64::MAX, f64::MIN], |[low, high], x| [low.min(x), high.max(x)]);
            high - low
        };
        let Some(cell) = beside.map(length).reduce(f64::min) else { continue };
        let way = farthest(&moved.displacement, phase.duration);
        if way > LEFT * cell {
            return Err(Error::input(
                format!("the curve `{}` that phase `{}` moves", moved.curve, phase.name),
                format!(
                    "{} needs a grid that keeps its shape, and the soil would leave the curve: it moves by {way:.3} m, in cells of {cell:.3} m",
                    basis.name()
                ),
                "move the soil by a rigid structure with a contact, set `restore: never` under `numerics`, or choose `gradient: mpm`",
            ));
        }
    }
    Ok(())
}
