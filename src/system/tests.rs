//! Assembly against dense sums, solutions against known ones.

use super::*;

mod dissection;

/// A chain of blocks with mixed sizes and three couplings, one of them unordered.
fn chain(symmetric: bool) -> Pattern {
    let mut connectivity = Connectivity::default();
    connectivity.push([2, 0, 1]);
    connectivity.push([1, 3]);
    connectivity.push([3, 4, 2]);
    Pattern::new(&[2, 1, 2, 3, 2], connectivity, symmetric)
}

/// A reproducible dense matrix of coupling `k`, diagonally dominant, with unsymmetric part `skew`.
fn local(k: usize, size: usize, skew: f64) -> Vec<f64> {
    let entry = |i: usize, j: usize| {
        let (a, b) = (i.min(j), i.max(j));
        let even = ((k * 31 + a * 7 + b * 3) as f64).sin();
        let odd = skew * ((k + 5 * a + b) as f64).cos();
        if i == j { 10.0 } else { even + if i < j { odd } else { -odd } }
    };
    (0..size * size).map(|n| entry(n / size, n % size)).collect()
}

fn assemble(pattern: &Pattern, skew: f64) -> (Matrix, Vec<Vec<f64>>, Vec<f64>) {
    let n = pattern.len();
    let mut dense = vec![vec![0.0; n]; n];
    let mut vector_expected = vec![0.0; n];
    for k in 0..pattern.connectivity.len() {
        let equations: Vec<usize> = pattern
            .connectivity
            .blocks(k)
            .iter()
            .flat_map(|&b| pattern.start[b as usize] as usize..pattern.start[b as usize + 1] as usize)
            .collect();
        let values = local(k, equations.len(), skew);
        for (a, &i) in equations.iter().enumerate() {
            vector_expected[i] += a as f64 + 1.0;
            for (b, &j) in equations.iter().enumerate() {
                dense[i][j] += values[a * equations.len() + b];
            }
        }
    }
    let mut matrix = Matrix::new(pattern);
    let mut vector = vec![0.0; n];
    let items: Vec<usize> = (0..pattern.connectivity.len()).collect();
    scatter(
        pattern,
        &items,
        |&k| k,
        |&k, out| {
            out.matrix.copy_from_slice(&local(k, out.size, skew));
            for (a, v) in out.vector.iter_mut().enumerate() {
                *v = a as f64 + 1.0;
            }
            Ok(())
        },
        &mut vector,
        Some(&mut matrix),
        &mut Workspace::default(),
    )
    .unwrap();
    assert_eq!(vector, vector_expected);
    (matrix, dense, vector)
}

fn check_solution(symmetric: bool, skew: f64, shift: f64, expected: Method) {
    let pattern = chain(symmetric);
    let (mut matrix, mut dense, _) = assemble(&pattern, skew);
    let n = pattern.len();
    // Shifting the diagonal makes the matrix indefinite.
    for j in 0..n {
        for k in pattern.column[j] as usize..pattern.column[j + 1] as usize {
            if pattern.row[k] as usize == j {
                matrix.values[k] += shift * if j % 2 == 0 { 1.0 } else { 0.0 };
            }
        }
        dense[j][j] += shift * if j % 2 == 0 { 1.0 } else { 0.0 };
    }
    let exact: Vec<f64> = (0..n).map(|i| (i as f64 + 0.3).sin()).collect();
    let mut x: Vec<f64> = (0..n).map(|i| (0..n).map(|j| dense[i][j] * exact[j]).sum()).collect();
    let mut product = vec![0.0; n];
    matrix.multiply(&pattern, &exact, &mut product);
    for (a, b) in x.iter().zip(&product) {
        assert!((a - b).abs() < 1e-12, "multiply: {a} against {b}");
    }
    let b = x.clone();
    let mut solver = Solver::new::<2>(&pattern, &[]).unwrap();
    assert_eq!(solver.solve(&pattern, &matrix, &mut x).unwrap(), expected);
    // GMRES ends at a given residual; the error that it leaves depends on the condition of the matrix.
    let (residual, error) = if expected == Method::Iterative { (1e-9, 1e-9) } else { (1e-12, 1e-10) };
    matrix.multiply(&pattern, &x, &mut product);
    let square = |a: &[f64]| a.iter().map(|v| v * v).sum::<f64>();
    let rest: Vec<f64> = b.iter().zip(&product).map(|(b, ax)| b - ax).collect();
    assert!(square(&rest) <= residual * residual * square(&b), "{:e}", square(&rest).sqrt());
    for (a, b) in x.iter().zip(&exact) {
        assert!((a - b).abs() < error, "{a} against {b}");
    }
    // Where less is asked for less is done, but no less than that.
    if expected == Method::Iterative {
        let mut x = b.clone();
        solver.solve_to(&pattern, &matrix, 1e-2, &mut x).unwrap();
        matrix.multiply(&pattern, &x, &mut product);
        let rest: Vec<f64> = b.iter().zip(&product).map(|(b, ax)| b - ax).collect();
        let part = (square(&rest) / square(&b)).sqrt();
        assert!(part <= 1e-2 && part > residual, "{part:e}");
    }
}

#[test]
fn definite_systems_by_cholesky() {
    check_solution(true, 0.0, 0.0, Method::Cholesky);
}

#[test]
fn indefinite_systems_by_ldlt() {
    check_solution(true, 0.0, -40.0, Method::Ldlt);
}

#[test]
fn mildly_unsymmetric_systems_by_iteration() {
    check_solution(false, 0.5, 0.0, Method::Iterative);
}

#[test]
fn unsymmetric_indefinite_systems_by_lu() {
    check_solution(false, 0.5, -40.0, Method::Lu);
}

#[test]
fn constraints_move_to_the_right_hand_side() {
    for symmetric in [true, false] {
        let pattern = chain(symmetric);
        let (mut matrix, dense, _) = assemble(&pattern, 0.0);
        let n = pattern.len();
        let exact: Vec<f64> = (0..n).map(|i| (i as f64 + 0.3).sin()).collect();
        let mut x: Vec<f64> = (0..n).map(|i| (0..n).map(|j| dense[i][j] * exact[j]).sum()).collect();
        let fixed: Vec<bool> = (0..n).map(|i| i % 3 == 0).collect();
        let scale = matrix.scale(&pattern);
        matrix.constrain(&pattern, &fixed, &exact, scale, &mut x);
        Solver::new::<2>(&pattern, &[]).unwrap().solve(&pattern, &matrix, &mut x).unwrap();
        for (a, b) in x.iter().zip(&exact) {
            assert!((a - b).abs() < 1e-11, "{a} against {b}");
        }
    }
}

#[test]
fn only_the_wanted_equations_are_dampened() {
    let pattern = chain(true);
    let (plain, ..) = assemble(&pattern, 0.0);
    let (mut matrix, ..) = assemble(&pattern, 0.0);
    let wanted: Vec<bool> = (0..pattern.len() - 1).map(|e| e % 3 == 0).collect();
    matrix.dampen(&pattern, &wanted, 0.25);
    for (e, (raised, diagonal)) in matrix.diagonal(&pattern).iter().zip(plain.diagonal(&pattern)).enumerate() {
        let share = if wanted.get(e) == Some(&true) { 1.25 } else { 1.0 };
        assert!(diagonal != 0.0 && *raised == share * diagonal, "{e}: {raised} of {diagonal}");
    }
}

#[test]
fn a_singular_system_is_refused() {
    let pattern = chain(true);
    let matrix = Matrix::new(&pattern);
    let mut x = vec![1.0; pattern.len()];
    assert!(Solver::new::<2>(&pattern, &[]).unwrap().solve(&pattern, &matrix, &mut x).is_err());
    let mut x = vec![f64::NAN; pattern.len()];
    assert!(Solver::new::<2>(&pattern, &[]).unwrap().solve(&pattern, &matrix, &mut x).is_err());
}

#[test]
fn the_number_of_threads_does_not_change_the_sums() {
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| assemble(&chain(true), 0.3).0.values)
    };
    assert_eq!(run(1), run(3));
}

/// A net of `n × n` nodes with springs of all strengths between neighbours, its stiffness, and where the nodes are.
fn net(n: u32, symmetric: bool) -> (Pattern, Matrix, Vec<[f64; 2]>) {
    let mut connectivity = Connectivity::default();
    for i in 0..n * n {
        if i % n + 1 < n {
            connectivity.push([i, i + 1]);
        }
        if i + n < n * n {
            connectivity.push([i, i + n]);
        }
    }
    let pattern = Pattern::new(&vec![1; (n * n) as usize], connectivity, symmetric);
    let mut matrix = Matrix::new(&pattern);
    for k in 0..pattern.connectivity.len() {
        let s = (7.0 * (k as f64).sin()).exp();
        matrix.add(&pattern, k, &[s, -s, -s, s], 2);
    }
    let places = (0..n * n).map(|i| [f64::from(i % n), f64::from(i / n)]).collect();
    (pattern, matrix, places)
}

/// A load that a free body could bear has solutions, but no single one: what rounding makes of it is refused.
#[test]
fn a_singular_system_that_has_solutions_is_refused() {
    // The last two are large enough to be halved.
    for (n, symmetric) in [(3, true), (30, true), (30, false), (150, true), (150, false)] {
        let (pattern, mut matrix, places) = net(n, symmetric);
        let mut load = vec![0.0; pattern.len()];
        (load[1], load[5]) = (1.0, -1.0);
        let mut solver = Solver::new(&pattern, &places).unwrap();
        let refused = solver.solve(&pattern, &matrix, &mut load.clone()).unwrap_err();
        assert!(refused.problem.contains("singular"), "{refused}");
        let mut fixed = vec![false; pattern.len()];
        fixed[0] = true;
        let known = vec![0.0; pattern.len()];
        let scale = matrix.scale(&pattern);
        matrix.constrain(&pattern, &fixed, &known, scale, &mut load);
        solver.solve(&pattern, &matrix, &mut load).unwrap();
    }
}

/// A net large enough for products in groups and a factor by halves: they are those of a plain sum over the entries, and they, the right-hand
/// side of a constrained system and its solution have the same bits on any number of threads.
#[test]
fn products_and_constraints_do_not_depend_on_the_threads() {
    for symmetric in [true, false] {
        let (pattern, matrix, places) = net(220, symmetric);
        let n = pattern.len();
        let known: Vec<f64> = (0..n).map(|i| (i as f64).sin()).collect();
        let mut expected = vec![0.0; n];
        for j in 0..n {
            for k in pattern.column[j] as usize..pattern.column[j + 1] as usize {
                let i = pattern.row[k] as usize;
                expected[i] += matrix.values[k] * known[j];
                if symmetric && i != j {
                    expected[j] += matrix.values[k] * known[i];
                }
            }
        }
        let fixed: Vec<bool> = (0..n).map(|i| i % 5 == 0).collect();
        let run = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                let mut product = vec![0.0; n];
                matrix.multiply(&pattern, &known, &mut product);
                let mut constrained = Matrix { values: matrix.values.clone(), ..Matrix::default() };
                let mut x = product.clone();
                constrained.constrain(&pattern, &fixed, &known, matrix.scale(&pattern), &mut x);
                let load = x.clone();
                Solver::new(&pattern, &places).unwrap().solve(&pattern, &constrained, &mut x).unwrap();
                (product, constrained.values, load, x)
            })
        };
        let (product, values, load, x) = run(1);
        let largest = expected.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        let apart = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(apart(&product, &expected) < 1e-13 * largest);
        assert!(apart(&x, &known) < 1e-8, "{:e}", apart(&x, &known));
        assert!(run(3) == (product, values, load, x));
    }
}
