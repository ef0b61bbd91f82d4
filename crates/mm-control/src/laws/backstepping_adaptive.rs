//! `backstepping-adaptive`: the inertia of every body and a force on every channel, learned on line.

use mm_model::{Force, Mechanism, ParamError, Real, Robot, Velocity};

use super::{Drive, EffectiveInertia, Gains, InnerLaw, LawMemory, Tracking};

/// Adaptive backstepping with factors theta on the inertias of base and links, and a learned force d_hat:
///
/// ```text
/// f        = sum_i Y_i theta_i + friction - K s - d_hat,     Y_i = M_i nu_r' + C_i nu_r + g_i of body i alone
/// theta_i' = -gamma Y_i's                                    within [factor_min, factor_max]
/// d_hat'   = gamma_d m s                                      within +-learning_limit
/// ```
/// M is linear in the bodies' masses and inertias, so that the true robot, each body off by a factor of its own, is among the
/// models. K and gamma_d are scaled by the effective inertia m at the rest posture: K = m x `damping`.
///
/// Stability: with V = s'Ms/2 + |theta - theta*|^2/(2 gamma) + sum (w_i - d_hat,i)^2/(2 gamma_d m_i) and Property 3, V' = -s'Ks for a constant
/// disturbance w within the limits: s tends to zero (Barbalat), the estimates stay bounded and need not be true. The
/// projections do not add to V'. For a w that varies s stays bounded. Sampled with period dt: K dt below 2 M.
///
/// Uses the gains `damping`, `body_adaptation` (gamma), `body_factor` (its bounds), `force_adaptation` (gamma_d) and `learning_limit`.
///
/// # Source
/// J.-J. E. Slotine, W. Li, On the adaptive control of robot manipulators, IJRR 6 (1987).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BacksteppingAdaptive<T, const N: usize> {
    damping: Force<T, N>,
    body_rate: T,
    body_factor: (T, T),
    force_rate: Force<T, N>,
    limit: Force<T, N>,
}

impl<T: Real, const N: usize> BacksteppingAdaptive<T, N>
where
    Robot<T, N>: Mechanism<T, N>,
{
    /// The law for a robot, with checked gains.
    ///
    /// # Errors
    /// The first gain that does not work, by name.
    pub fn try_new(robot: &Robot<T, N>, gains: &Gains<T, N>) -> Result<Self, ParamError> {
        gains.check()?;
        let EffectiveInertia(inertia) = EffectiveInertia::of(robot);
        let by = |rate: Velocity<T, N>| {
            let Velocity { forward, yaw_rate, joints } = rate;
            inertia.zip(Force { forward, yaw: yaw_rate, joints }, |m, rate| m * rate)
        };
        Ok(Self {
            damping: by(gains.damping),
            body_rate: gains.body_adaptation,
            body_factor: gains.body_factor,
            force_rate: inertia.scaled(gains.force_adaptation),
            limit: gains.learning_limit,
        })
    }
}

impl<T: Real, const N: usize> InnerLaw<T, N> for BacksteppingAdaptive<T, N>
where
    Robot<T, N>: Mechanism<T, N>,
{
    fn drive(&self, at: &Tracking<'_, T, N>, memory: &LawMemory<T, N>) -> Drive<T, N> {
        let (mut base, mut links, learned) = match *memory {
            LawMemory::Estimates { base, links, force } => (base, links, force),
            _ => (T::ONE, [T::ONE; N], Force::zero()),
        };
        let mut model = at.friction;
        for (body, factor) in core::iter::once(&mut base).chain(&mut links).enumerate() {
            let share = regressor(at, body);
            model = model.plus(share.scaled(*factor));
            let slope = at.sliding.power(&share);
            let (least, most) = self.body_factor;
            *factor = (*factor - self.body_rate * slope * at.period).clamp_to(least, most);
        }
        let s = &at.sliding;
        let back = super::channel_zip(s, &self.damping, |s, k| -(k * s));
        let force = model.plus(back).minus(learned);
        let gained = super::channel_zip(s, &self.force_rate, |s, rate| rate * s * at.period);
        let next = learned.plus(gained).zip(self.limit, |d, most| d.clamp_to(-most, most));
        Drive {
            force,
            equivalent: model,
            fuzzy: Force::zero(),
            learned: Some(learned),
            memory: Some(LawMemory::Estimates { base, links, force: next }),
        }
    }
}

/// Y_i: what nu_r' asks of one body alone.
fn regressor<T: Real, const N: usize>(at: &Tracking<'_, T, N>, body: usize) -> Force<T, N>
where
    Robot<T, N>: Mechanism<T, N>,
{
    let alone = at.robot.body_alone(body);
    let inertia = alone.inertia(at.posture);
    alone
        .mass_product(&inertia, &at.dnu_r)
        .plus(alone.coriolis_product(&inertia, at.nu, &at.nu_r))
        .plus(alone.gravity(&inertia))
}
