//! What every term of the equations must be: its tangent the derivative of its residual, its forces those of
//! mechanics (balance, objectivity, resultants).
//!
//! The grids are jittered and the points lie anywhere in their cells, as after some steps of a run.

mod contact;
mod ghost;
mod internal;
mod loads;
mod pressure;
mod rigid;
mod water;
