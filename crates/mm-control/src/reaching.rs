//! The reaching condition (4.44), with what it forgets: which gain would have been enough.

use mm_model::{Force, Mechanism, Real, Robot, Velocity};

use crate::Signals;

/// The switching gain that would surely have made V = s'M s/2 decrease, channel by channel, N and N m.
///
/// Equation, with gap = (the law's equivalent control) - (M nu_r' + C nu_r + g + friction of the actual robot):
///
/// ```text
/// k_i >= |gap_i| + |f_ext,i| + eta_i             for a law that does not learn
/// k_i >= |gap_i + f_ext,i - d_hat,i| + eta_i     for one that does, since d_hat stands for both
/// ```
/// (4.44) as printed leaves the external force out and counts the fuzzy term against itself.
///
/// Only a simulator can evaluate it: it needs the `actual` robot and the `external` force.
#[must_use]
pub fn required_gain<T: Real, const N: usize>(
    (actual, learns): (&Robot<T, N>, bool),
    (posture, nu): (&<Robot<T, N> as Mechanism<T, N>>::Posture, &Velocity<T, N>),
    signals: &Signals<T, N>,
    external: &Force<T, N>,
    margin: &Force<T, N>,
) -> Force<T, N>
where
    Robot<T, N>: Mechanism<T, N>,
{
    let inertia = actual.inertia(posture);
    let needed_by_actual = actual
        .mass_product(&inertia, &signals.dnu_r)
        .plus(actual.coriolis_product(&inertia, nu, &signals.nu_r))
        .plus(actual.gravity(&inertia))
        .plus(actual.friction(nu));
    let gap = signals.equivalent.minus(needed_by_actual);
    let needed = if learns {
        gap.plus(*external).minus(signals.learned).map(Real::abs)
    } else {
        gap.map(Real::abs).plus(external.map(Real::abs))
    };
    needed.plus(*margin)
}
