use super::*;

const LENGTHS: [f64; 2] = [8.0, 2.0];
const VARIATION: f64 = 0.4;
/// Seeds that means are taken over.
const SEEDS: u64 = 4000;
/// Times its standard error that a mean may lie beside what it is to be: of the some hundred and thirty means here none would in a thousand trials.
const BESIDE: f64 = 4.5;

fn field(correlation: Correlation, seed: u64) -> RandomStrength {
    RandomStrength::new(&Randomness { variation: VARIATION, lengths: LENGTHS, correlation, seed })
}

/// Fails unless the mean of some values is `wanted`, to its standard error.
fn near(what: &str, values: impl Iterator<Item = f64> + Clone, wanted: f64) {
    let n = values.clone().count() as f64;
    let mean = values.clone().sum::<f64>() / n;
    let error = (values.map(|v| (v - mean).powi(2)).sum::<f64>() / (n * (n - 1.0))).sqrt();
    println!("{what}: {mean:.4} ± {error:.4}, to be {wanted:.4}");
    assert!((mean - wanted).abs() < BESIDE * error, "{what}: {mean} ± {error}, to be {wanted}");
}

/// Lags (m): along the axes, oblique, and far.
const LAGS: [[f64; 2]; 7] = [[0.5, 0.0], [2.0, 0.0], [8.0, 0.0], [0.0, 0.5], [0.0, 2.0], [4.0, 1.0], [-4.0, 1.0]];

fn correlation_of(correlation: Correlation, lag: &[f64; 2]) -> f64 {
    let d = (lag[0] / LENGTHS[0]).hypot(lag[1] / LENGTHS[1]);
    match correlation {
        Correlation::Markov => (-2.0 * d).exp(),
        Correlation::Gaussian => (-PI * d * d).exp(),
    }
}

#[test]
fn over_many_seeds_mean_variation_and_correlation_are_those_asked_for() {
    for correlation in [Correlation::Markov, Correlation::Gaussian] {
        let fields: Vec<_> = (0..SEEDS).map(|seed| field(correlation, seed)).collect();
        let standard = |x: [f64; 2]| fields.iter().map(|f| f.standard(&x)).collect::<Vec<f64>>();
        for x in [[0.0, 0.0], [37.3, -11.9], [-1e3, 250.0]] {
            let z = standard(x);
            let factors: Vec<f64> = fields.iter().map(|f| f.factor(&x)).collect();
            let z = || z.iter().copied();
            near("mean of z", z(), 0.0);
            near("variance of z", z().map(|z| z * z), 1.0);
            // Of a normal variable, as it is for any number of waves.
            near("third moment of z", z().map(|z| z.powi(3)), 0.0);
            near("fourth moment of z", z().map(|z| z.powi(4)), 3.0);
            near("below the median", z().map(|z| f64::from(u8::from(z < 0.0))), 0.5);
            // The 5 % fractile of the normal distribution.
            near("below the fractile", z().map(|z| f64::from(u8::from(z < -1.644_853_6))), 0.05);
            near("mean of the factor", factors.iter().copied(), 1.0);
            near("its variance", factors.iter().map(|f| (f - 1.0).powi(2)), VARIATION.powi(2));
            for lag in LAGS {
                let rho = correlation_of(correlation, &lag);
                let there = standard([x[0] + lag[0], x[1] + lag[1]]);
                near(&format!("{correlation:?} {lag:?}"), z().zip(&there).map(|(a, b)| a * b), rho);
                // The covariance of two lognormal values.
                let s = VARIATION.powi(2).ln_1p().sqrt();
                let factor = |z: f64| (s * z - 0.5 * s * s).exp() - 1.0;
                let both = z().zip(&there).map(|(a, b)| factor(a) * factor(*b));
                near(&format!("covariance of the factor at {lag:?}"), both, (s * s * rho).exp_m1());
            }
        }
    }
}

#[test]
fn the_waves_of_one_seed_have_nearly_the_correlation_of_all() {
    for correlation in [Correlation::Markov, Correlation::Gaussian] {
        let mut worst = 0.0f64;
        for lag in LAGS.into_iter().chain([[20.0, 0.0], [0.0, 6.0], [100.0, 0.0]]) {
            let square = |seed: u64| {
                let of = |w: &Wave| (w.vector[0] * lag[0] + w.vector[1] * lag[1]).cos() / WAVES as f64;
                let own: f64 = field(correlation, seed).waves.iter().map(of).sum();
                (own - correlation_of(correlation, &lag)).powi(2)
            };
            worst = worst.max(((0..200).map(square).sum::<f64>() / 200.0).sqrt());
        }
        println!("{correlation:?}: beside the correlation by {worst:.4}");
        assert!(worst < 0.04, "{correlation:?} {worst}");
    }
}

#[test]
fn a_realisation_is_that_of_its_seed() {
    let [a, b] = [1, 2].map(|seed| field(Correlation::Markov, seed));
    assert_eq!(a, field(Correlation::Markov, 1));
    assert!((a.standard(&[3.0, -2.0]) - b.standard(&[3.0, -2.0])).abs() > 1e-3);
    // The same variables whatever the scales: a field drawn out in x and y.
    let wide = RandomStrength::new(&Randomness {
        variation: VARIATION,
        lengths: LENGTHS.map(|l| 10.0 * l),
        correlation: Correlation::Markov,
        seed: 1,
    });
    assert!((wide.standard(&[30.0, -20.0]) - a.standard(&[3.0, -2.0])).abs() < 1e-9);
}

#[test]
fn without_variation_the_strength_is_the_mean_to_the_last_bit() {
    let of = Randomness { variation: 0.0, lengths: LENGTHS, correlation: Correlation::Gaussian, seed: 3 };
    assert_eq!(RandomStrength::new(&of).factor(&[1.0, 2.0]), 1.0);
    assert_eq!(strength_at(&[None], 0, &[1.0, 2.0]), 1.0);
    assert_eq!(strength_at(&[], 7, &[1.0, 2.0, 3.0]), 1.0);
}

#[test]
fn a_scale_far_beyond_the_scene_gives_one_strength() {
    let of = Randomness { variation: 0.5, lengths: [1e9; 2], correlation: Correlation::Gaussian, seed: 5 };
    let field = RandomStrength::new(&of);
    assert!((field.factor(&[0.0, 0.0]) / field.factor(&[100.0, -30.0]) - 1.0).abs() < 1e-6);
}

/// The same seed is the same ground in later versions: some values of two realisations, as they were found first.
#[test]
fn a_seed_keeps_its_realisation() {
    let found = [(Correlation::Markov, 1), (Correlation::Gaussian, 2)]
        .map(|(correlation, seed)| [[0.0, 0.0], [12.5, -3.25]].map(|x| field(correlation, seed).standard(&x)));
    println!("{found:?}");
    let wanted = [[-0.5295258168678899, 0.9076442745406343], [-0.27548168132733103, 1.3815784095562105]];
    for (found, wanted) in found.iter().flatten().zip(wanted.iter().flatten()) {
        assert!((found - wanted).abs() < 1e-12, "{found} {wanted}");
    }
}
