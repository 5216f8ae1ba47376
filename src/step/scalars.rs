//! The scalar unknowns of a grid: pressure field and pore pressure, numbered after the displacements.

use crate::dofs::Places;
use crate::mesh::Mesh;
use crate::system::Connectivity;

/// The scalar unknowns of a grid.
pub struct Scalars {
    /// Their places.
    pub places: Vec<u32>,
    /// The couplings of the nodes, extended by the scalar unknowns of the cells.
    pub connectivity: Connectivity,
}

impl Scalars {
    /// Numbers the unknowns of `families` after `nodes` blocks. `most` is the length of the array of scalar values, active or not.
    pub fn new<const D: usize>(
        families: &[Carrier<D>],
        nodes: usize,
        connectivity: &Connectivity,
        most: usize,
    ) -> Self {
        let mut block = vec![u32::MAX; most];
        let mut of_coupling: Vec<Option<(usize, u32)>> = vec![None; connectivity.len()];
        for (i, family) in families.iter().enumerate() {
            for c in family.cells() {
                of_coupling[family.coupling[c as usize] as usize] = Some((i, c));
                for unknown in family.unknowns(c) {
                    block[unknown as usize] = 0;
                }
            }
        }
        let mut places = Vec::new();
        for (unknown, block) in (0u32..).zip(&mut block).filter(|(_, b)| **b == 0) {
            *block = (nodes + places.len()) as u32;
            places.push(unknown);
        }
        let mut extended = Connectivity::default();
        for (k, of) in of_coupling.iter().enumerate() {
            let carriers = of.iter().flat_map(|&(i, c)| families[i].unknowns(c));
            extended.push_extended(connectivity, k, carriers.map(|unknown| block[unknown as usize]));
        }
        Self { places, connectivity: extended }
    }
}

/// A family of cells with scalar unknowns.
pub struct Carrier<'a, const D: usize> {
    pub mesh: &'a Mesh<D>,
    pub places: Places,
    /// Whether a cell has a pressure field, and water in its pores.
    pub with_pressure: Box<dyn Fn(u32) -> bool + 'a>,
    pub with_water: Box<dyn Fn(u32) -> bool + 'a>,
    pub coupling: &'a [u32],
}

impl<const D: usize> Carrier<'_, D> {
    fn cells(&self) -> impl Iterator<Item = u32> {
        (0..self.mesh.cells.len() as u32).filter(|&c| (self.with_pressure)(c) || (self.with_water)(c))
    }

    /// The scalar unknowns of a cell: of its pore pressure, of its pressure field.
    fn unknowns(&self, cell: u32) -> impl Iterator<Item = u32> {
        let pressure = (self.with_pressure)(cell).then(|| self.places.of_field(self.mesh, cell as usize));
        let of_pores = (self.with_water)(cell).then(|| self.places.of_pores(self.mesh, cell as usize));
        of_pores.into_iter().flatten().chain(pressure.into_iter().flatten())
    }
}
