//! Files: everything the program writes beside the mesh, and reads again.
//!
//! | file | module | for |
//! |---|---|---|
//! | `points.vtu` | [`points_vtu`] | the material points with their initial state, bit-exact and viewable |
//! | `results/frame-000123.mpmf` | [`frame`] | compact result frames, bit-exact |
//! | `phases/00-install.mpms` | [`phase_state`] | the state at the end of a phase, which another run may begin with |
//! | `checkpoints/step-000000456.mpmc` | [`checkpoint`] | what `--resume` continues from |
//! | `history.csv`, `energy.csv`, `solve.log` | [`history`] | one line a step, cut back on a resume |
//! | `table.csv` of a sweep | [`sweep_table`] | read again by `mpm plot` and `mpm report` |
//! | `unfinished/` | [`run_folder`] | a run beside earlier results, which it replaces when it is finished |
//! | `provenance/*.json` | [`provenance`] | what each stage was made from, by which program and command |
//! | `vtu/*.vtu`, `*.pvd` | [`export`], [`vtu`], [`pvd`] | the series for ParaView |
//!
//! Whole files are written beside their name and renamed into place ([`atomic`]), so that a kill leaves the
//! old file or the new one. The compact files share one [`container`]; slow writing happens in order on a
//! [`background`] thread.

pub mod atomic;
pub mod background;
pub mod checkpoint;
pub mod columns;
pub mod container;
pub mod export;
pub mod frame;
pub mod hash;
pub mod history;
pub mod lock;
pub mod phase_state;
pub mod points_vtu;
pub mod provenance;
pub mod pvd;
pub mod run_folder;
pub mod solve_log;
pub mod sweep_table;
pub mod table;
pub mod vtu;
