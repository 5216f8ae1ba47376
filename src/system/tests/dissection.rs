//! Factors by halves against whole ones.

use super::super::dissection::Dissection;
use super::super::separator::{Parts, halve};
use super::super::whole::Whole;
use super::*;

/// Cells of `wide × high` squares beside each other from block `first` on, and where their nodes are from `x` on.
fn squares(first: u32, wide: u32, high: u32, x: f64, connectivity: &mut Vec<Vec<u32>>, places: &mut Vec<[f64; 2]>) {
    let node = |i: u32, j: u32| first + j * (wide + 1) + i;
    for (i, j) in (0..high).flat_map(|j| (0..wide).map(move |i| (i, j))) {
        connectivity.push(vec![node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)]);
    }
    for (i, j) in (0..=high).flat_map(|j| (0..=wide).map(move |i| (i, j))) {
        places.push([x + f64::from(i), f64::from(j) + 0.1 * f64::from(i)]);
    }
}

/// Definite matrices over the couplings, and of blocks of one equation the negative: a saddle. `skew` makes it unsymmetric.
fn system(sizes: &[u8], connectivity: &[Vec<u32>], symmetric: bool, skew: f64) -> (Pattern, Matrix) {
    let mut all = Connectivity::default();
    for coupling in connectivity {
        all.push(coupling.iter().copied());
    }
    let pattern = Pattern::new(sizes, all, symmetric);
    let mut matrix = Matrix::new(&pattern);
    for (k, coupling) in connectivity.iter().enumerate() {
        let size = pattern.coupling_size(k);
        let negative: Vec<bool> =
            coupling.iter().flat_map(|&b| vec![sizes[b as usize] == 1; sizes[b as usize].into()]).collect();
        let part = |i: usize, j: usize| ((k * 7 + i * 3 + j * 5) as f64).sin();
        let entry = |i: usize, j: usize| {
            if negative[i] && negative[j] {
                return if i == j { -0.5 } else { 0.0 };
            }
            let even = (0..4).map(|m| part(i, m) * part(j, m)).sum::<f64>() + if i == j { 0.3 } else { 0.0 };
            even + skew * ((i as f64) - (j as f64)).sin()
        };
        let local: Vec<f64> = (0..size * size).map(|n| entry(n / size, n % size)).collect();
        matrix.add(&pattern, k, &local, size);
    }
    (pattern, matrix)
}

/// Solves by halves and whole, on one thread and on two, and says how far apart the solutions are.
fn compare(pattern: &Pattern, matrix: &Matrix, places: &[[f64; 2]], llt: bool) {
    let b: Vec<f64> = (0..pattern.len()).map(|i| (0.7 * i as f64).cos()).collect();
    let mut whole = Whole::new(pattern).unwrap();
    let expected_pivot = whole.factorize(pattern, matrix, llt).unwrap();
    let mut expected = b.clone();
    whole.solve(&mut expected, llt);
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut halves = Dissection::new(pattern, places).unwrap().unwrap();
            let pivot = halves.factorize(matrix, llt).unwrap();
            let (mut x, mut again) = (b.clone(), b.clone());
            halves.solve(&mut x, llt);
            halves.solve(&mut again, llt);
            assert_eq!(x, again, "a solution leaves something behind");
            (x, pivot, halves.fill())
        })
    };
    let (x, pivot, fill) = run(1);
    assert_eq!((x.clone(), pivot, fill), run(2));
    let largest = expected.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    let apart = x.iter().zip(&expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(apart < 1e-11 * largest, "{apart:e} of {largest:e}");
    // What is left of an equation depends on the order, but not by orders of magnitude.
    assert!(pivot > 1e-2 * expected_pivot && pivot <= 1.0, "{pivot:e}, whole {expected_pivot:e}");
    assert!(fill > pattern.len() && fill < 2 * whole.fill(), "{fill}, whole {}", whole.fill());
}

/// No entry joins the halves; together they are all blocks.
fn check(pattern: &Pattern, parts: &Parts) {
    let [first, second] = &parts.halves;
    let joined = |&b: &u32| pattern.neighbours(b as usize).iter().any(|n| second.binary_search(n).is_ok());
    assert!(!first.iter().any(joined));
    let mut all = [&first[..], second, &parts.separator].concat();
    all.sort_unstable();
    assert!(all.iter().copied().eq(0..pattern.start.len() as u32 - 1));
}

#[test]
fn a_strip_is_cut_across() {
    let (mut connectivity, mut places) = (Vec::new(), Vec::new());
    squares(0, 40, 10, 0.0, &mut connectivity, &mut places);
    let (pattern, _) = system(&[2; 41 * 11], &connectivity, true, 0.0);
    let parts = halve(&pattern, &places).unwrap();
    check(&pattern, &parts);
    assert_eq!(parts.separator.len(), 11);
    assert!(parts.halves.iter().all(|half| half.len() == 20 * 11));
}

#[test]
fn definite_and_unsymmetric_systems_as_in_one_piece() {
    let (mut connectivity, mut places) = (Vec::new(), Vec::new());
    squares(0, 23, 17, 0.0, &mut connectivity, &mut places);
    for (symmetric, skew) in [(true, 0.0), (false, 0.2)] {
        let (pattern, matrix) = system(&vec![2; places.len()], &connectivity, symmetric, skew);
        compare(&pattern, &matrix, &places, true);
        compare(&pattern, &matrix, &places, false);
    }
}

/// Pressures in the cells, which are amid the nodes of theirs.
#[test]
fn saddles_as_in_one_piece() {
    let (mut connectivity, mut places) = (Vec::new(), Vec::new());
    squares(0, 23, 17, 0.0, &mut connectivity, &mut places);
    let mut sizes = vec![2; places.len()];
    for coupling in &mut connectivity {
        coupling.push(sizes.len() as u32);
        sizes.push(1);
    }
    let (pattern, matrix) = system(&sizes, &connectivity, true, 0.0);
    check(&pattern, &halve(&pattern, &places).unwrap());
    compare(&pattern, &matrix, &places, false);
}

/// Two bodies, of which the larger is cut, an equation on its own, one that all nodes of a side are coupled with and one
/// that is coupled with everything.
#[test]
fn bodies_apart_and_dense_rows_as_in_one_piece() {
    let (mut connectivity, mut places) = (Vec::new(), Vec::new());
    squares(0, 20, 20, 0.0, &mut connectivity, &mut places);
    squares(21 * 21, 12, 12, 25.0, &mut connectivity, &mut places);
    let nodes = places.len() as u32;
    connectivity.push(Vec::from_iter(0..21).into_iter().chain([nodes]).collect());
    connectivity.extend((0..nodes).map(|n| vec![n, nodes + 1]));
    places.extend([[10.0, -1.0], [-40.0, 0.0], [50.0, 3.0]]);
    let (pattern, matrix) = system(&vec![2; places.len()], &connectivity, true, 0.0);
    let mut matrix = matrix;
    (0..2).for_each(|d| matrix.add_diagonal(&pattern, 2 * (nodes as usize + 2) + d, 3.0));
    let parts = halve(&pattern, &places).unwrap();
    check(&pattern, &parts);
    assert!(parts.separator.contains(&(nodes + 1)), "{:?}", parts.separator);
    compare(&pattern, &matrix, &places, true);
    // Without what couples them the bodies are the halves, but for a line across the larger.
    connectivity.truncate(20 * 20 + 12 * 12);
    let (pattern, matrix) = system(&vec![2; nodes as usize], &connectivity, true, 0.0);
    let parts = halve(&pattern, &places[..nodes as usize]).unwrap();
    check(&pattern, &parts);
    assert_eq!(parts.separator.len(), 21);
    compare(&pattern, &matrix, &places[..nodes as usize], true);
}

#[test]
fn bodies_of_a_size_need_no_separator() {
    let (mut connectivity, mut places) = (Vec::new(), Vec::new());
    squares(0, 9, 9, 0.0, &mut connectivity, &mut places);
    squares(100, 9, 9, 20.0, &mut connectivity, &mut places);
    let (pattern, matrix) = system(&[2; 200], &connectivity, true, 0.0);
    let parts = halve(&pattern, &places).unwrap();
    check(&pattern, &parts);
    assert!(parts.separator.is_empty());
    compare(&pattern, &matrix, &places, true);
}

#[test]
fn what_cannot_be_halved_is_not() {
    let (mut connectivity, mut places) = (Vec::new(), Vec::new());
    squares(0, 20, 20, 0.0, &mut connectivity, &mut places);
    let (pattern, _) = system(&vec![2; places.len()], &connectivity, true, 0.0);
    assert_eq!(halve::<2>(&pattern, &[]), None, "no places");
    assert_eq!(halve(&pattern, &vec![[1.0, 2.0]; places.len()]), None, "all in one place");
    assert_eq!(halve(&pattern, &vec![[f64::NAN, f64::INFINITY]; places.len()]), None, "nowhere");
    let all = vec![Vec::from_iter(0..40)];
    let (pattern, _) = system(&[2; 40], &all, true, 0.0);
    assert_eq!(halve(&pattern, &places[..40]), None, "all coupled with all");
    let (pattern, _) = system(&[], &[], true, 0.0);
    assert_eq!(halve(&pattern, &places), None, "nothing");
}

/// One entry makes the matrix indefinite, in a half and in the separator.
#[test]
fn a_factor_that_breaks_down_says_so() {
    let (mut connectivity, mut places) = (Vec::new(), Vec::new());
    squares(0, 23, 17, 0.0, &mut connectivity, &mut places);
    let (pattern, mut matrix) = system(&vec![2; places.len()], &connectivity, true, 0.0);
    let separator = halve(&pattern, &places).unwrap().separator[3] as usize;
    for block in [0, separator] {
        matrix.add_diagonal(&pattern, 2 * block, -1e4);
        let mut halves = Dissection::new(&pattern, &places).unwrap().unwrap();
        assert_eq!(halves.factorize(&matrix, true), None);
        assert!(halves.factorize(&matrix, false).is_some());
        matrix.add_diagonal(&pattern, 2 * block, 1e4);
    }
}
