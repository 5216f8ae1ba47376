//! The internal variables of the models as columns of the frames.

use crate::io::frame::{Column, INTERNAL};
use crate::material::Model;
use crate::points::Points;
use std::sync::Arc;

/// An internal variable of one or more models.
#[derive(Clone, Debug)]
pub struct InternalVariable {
    name: String,
    unit: &'static str,
    components: usize,
    /// Where its numbers begin among those of a point, by number of the material; `None` for models without it.
    first: Vec<Option<usize>>,
}

impl InternalVariable {
    /// All of the models by number of the material; those of the same name, unit and kind are one.
    pub fn all(models: &[Option<Arc<dyn Model>>]) -> Vec<Self> {
        let mut all: Vec<Self> = Vec::new();
        for (number, model) in models.iter().enumerate() {
            let mut begin = 0;
            for variable in model.iter().flat_map(|model| model.internal_variables()) {
                let (name, unit, components) = (variable.name, variable.unit, variable.components());
                let known = all.iter().position(|v| (&*v.name, v.unit, v.components) == (name, unit, components));
                let known = known.unwrap_or_else(|| {
                    all.push(Self { name: name.to_owned(), unit, components, first: vec![None; models.len()] });
                    all.len() - 1
                });
                all[known].first[number] = Some(begin);
                begin += components;
            }
        }
        all
    }

    /// Its values; 0 where the model has it not.
    pub fn column<const D: usize>(&self, points: &Points<D>) -> Column {
        let mut values = vec![0.0; points.len() * self.components];
        for (p, values) in values.chunks_exact_mut(self.components).enumerate() {
            if let Some(first) = points.by_material(p, &self.first) {
                // Points that were given none of the models' variables have zeros.
                if let Some(own) = points.internal_of(p).get(*first..first + self.components) {
                    values.copy_from_slice(own);
                }
            }
        }
        Column::new(&format!("{INTERNAL}.{}", self.name), self.unit, self.components, values)
    }
}
