//! Time of a material point: model alone and with the spatial tangent, elastic and yielding, in ns.
//! `cargo bench --bench material`

use mpm::material::{MODELS, State, internal_count, spatial};
use std::hint::black_box;
use std::time::Instant;

/// Best time of one call (ns) over a few rounds through the inputs.
fn time<I, O>(inputs: &[I], mut call: impl FnMut(&I) -> O) -> f64 {
    (0..20)
        .map(|_| {
            let start = Instant::now();
            for input in inputs {
                black_box(call(black_box(input)));
            }
            start.elapsed().as_nanos() as f64 / inputs.len() as f64
        })
        .fold(f64::INFINITY, f64::min)
}

fn main() {
    println!("{:<16}{:>12}{:>12}{:>16}{:>16}", "", "elastic", "yielding", "plane elastic", "plane yielding");
    for kind in MODELS {
        let Ok(model) = (kind.build)(&kind.examples[0].iter().collect()) else { continue };
        let strength = (model.shear_strength(0.0, &State::default()) / model.young(0.0)).min(0.05);
        let strains = |size: f64| -> Vec<[f64; 3]> {
            let at = |n: usize, k: usize| size * strength * ((n * 7 + k * 3) as f64).sin();
            (0..20_000).map(|n| std::array::from_fn(|k| at(n, k))).collect()
        };
        let tensors = |size: f64| -> Vec<[f64; 6]> {
            strains(size).iter().map(|e| [1.0 + e[0], 1.0 + e[1], 1.0 + e[2], 0.5 * e[0], 0.0, 0.0]).collect()
        };
        let (state, law) = (State::default(), model.as_ref());
        let mut internal = vec![0.0; internal_count(&*model)];
        model.begin(0.0, &mut internal);
        print!("{:<16}", kind.name);
        for size in [0.05, 5.0] {
            print!("{:>12.1}", time(&strains(size), |e| law.respond(0.0, e, &state, &mut internal.clone())));
        }
        for size in [0.1, 5.0] {
            print!("{:>16.1}", time(&tensors(size), |b| spatial::plane(&*model, 0.0, b, &state, &mut internal)));
        }
        println!();
    }
}
