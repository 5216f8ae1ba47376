//! Material models: what each must satisfy as a point, and what soil made of it does in a run.

mod cavitation;
mod changes;
mod clay_column;
mod models;
mod mohr_coulomb;
mod spatial;
