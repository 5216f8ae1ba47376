//! The method on whole problems: the solver against closed forms, and scenes and cases through the program.

mod axis;
mod balance;
mod bar;
mod boundary_projection;
mod bspline;
mod cantilever;
mod cases;
mod column;
mod curve_loads;
mod ddmp;
mod driven;
mod elements;
mod ending;
mod energy;
mod equilibrium;
mod everyday;
mod excavation;
mod fill;
mod flow;
mod footings;
mod ghost;
mod gravity;
mod incompressible;
mod invariance;
mod measured;
mod moved_curves;
mod obstacles;
pub mod patch;
mod phases;
mod plates;
mod point_loads;
mod random_scenes;
mod random_strength;
mod resampled;
mod rollers;
mod rotation;
mod scheme;
mod scripts;
mod shaken;
mod slivers;
mod slope;
mod split_footing;
mod springs;
mod surface;
mod surface_loads;
mod waves;

/// What takes more than some seconds; `make test-quick` leaves it out.
mod slow {
    mod bulldozing;
    mod collapse;
    mod cone_in_sand;
    mod cpt_sand;
    mod fast_flow;
    mod filled_silo;
    mod footing_on_sand;
    mod general_position;
    mod nearly_incompressible_sand;
    mod offshore;
    mod population;
    mod shovel;
    mod silo;
    mod slopes;
    mod splines;
    mod uniform_cells;
    mod voids;
}
