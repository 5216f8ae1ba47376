//! The generalised-α method (Chung & Hulbert 1993) for displacement increments.
//!
//! `R = M ((1−α_m) a_{n+1} + α_m a_n) + F_α = 0` with Newmark's
//! `a_{n+1} = (u_{n+1} − u_n − Δt v_n)/(β Δt²) − (1/(2β) − 1) a_n`,
//! `v_{n+1} = v_n + Δt ((1−γ) a_n + γ a_{n+1})`. Second order for every `ρ∞`, unconditionally stable in
//! linear problems. In the internal force `F_α` the stress of the mean metric of the step acts on the
//! configuration in between ([`crate::term::Internal`]; Simo & Tarnow 1992, Kuhl & Crisfield 1999): angular
//! momentum is kept exactly for `ρ∞ = 1`, and rotation adds no strain, which the strain of the configuration
//! between the ends would show.

/// The parameters for one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GeneralisedAlpha {
    pub alpha_m: f64,
    pub alpha_f: f64,
    pub beta: f64,
    pub gamma: f64,
    /// Step size (s).
    pub dt: f64,
}

impl GeneralisedAlpha {
    /// The method with the given spectral radius at infinite frequency.
    pub fn new(spectral_radius: f64, dt: f64) -> Self {
        let alpha_m = (2.0 * spectral_radius - 1.0) / (spectral_radius + 1.0);
        let alpha_f = spectral_radius / (spectral_radius + 1.0);
        Self { alpha_m, alpha_f, beta: 0.25 * (1.0 - alpha_m + alpha_f).powi(2), gamma: 0.5 - alpha_m + alpha_f, dt }
    }

    /// Acceleration at the end of the step for a displacement increment `du`.
    pub fn acceleration(&self, du: f64, v: f64, a: f64) -> f64 {
        (du - self.dt * v) / (self.beta * self.dt * self.dt) - (0.5 / self.beta - 1.0) * a
    }

    /// Velocity at the end of the step for the acceleration `next` there.
    pub fn velocity(&self, v: f64, a: f64, next: f64) -> f64 {
        v + self.dt * ((1.0 - self.gamma) * a + self.gamma * next)
    }

    /// What the force of contact with soil counts for in (6): it acts as an impulse at the beginning of the step and leaves no acceleration behind
    /// (docs/theory.md, section 5, *Contact*).
    pub fn impulse(&self) -> f64 {
        (1.0 - self.alpha_m) / (2.0 * self.beta)
    }

    /// What such contact, that alone accelerates by `contact`, changes of acceleration and velocity by (5), the displacement given.
    pub fn released(&self, contact: f64) -> [f64; 2] {
        [-0.5 * contact / self.beta, self.dt * contact * (1.0 - 0.5 * self.gamma / self.beta)]
    }

    /// The rule whose matrix is that of the mass which resists such contact: `M + (η Δt)² K`, `η = (1 − ρ∞)/(1 + ρ∞)`. Motion of frequencies that
    /// the rule damps takes no part in it. None where it damps none.
    pub fn resisting(&self) -> Option<Self> {
        let damped = 1.0 - 2.0 * self.alpha_f;
        let beta = damped * damped * (1.0 - self.alpha_m) / (1.0 - self.alpha_f);
        (damped > 0.0).then_some(Self { beta, ..*self })
    }

    /// Acceleration that the inertia sees.
    pub fn weighted(&self, a: f64, next: f64) -> f64 {
        (1.0 - self.alpha_m) * next + self.alpha_m * a
    }

    /// Derivative of [`Self::weighted`] by the displacement.
    pub fn slope(&self) -> f64 {
        (1.0 - self.alpha_m) / (self.beta * self.dt * self.dt)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Free vibration of a unit oscillator over `periods`; returns position and velocity errors.
    fn oscillate(spectral_radius: f64, steps: usize) -> f64 {
        let t = 2.0 * std::f64::consts::PI * 0.83;
        let m = GeneralisedAlpha::new(spectral_radius, t / steps as f64);
        let (mut u, mut v, mut a) = (1.0, 0.0, -1.0);
        for _ in 0..steps {
            // R is linear in du: two evaluations give its root.
            let residual =
                |du: f64| m.weighted(a, m.acceleration(du, v, a)) + (1.0 - m.alpha_f) * (u + du) + m.alpha_f * u;
            let (r0, r1) = (residual(0.0), residual(1.0));
            let du = -r0 / (r1 - r0);
            let next = m.acceleration(du, v, a);
            (u, v, a) = (u + du, m.velocity(v, a, next), next);
        }
        (u - t.cos()).hypot(v + t.sin())
    }

    #[test]
    fn second_order_for_every_spectral_radius() {
        for radius in [1.0, 0.9, 0.5, 0.0] {
            let ratio = oscillate(radius, 40) / oscillate(radius, 80);
            assert!((3.6..4.4).contains(&ratio), "ρ∞ = {radius}: ratio {ratio}");
        }
    }

    /// A mass that one step of contact turns around goes on at its new velocity at once.
    #[test]
    fn contact_leaves_no_acceleration_behind() {
        for radius in [1.0, 0.9, 0.5, 0.0] {
            let m = GeneralisedAlpha::new(radius, 0.1);
            let (mut v, mut a) = (-1.0, 0.0);
            let mut velocities = Vec::new();
            for force in [20.0, 0.0, 0.0] {
                // Of a unit mass.
                let with_contact = (m.impulse() * force - m.alpha_m * a) / (1.0 - m.alpha_m);
                let [less, more] = m.released(force);
                (v, a) = (m.velocity(v, a, with_contact) + more, with_contact + less);
                velocities.push(v);
            }
            for v in velocities {
                assert!((v - 1.0).abs() < 1e-12 && a.abs() < 1e-12, "ρ∞ = {radius}: {v} {a}");
            }
        }
    }

    /// An oscillator of unit mass and `stiffness` (1/s²) that was at rest, under `forces` of contact in steps of 1 s: where it is, the most that it holds,
    /// and the most that it holds beyond the work of the forces.
    fn touched(m: &GeneralisedAlpha, stiffness: f64, forces: &[f64]) -> [f64; 3] {
        let (mut u, mut v, mut a, mut work, mut most, mut beyond) = (0.0, 0.0, 0.0, 0.0, 0.0f64, 0.0f64);
        let mut unresolved = 0.0;
        for force in forces {
            let residual = |du: f64| {
                m.weighted(a, m.acceleration(du, v, a)) + stiffness * (u + (1.0 - m.alpha_f) * du) + unresolved
                    - m.impulse() * force
            };
            let (r0, r1) = (residual(0.0), residual(1.0));
            let du = -r0 / (r1 - r0);
            let contact = force / m.resisting().map_or(1.0, |by| 1.0 + stiffness * (1.0 - m.alpha_f) / by.slope());
            let next = m.acceleration(du, v, a);
            let [less, more] = m.released(contact);
            (u, v, a) = (u + du, m.velocity(v, a, next) + more, next + less);
            unresolved = (m.impulse() - 1.0) * (force - contact);
            work += force * du;
            let held = 0.5 * (v * v + stiffness * u * u);
            (most, beyond) = (most.max(held), beyond.max(held - work));
        }
        [u, most, beyond]
    }

    const RADII: [f64; 6] = [1.0, 0.99, 0.9, 0.6, 0.3, 0.0];

    /// Neither as contact acts nor later does it hold more than the work of that force, at any frequency.
    #[test]
    fn contact_gives_no_more_than_its_work() {
        let rest = [0.0; 100];
        for forces in [&[1.0][..], &[1.0, 1.0], &[1.0; 5], &[1.0, 0.0, 1.0, 0.0, 1.0]] {
            for (radius, frequency) in RADII
                .into_iter()
                .flat_map(|radius| [0.1, 0.3, 1.0, 2.0, 3.0, 10.0, 100.0, 1000.0].map(|frequency| (radius, frequency)))
            {
                let m = GeneralisedAlpha::new(radius, 1.0);
                let [_, most, beyond] = touched(&m, frequency * frequency, &[forces, &rest].concat());
                assert!(beyond <= 1e-5 * most, "ρ∞ = {radius}, ω Δt = {frequency}: {beyond} of {most}");
            }
        }
    }

    /// Contact that stays leads to equilibrium with its force.
    #[test]
    fn contact_that_stays_is_borne() {
        for (radius, frequency) in
            RADII[2..].iter().flat_map(|&radius| [10.0, 30.0, 300.0].map(|frequency| (radius, frequency)))
        {
            let stiffness: f64 = frequency * frequency;
            let [u, _, _] = touched(&GeneralisedAlpha::new(radius, 1.0), stiffness, &[1.0; 2000]);
            assert!((u * stiffness - 1.0).abs() < 1e-9, "ρ∞ = {radius}, ω Δt = {frequency}: {}", u * stiffness);
        }
    }

    #[test]
    fn unit_spectral_radius_is_the_trapezoidal_rule() {
        let m = GeneralisedAlpha::new(1.0, 0.1);
        assert_eq!((m.alpha_m, m.alpha_f, m.beta, m.gamma), (0.5, 0.5, 0.25, 0.5));
    }
}
