//! The random edits of a sample.

use crate::random::{noise_at, split_mix};
use crate::scenario::ScenarioFile;

/// Seed of a sample, from that of the sweep and the sample's number alone.
#[must_use]
pub const fn sample_seed(seed: u64, sample: u64) -> u64 {
    split_mix(split_mix(seed).wrapping_add(sample))
}

/// What is drawn; each has a stream of its own, so that the range of one changes no draw of another.
#[derive(Clone, Copy)]
enum Stream {
    Mass = 1,
    Inertia,
    Com,
    Wheels,
    Joints,
    Delay,
    Start,
    Disturbance,
}

/// A stream of random numbers.
struct Draws {
    seed: u64,
    next: f64,
}

impl Draws {
    const fn of(sample_seed: u64, stream: Stream) -> Self {
        Self { seed: split_mix(sample_seed ^ stream as u64), next: 0.0 }
    }

    /// Uniform in [-1, 1).
    fn sign(&mut self) -> f64 {
        let index = self.next;
        self.next += 1.0;
        noise_at(self.seed, index)
    }

    /// Uniform from `lo` to `hi`.
    fn between(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * 0.5 * (1.0 + self.sign())
    }

    /// A factor uniform in 1 +- range.
    fn factor(&mut self, range: f64) -> f64 {
        1.0 + range * self.sign()
    }

    /// One of `count` whole numbers from 0.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the product is in 0..count")]
    fn choice(&mut self, count: u32) -> u32 {
        (self.between(0.0, f64::from(count)) as u32).min(count - 1)
    }

    /// A point in the ball of a radius.
    fn in_ball(&mut self, radius: f64) -> [f64; 3] {
        loop {
            let point = [self.sign(), self.sign(), self.sign()];
            if point.iter().map(|x| x * x).sum::<f64>() <= 1.0 {
                return point.map(|x| radius * x);
            }
        }
    }
}

/// A number of an edit: what its text says is what is simulated.
fn text(value: f64) -> String {
    format!("{value:.6}")
}

fn list(values: [f64; 3]) -> String {
    format!("[{}]", values.map(text).join(", "))
}

/// The edits, each `KEY=VALUE`, that make a scenario into a sample of its sweep.
#[must_use]
pub fn edits(file: &ScenarioFile, seed: u64, sample: u64) -> Vec<String> {
    let range = &file.sweep;
    let own = sample_seed(seed, sample);
    let mut all = vec![format!("simulation.seed={own}")];
    let mut factors =
        |stream: Stream, range: f64, (base, its): (&str, f64), (link, theirs): (&str, [f64; 3])| {
            let mut draws = Draws::of(own, stream);
            if range > 0.0 {
                all.push(format!("plant.scale.{base}={}", text(its * draws.factor(range))));
                all.push(format!("plant.scale.{link}={}", list(theirs.map(|one| one * draws.factor(range)))));
            }
        };
    let given = &file.plant.scale;
    let masses = ("link_mass", given.link_mass);
    factors(Stream::Mass, range.mass, ("base_mass", given.base_mass), masses);
    let inertias = ("link_inertia", given.link_inertia);
    factors(Stream::Inertia, range.inertia, ("base_yaw_inertia", given.base_yaw_inertia), inertias);
    factors(Stream::Com, range.com, ("base_com", given.base_com), ("link_com", given.link_com));
    friction(file, own, &mut all);
    if range.delay_periods > 0 {
        let periods = Draws::of(own, Stream::Delay).choice(range.delay_periods.saturating_add(1));
        all.push(format!("plant.sensors.delay_periods={periods}"));
    }
    if range.start_offset_m > 0.0 {
        let [dx, dy, dz] = Draws::of(own, Stream::Start).in_ball(range.start_offset_m);
        let [x, y, z] = file.initial.offset_m;
        all.push(format!("initial.offset_m={}", list([x + dx, y + dy, z + dz])));
    }
    if range.joint_disturbance_n_m > 0.0 {
        let mut draws = Draws::of(own, Stream::Disturbance);
        for joint in 1..=3_usize {
            let number = file.disturbance.len() + joint - 1;
            let torque = disturbance(&mut draws, range.joint_disturbance_n_m, file.simulation.duration_s);
            all.push(format!("disturbance.{number}={{on=\"joint{joint}\", {torque}}}"));
        }
    }
    all
}

/// Friction of wheels and joints.
fn friction(file: &ScenarioFile, own: u64, all: &mut Vec<String>) {
    let range = &file.sweep;
    let mut wheels = Draws::of(own, Stream::Wheels);
    for (key, most) in
        [("wheel_viscous_n_m_s", range.wheel_viscous_n_m_s), ("wheel_coulomb_n_m", range.wheel_coulomb_n_m)]
    {
        let value = wheels.between(0.0, most);
        if most > 0.0 {
            all.push(format!("plant.friction.{key}={}", text(value)));
        }
    }
    let mut joints = Draws::of(own, Stream::Joints);
    for (key, most) in
        [("joint_viscous_n_m_s", range.joint_viscous_n_m_s), ("joint_coulomb_n_m", range.joint_coulomb_n_m)]
    {
        let values = [(); 3].map(|()| joints.between(0.0, most));
        if most > 0.0 {
            all.push(format!("plant.friction.{key}={}", list(values)));
        }
    }
}

/// A torque of random shape, in the first half of the run or from there on: step and sine last, pulse and noise end.
///
/// A sine has 0.1 to 10 rad/s, uniform in the logarithm; each value of a noise lasts 5 to 200 ms, likewise.
fn disturbance(draws: &mut Draws, most: f64, duration: f64) -> String {
    let shape = draws.choice(4);
    // As many draws for every shape, so that the torque of one joint does not depend on the shape of another.
    let amplitude = text(most * draws.sign());
    let from = 0.5 * duration * draws.between(0.0, 1.0);
    let to = from + duration * draws.between(0.05, 0.5);
    let (scale, phase) = (draws.between(0.0, 1.0), draws.between(0.0, core::f64::consts::TAU));
    let logarithmic = |lo: f64, hi: f64| text(lo * libm::exp(scale * libm::log(hi / lo)));
    let (from, to) = (text(from), text(to));
    match shape {
        0 => format!("shape=\"step\", amplitude_n_m={amplitude}, from_s={from}"),
        1 => format!("shape=\"pulse\", amplitude_n_m={amplitude}, from_s={from}, to_s={to}"),
        2 => format!(
            "shape=\"sine\", amplitude_n_m={amplitude}, from_s={from}, frequency_rad_s={}, phase_rad={}",
            logarithmic(0.1, 10.0),
            text(phase)
        ),
        _ => format!(
            "shape=\"noise\", amplitude_n_m={amplitude}, from_s={from}, to_s={to}, hold_s={}",
            logarithmic(0.005, 0.2)
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::{self, Loaded, Shape};

    fn load(sets: &[&str]) -> Loaded {
        let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
        scenario::load("square-compare", &sets).expect("a scenario")
    }

    /// Law: every quantity is in its range, and fills it: over 300 samples, its mean is that of a uniform number within five
    /// standard errors (range / sqrt(3 x 300), 0.033 of the range), its extremes are within 5 % of the ends.
    #[test]
    fn every_quantity_fills_its_range() {
        let base =
            load(&["plant.scale.base_mass=2", "initial.offset_m=[1, 0, 0]", "sweep.wheel_coulomb_n_m=3"]);
        let mut quantities: [Vec<f64>; 6] = Default::default();
        let mut shapes = [0_u32; 4];
        for sample in 0..300 {
            let file = base.edited(&edits(&base.file, 7, sample)).expect("a scenario").file;
            assert_eq!(file.simulation.seed, sample_seed(7, sample), "the seed of the sample");
            let [.., elbow] = file.plant.scale.link_inertia;
            let [x, y, z] = file.initial.offset_m;
            assert!(
                ((x - 1.0) * (x - 1.0) + y * y + z * z) <= 0.05 * 0.05 + 1e-7,
                "in the ball: {x} {y} {z}"
            );
            let [given, drawn @ ..] = file.disturbance.as_slice() else { panic!("no disturbance") };
            assert_eq!(Some(given), base.file.disturbance.first(), "the file's own stays");
            assert_eq!(drawn.len(), 3, "one a joint");
            for one in drawn {
                let shape = match one.shape {
                    Shape::Step => 0,
                    Shape::Pulse => 1,
                    Shape::Sine { .. } => 2,
                    Shape::Noise { .. } => 3,
                };
                shapes[shape] += 1;
                assert!(one.from_s <= 49.0 && one.to_s.is_none_or(|to| to > one.from_s), "times of {one:?}");
            }
            let centred = [
                (file.plant.scale.base_mass / 2.0 - 1.0) / 0.4,
                (elbow - 1.0) / 0.4,
                (file.plant.scale.base_com - 1.0) / 0.1,
                file.plant.friction.wheel_coulomb_n_m / 1.5 - 1.0,
                drawn[1].amplitude_n_m.expect("a torque") / 15.0,
                (drawn[2].from_s / 24.5) - 1.0,
            ];
            for (all, value) in quantities.iter_mut().zip(centred) {
                all.push(value);
            }
        }
        for (number, all) in quantities.iter().enumerate() {
            let mean = all.iter().sum::<f64>() / 300.0;
            let (lo, hi) = all.iter().fold((1.0, -1.0), |(lo, hi), x| (x.min(lo), x.max(hi)));
            assert!(mean.abs() < 5.0 * 0.0333, "mean of quantity {number}: {mean}");
            assert!(
                (-1.00001..-0.95).contains(&lo) && (0.95..1.00001).contains(&hi),
                "{number}: {lo} to {hi}"
            );
        }
        // 225 each, with a standard deviation of 13.
        assert!(shapes.iter().all(|count| (160..290).contains(count)), "shapes: {shapes:?}");
    }

    #[test]
    fn the_range_of_one_quantity_changes_no_draw_of_another() {
        let all = edits(&load(&[]).file, 1, 2);
        for (set, prefixes) in [
            ("sweep.mass=0", &["plant.scale.base_mass", "plant.scale.link_mass"] as &[&str]),
            ("sweep.com=0", &["plant.scale.base_com", "plant.scale.link_com"]),
            ("sweep.start_offset_m=0", &["initial.offset_m"]),
            ("sweep.joint_disturbance_n_m=0", &["disturbance."]),
        ] {
            let left: Vec<_> = all
                .iter()
                .filter(|edit| !prefixes.iter().any(|prefix| edit.starts_with(prefix)))
                .cloned()
                .collect();
            assert!(left.len() < all.len(), "{set} takes something away");
            assert_eq!(edits(&load(&[set]).file, 1, 2), left, "{set}");
        }
        let late = edits(&load(&["sweep.delay_periods=2", "controller.estimator.kind=observer"]).file, 1, 2);
        let more: Vec<_> = late.iter().filter(|edit| !all.contains(edit)).collect();
        assert!(
            more.len() == 1 && more[0].starts_with("plant.sensors.delay_periods="),
            "the delay is all that is new: {more:?}"
        );
        assert_ne!(edits(&load(&[]).file, 1, 3), all, "another sample");
        assert_ne!(edits(&load(&[]).file, 2, 2), all, "another seed");
    }
}
