//! The reaching condition (4.44), with what it forgets: which gain would have been enough.

use mm_model::{Configuration, Force, Mechanism, Real, Robot, Velocity};

use crate::Signals;

/// The switching gain that would surely have made V = s'M s/2 decrease, channel by channel, N and N m.
///
/// Equation: k_i >= |(dM nu_r' + dC nu_r + dg + dfriction)_i - d_hat,i| + |f_ext,i| + eta_i, with d = nominal minus actual. (4.44) as
/// printed leaves the external force out and counts the fuzzy term against itself. For a law that learns, f_ext
/// is inside the first magnitude, since d_hat contains it.
///
/// Only a simulator can evaluate it: it needs the `actual` robot and the `external` force.
#[must_use]
pub fn required_gain<T: Real, const N: usize>(
    (nominal, actual): (&Robot<T, N>, &Robot<T, N>),
    (q, nu): (&Configuration<T, N>, &Velocity<T, N>),
    signals: &Signals<T, N>,
    external: &Force<T, N>,
    margin: &Force<T, N>,
) -> Force<T, N>
where
    Robot<T, N>: Mechanism<T, N>,
{
    let equivalent = |robot: &Robot<T, N>| {
        let inertia = robot.inertia(&robot.posture(&q.joints));
        robot
            .mass_product(&inertia, &signals.dnu_r)
            .plus(robot.coriolis_product(&inertia, nu, &signals.nu_r))
            .plus(robot.gravity(&inertia))
            .plus(robot.friction(nu))
    };
    let gap = equivalent(nominal).minus(equivalent(actual));
    let learns = signals.learned.channels().any(|d| d.abs() > T::ZERO);
    let needed = if learns {
        gap.plus(*external).minus(signals.learned).map(Real::abs)
    } else {
        gap.map(Real::abs).plus(external.map(Real::abs))
    };
    needed.plus(*margin)
}
