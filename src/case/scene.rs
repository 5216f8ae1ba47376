//! From a checked case to a scene: the only place that decides which terms exist.

use super::checked::{Analysis, Case, Content, Geometry, LoadField, Material, Region, Restore, Touched};
use super::find::{filled, mean_size, region_index, regions};
use super::outputs::outputs;
use super::raw;
use super::rigid::{self, Holds};
use super::start::Start;
use super::{
    bars, changes, contact_interfaces, controls, curve_loads, drained_surface, inflow, layout, outflow, outputs, parts,
    placed, pores, removed, scheme, search, seeded, springs, staged, stops, ties, unconnected, unmeant, wall, water,
};
use crate::error::{Error, Result};
use crate::gravity::Gravity;
use crate::io::phase_state::End;
use crate::io::provenance::Origin;
use crate::io::run_folder::RunFolder;
use crate::kinematics::{Axisymmetric, Kinematics, PlaneStrain};
use crate::mesh::Mesh;
use crate::mesh::locate::Locator;
use crate::points::Points;
use crate::quadrature::{Bounded, Quadrature, Resampled, Volumes};
use crate::run::{self, Ended, First, Outputs, Progress, checkpoint};
use crate::step::{Fem, Phase, Scene, Search, State, overlap};
use crate::term::{
    Bar, Bars, BodyForce, Contact, EmptyCells, GhostInertia, GhostPenalty, Inertia, Internal, PoreStabilisation,
    PoreWater, PressureField, SmoothPressure, Spring, Springs, Term,
};
use crate::time_value::TimeValue;
use std::collections::BTreeSet;
use std::sync::atomic::AtomicBool;

/// γ (-) of the ghost penalty: 1e-3 … 1 give the same results to the error of the grid.
const GHOST: f64 = 0.1;
/// κ (-) of the ghost penalty in scenes without inertia. A bar pushed through clay needs it: with 0.02 it stops after three
/// diameters, and with the secant stiffness of scenes with inertia after one and a half. These cannot have it: a coarse block that should fail would be held by it.
const SATURATION: f64 = 0.1;

/// How a run begins, and what its files belong to.
#[derive(Default)]
pub struct Begin<'a> {
    pub origin: Origin,
    /// What the states at the ends of phases belong to, by number; none of those that are not kept.
    pub ends: Vec<Option<End>>,
    /// The run that it goes on from.
    pub start: Option<&'a Start>,
    /// Whether it continues from its newest checkpoint.
    pub resume: bool,
}

/// Solves a case in `folder`.
///
/// # Errors
/// As [`run::run`], and `Input` when the points do not belong to the mesh.
pub fn solve(
    case: &Case,
    mesh: Mesh<2>,
    points: Points<2>,
    folder: &RunFolder,
    begin: Begin,
    stop: &AtomicBool,
    progress: &mut dyn FnMut(Progress),
) -> Result<Ended> {
    check(case, &mesh, &points)?;
    let places = unconnected::places(&mesh);
    let warnings =
        [unconnected::structures(case, &places), unmeant::of_case(case, &places), unmeant::on_mesh(case, &mesh)?];
    let mut warnings = warnings.concat();
    warnings.extend(begin.start.map(Start::note));
    let parts = parts::points(case, &mesh, points);
    let scene = match case.geometry {
        Geometry::PlaneStrain => scene::<PlaneStrain>(case, mesh)?,
        Geometry::Axisymmetric => scene::<Axisymmetric>(case, mesh)?,
    };
    let outputs = outputs(case, &scene, folder, begin.origin, warnings)?;
    let first = begin.state(case, &scene, first(case, &scene, parts)?)?;
    let outputs = Outputs { ends: begin.ends, ..outputs };
    let run = match case.geometry {
        Geometry::PlaneStrain => run::run::<2, PlaneStrain>,
        Geometry::Axisymmetric => run::run::<2, Axisymmetric>,
    };
    run(&scene, first, &outputs, begin.resume, stop, progress)
}

/// Builds what a run has before its first step, and keeps nothing of it.
///
/// # Errors
/// As [`solve`] before the first step.
pub fn rehearse(case: &Case, mesh: Mesh<2>, points: Points<2>) -> Result<()> {
    check(case, &mesh, &points)?;
    let parts = parts::points(case, &mesh, points);
    let scene = match case.geometry {
        Geometry::PlaneStrain => scene::<PlaneStrain>(case, mesh)?,
        Geometry::Axisymmetric => scene::<Axisymmetric>(case, mesh)?,
    };
    outputs::watches(case, &scene)?;
    first(case, &scene, parts).map(drop)
}

fn check(case: &Case, mesh: &Mesh<2>, points: &Points<2>) -> Result<()> {
    seeded::check(case, mesh, points)?;
    layout::check_solving(mesh, points.len())
}

impl Begin<'_> {
    /// What the run begins with, given the state before the first step.
    fn state(&self, case: &Case, scene: &Scene<2>, seeded: State<2>) -> Result<First<2>> {
        let after = match self.start {
            Some(_) if !scene.loaded.is_empty() => {
                return Err(Error::input(
                    "start_from",
                    "a force acts at a point of soil, and the other run did not follow the soil that was there as it began",
                    "load a structure or finite elements, or put the phases into one case",
                ));
            }
            Some(start) => {
                let begun = start.begun + usize::from(case.equilibrium);
                Some(checkpoint::after_phase(start.read()?, scene, &seeded, begun)?)
            }
            None => None,
        };
        Ok(First { seeded, after })
    }
}

/// The state before the first step, given the material points and those of the finite elements ([`parts::points`]).
///
/// # Errors
/// `Input` when a point is not in its cell, or soil and a structure are in the same place.
pub fn first(case: &Case, scene: &Scene<2>, [mut points, mut fem]: [Points<2>; 2]) -> Result<State<2>> {
    seeded::check_places(&scene.mesh, &scene.locator, &points)?;
    let comes_later: Vec<bool> = scene.mesh.regions.iter().map(|name| case.comes_later(name)).collect();
    if comes_later.contains(&true) {
        let there = |&p: &usize| !comes_later[usize::from(points.region[p])];
        points = points.select(&(0..points.len()).filter(there).collect::<Vec<_>>());
    }
    overlap::at_first(scene, &points)?;
    if scene.has_pressure_field() {
        begin_pressure(case, &scene.mesh, &mut points)?;
        begin_pressure(case, &scene.mesh, &mut fem)?;
    }
    let models = changes::models(case, &scene.mesh)?;
    points.begin(&models);
    fem.begin(&models);
    let strengths = changes::random_strengths(case, &scene.mesh)?;
    points.vary(&strengths);
    fem.vary(&strengths);
    if scene.water.is_some() {
        // Without an initial pressure there is none.
        points.pore_pressure.resize(points.len(), 0.0);
        fem.pore_pressure.resize(fem.len(), 0.0);
    }
    let first_step = scene.phases.first().map_or(0.0, |p| p.step.initial);
    let fem_parametric = scene.fem.as_ref().map_or(Ok(Vec::new()), |part| parts::places(&part.mesh, &fem))?;
    let state = State::new(points, scene.displacements(), first_step);
    let mut state = State { fem, fem_parametric, time: scene.begins, ..state };
    state.begin_bars(scene);
    Ok(state)
}

/// Hands the pressure field its share: the points bring the elastic strain of all their stress.
fn begin_pressure(case: &Case, mesh: &Mesh<2>, points: &mut Points<2>) -> Result<()> {
    points.pressure = vec![0.0; points.len()];
    for (region, material) in filled(case) {
        let (Some(carried), region) = (&material.carried, region_index(mesh, &region.name)?) else { continue };
        for p in (0..points.len()).filter(|&p| points.region[p] == region) {
            points.pressure[p] = carried.begin(material.model.as_ref(), points, p);
        }
    }
    Ok(())
}

/// The scene of a case on its mesh.
///
/// # Errors
/// `Input` when the mesh lacks a group that the case names.
pub fn scene<K: Kinematics<2>>(case: &Case, mut whole: Mesh<2>) -> Result<Scene<2>> {
    let walls = wall::append(case, &mut whole)?;
    let bodies = rigid::bodies(case, &whole, walls)?;
    let structures = bodies.iter().filter(|body| !body.is_wall).count();
    let (mesh, fem) = parts::meshes(case, whole);
    let basis = case.numerics.basis;
    scheme::check(basis, &mesh, fem.as_ref())?;
    scheme::check_moved_curves(case, &mesh, fem.as_ref())?;
    let materials =
        || changes::used(case).filter(|(region, _)| !region.content.is_rigid()).map(|(_, material)| material);
    let heights = || mesh.nodes.iter().map(|x| x[1]);
    let (lowest, highest) = (heights().fold(f64::INFINITY, f64::min), heights().fold(f64::NEG_INFINITY, f64::max));
    // What varies with depth grows or falls.
    let most = |value: fn(&Material, f64) -> f64, m: &Material| value(m, lowest).max(value(m, highest));
    let largest = |value: fn(&Material, f64) -> f64| materials().map(|m| most(value, m)).fold(0.0, f64::max);
    // Structures do not tell how stiff the grid is where it is empty, nor its pressure.
    let soils =
        || changes::used(case).filter(|(region, _)| !region.content.is_structure()).map(|(_, material)| material);
    let of_soil = |value: fn(&Material, f64) -> f64| {
        // A scene may have nothing else.
        soils().map(|m| most(value, m)).reduce(f64::max).unwrap_or_else(|| largest(value))
    };
    let young = of_soil(|m, y| m.model.young(y));
    let stiffness_scale = largest(|m, y| {
        // What the pressure field carries does not come through a modulus.
        let moduli = m.carried.as_ref().map_or(&m.model, |c| &c.model).elasticity().at(y);
        moduli.lambda + 2.0 * moduli.shear
    });
    let density_scale = largest(|m, y| m.density.at(y));
    let dynamic = case.phases.iter().any(|p| p.analysis.has_inertia());
    let locator = Locator::new(&mesh);

    let shear = of_soil(|m, y| m.model.elasticity().at(y).shear);
    let size = fem.as_ref().map_or(mean_size(&mesh), |fem| mean_size(fem).max(mean_size(&mesh)));
    let pressure_unit = materials().any(|m| m.carried.is_some() || m.porous.is_some()).then(|| shear / size);
    let water = pores::water(case, &mesh)?;
    let mut terms = internal::<K>(case, &mesh, dynamic, pressure_unit, shear)?;
    if let (Some(water), Some(unit)) = (&water, pressure_unit) {
        terms.push(Box::new(PoreStabilisation::<K>::new(water.porous.clone(), unit, shear, mesh.cells.len())));
    }
    if let Some(drained) = drained_surface::term::<K>(case, &mesh, pressure_unit)? {
        terms.push(Box::new(drained));
    }
    if case.gravity != [0.0; 2] && density_scale > 0.0 {
        terms.push(Box::new(gravity::<K>(case)));
    }
    if case.numerics.solver.restore != Restore::Never {
        let [stiffness, density] =
            [young, of_soil(|m, y| m.density.at(y))].map(|of| case.numerics.empty_stiffness * of);
        terms.push(Box::new(EmptyCells::<K>::new(stiffness, mesh.cells.len()).of_density(density)));
        if case.numerics.quadrature != raw::Quadrature::Points {
            let models = self::models(case, &mesh)?;
            let penalty = GhostPenalty::<K>::new(GHOST, models, locator.faces.inner.len());
            terms.push(Box::new(if dynamic { penalty } else { penalty.saturating(SATURATION) }));
        }
        if dynamic && density_scale > 0.0 {
            terms.push(Box::new(GhostInertia::<K>::new(density_scale, locator.faces.inner.len())));
        }
    }
    if dynamic {
        terms.push(Box::new(Inertia::<K>::default()));
    }
    terms.extend(water::terms::<K>(case, &mesh, size)?);
    let [on_grid, on_elements] = curve_loads::terms::<K>(case, (&mesh, fem.as_ref()), &bodies[..structures])?;
    terms.extend(on_grid);

    let bars: std::sync::Arc<[Bar<2>]> = bars::bars(case, &mesh, fem.as_ref())?.into();
    let fem = match fem {
        Some(part) => {
            let mut terms = internal::<K>(case, &part, dynamic, pressure_unit, shear)?;
            let deforms = |region: &Region| region.content.is_fem() && !region.content.is_rigid();
            let heavy = changes::used(case).any(|(region, m)| deforms(region) && m.has_mass());
            if case.gravity != [0.0; 2] && heavy {
                terms.push(Box::new(gravity::<K>(case)));
            }
            if dynamic {
                terms.push(Box::new(Inertia::<K>::default()));
            }
            terms.extend(water::on_elements::<K>(case, &part, size));
            terms.extend(on_elements);
            if !bars.is_empty() {
                terms.push(Box::new(Bars(bars.clone())));
            }
            terms.extend(rigid::terms::<K>(case, &part, &bodies[..structures], dynamic, size));
            for structure in bodies[..structures].iter().zip(0..) {
                terms.extend(curve_loads::on_rigid::<K>(case, &part, structure)?);
            }
            let carried = changes::ever(case, &part, |m| m.carried.is_some())?;
            let rigid = regions(case, &part, Content::is_rigid);
            let with = |r: usize| carried[r] && !rigid[r];
            let with_pressure = part.cells.region.iter().map(|&r| with(r as usize)).collect();
            let porous = pores::porous(case, &part)?;
            let with_water =
                part.cells.region.iter().map(|&r| porous[r as usize].is_some() && !rigid[r as usize]).collect();
            Some(Fem { mesh: part, rigid, with_pressure, with_water, terms })
        }
        None => None,
    };
    let of_structures = fem.as_ref().map_or(&mesh, |fem| &fem.mesh);
    let ties = ties::ties(case, (&mesh, fem.as_ref().map(|fem| &fem.mesh)))?;
    let springs: std::sync::Arc<[Spring<2>]> = springs::springs::<K>(case, [&mesh, of_structures], &ties)?.into();
    if !springs.is_empty() {
        terms.push(Box::new(Springs(springs.clone())));
    }
    let levels = case.water.as_ref().and_then(|water| water.levels(size));
    let interfaces =
        contact_interfaces::interfaces::<K>(case, &mesh, fem.as_ref().map_or(&mesh, |fem| &fem.mesh), &bodies)?;
    for (number, interface) in (0..).zip(&interfaces) {
        terms.push(Box::new(Contact::new(number, interface.sides().laws.clone(), levels.clone())));
    }
    let carried = changes::carried(case, &mesh)?;
    let holds = Holds::new(case, &mesh, &bodies);
    let (supports, free) = (holds.supports()?, springs::held(case, &mesh, &springs, &ties)?);
    let search = search::search(case, &mesh, fem.as_ref().map(|fem| &fem.mesh))?;
    let staged = |(number, p)| {
        let mut held = staged::held(case, &mesh, of_structures, &bodies, p)?;
        held.extend(free.iter().filter(|_| !p.analysis.has_inertia()).cloned());
        let changes = changes::of_phase(case, [&mesh, of_structures], number)?;
        Ok(Phase { held, changes, ..phase(case, &holds, number, p, search.as_ref())? })
    };
    let phases = case.phases.iter().enumerate().map(staged).collect::<Result<_>>()?;
    let removals = (0..case.phases.len()).map(|number| removed::of_phase::<K>(case, &mesh, number)).collect();
    let placements = (0..case.phases.len()).map(|number| placed::of_phase::<K>(case, &mesh, number));
    let placements = placements.collect::<Result<_>>()?;
    let elements = fem.as_ref().map(|fem| &fem.mesh);
    let loaded = curve_loads::loaded_nodes(case, &mesh, elements);
    let traced = outputs::traced(case, &mesh, elements);
    let sprung = springs::followed(case, elements, &springs);
    let traced =
        traced.into_iter().chain(loaded.iter().copied()).chain(sprung).collect::<BTreeSet<u32>>().into_iter().collect();
    let outflows = outflow::outflows(case, (&mesh, &locator), elements)?;
    let inflows = inflow::inflows(case, (&mesh, &locator), elements)?;
    let scene = Scene {
        locator,
        quadrature: quadrature::<K>(case, &mesh)?,
        mesh,
        terms,
        fem,
        bodies,
        bars,
        interfaces,
        levels,
        pressure_unit,
        carried,
        water,
        supports,
        absorbing: free,
        springs,
        ties,
        begins: if case.equilibrium { -case.phases[0].duration } else { 0.0 },
        phases,
        removals,
        placements,
        outflows,
        inflows,
        traced,
        loaded: loaded.into_iter().collect(),
        basis,
        numerics: case.numerics.solver.clone(),
        gravity: case.gravity,
        strongest_gravity: strongest_gravity(case),
        stiffness_scale,
        density_scale,
    };
    controls::of_displacements(&scene)?;
    Ok(scene)
}

/// The terms of the stress in the cells of `mesh`.
fn internal<K: Kinematics<2>>(
    case: &Case,
    mesh: &Mesh<2>,
    dynamic: bool,
    pressure_unit: Option<f64>,
    shear: f64,
) -> Result<Vec<Box<dyn Term<2>>>> {
    let models = models(case, mesh)?;
    let kept = changes::of_structures(case, mesh);
    let Some(unit) = pressure_unit else {
        return Ok(vec![Box::new(Internal::<K>::new(models, dynamic).keeping(&kept))]);
    };
    let carried = changes::carried(case, mesh)?;
    let carries = carried.iter().map(Option::is_some).collect();
    let field = PressureField::<K>::new(carried, unit);
    let bond = SmoothPressure::<K>::new(carries, unit, shear, mesh.cells.len());
    let porous = pores::porous(case, mesh)?;
    let with_water = porous.iter().any(Option::is_some);
    let water = PoreWater::<K>::new(porous, unit);
    Ok(match (with_water, changes::used(case).any(|(_, m)| m.carried.is_some())) {
        (false, _) => vec![Box::new(Internal::<K, _>::sharing(models, dynamic, field).keeping(&kept)), Box::new(bond)],
        (true, false) => vec![Box::new(Internal::<K, _>::sharing(models, dynamic, water).keeping(&kept))],
        (true, true) => {
            vec![Box::new(Internal::<K, _>::sharing(models, dynamic, (field, water)).keeping(&kept)), Box::new(bond)]
        }
    })
}

fn gravity<K>(case: &Case) -> BodyForce<K, 2> {
    BodyForce::new(case.phases.iter().map(|p| p.gravity.clone()).collect())
}

/// The largest acceleration of gravity (m/s²): that of the case, or of a phase with components of its own.
fn strongest_gravity(case: &Case) -> f64 {
    let own = case.phases.iter().filter(|phase| matches!(phase.gravity, Gravity::Components(_)));
    let accelerations = own.flat_map(|phase| phase.gravity.extremes(phase.duration)).chain([case.gravity]);
    accelerations.map(|[x, y]| x.hypot(y)).fold(0.0, f64::max)
}

fn quadrature<K: Kinematics<2>>(case: &Case, mesh: &Mesh<2>) -> Result<Box<dyn Quadrature<2>>> {
    let bounded = water::needs_surface(case);
    // Contact measures gaps to the followed surface, which resampled quadrature has in any case.
    let touched = case.contacts.iter().any(|contact| matches!(contact.on, Touched::Soil(_)));
    Ok(match (case.numerics.quadrature, bounded || touched) {
        (raw::Quadrature::Resampled, _) => {
            let resampled = Resampled::<K>::new(mesh, models(case, mesh)?, bounded);
            Box::new(
                resampled
                    .renewing(seeded::points_per_cell(case, mesh)?)
                    .varying(changes::random_strengths(case, mesh)?),
            )
        }
        (raw::Quadrature::Points, true) => Box::new(Bounded::<K>::new(mesh)),
        (raw::Quadrature::Points, false) => Box::new(Volumes::<K>::default()),
    })
}

fn phase(
    case: &Case,
    holds: &Holds,
    number: usize,
    phase: &super::checked::Phase,
    search: Option<&Search>,
) -> Result<Phase> {
    let loads: Vec<&TimeValue> = phase
        .tractions
        .iter()
        .flat_map(|t| t.values())
        .chain(water::values(case, number, phase))
        .chain(phase.gravity.values())
        .chain(&phase.reduction)
        .collect();
    let by_formula = phase.tractions.iter().flat_map(|t| t.fields.iter().flatten()).any(LoadField::is_formula_in_time);
    let values = phase.prescribed.iter().map(|p| &p.displacement).chain(loads.iter().copied());
    let inflows = phase.inflows.iter().map(|inflow| &inflow.velocity);
    let every = case.output.every.filter(|_| !(case.equilibrium && number == 0));
    Ok(Phase {
        name: phase.name.clone(),
        dynamic: phase.analysis == Analysis::Dynamic,
        auto: phase.analysis == Analysis::Auto,
        flows: pores::flows(case, phase),
        duration: phase.duration,
        step: phase.step,
        prescribed: holds.prescribed(phase)?,
        loads_change: by_formula || loads.iter().any(|value| !matches!(value, TimeValue::Constant(_))),
        by_formula,
        reduction: phase.reduction.clone(),
        search: search.filter(|_| phase.analysis == Analysis::StrengthReduction).cloned(),
        held: Vec::new(),
        changes: Vec::new(),
        apart: staged::apart(case, phase),
        reset_displacements: phase.reset_displacements,
        stops: stops::of(phase.duration, every, values.chain(inflows).flat_map(TimeValue::kinks)),
    })
}

/// The model of each material by number.
fn models(case: &Case, mesh: &Mesh<2>) -> Result<Vec<Option<std::sync::Arc<dyn crate::material::Model>>>> {
    let model = |m: &Material| Some(m.carried.as_ref().map_or(&m.model, |carried| &carried.model).clone());
    changes::by_number(case, mesh, model)
}
