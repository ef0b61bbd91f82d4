//! The control stack in fixed point, in the loop with a plant in double precision.
//!
//! Laws: (1) the first update on any input of a run gives the torques of the stack in `f64` to 3e-7 of the joints' limits; (2) the loop
//! with it has the time-weighted mean error of the loop in `f64` to 3e-8 m, and its torques, tick by tick, to 4e-7 of the limits;
//! (3) an input or a state that leaves the range is an error, the state then as before; (4) a supervised stack holds and stops on
//! it, within limits; (5) what occurs in an update leaves 4 bits of the range free.
//! Why: the bits of the fixed point are those of no other scalar, so that only bounds can be asked for.
//! Reference: the stack in `f64`, with parameters of which those in fixed point are the rounded ones. Later updates are not compared on
//! the same inputs: the observer integrates the torque that its own stack asked for, and drifts off in one that is not in the loop.
//! Tolerance: parameters and inputs are rounded to 2^-33, which the gains of the outer loop, the slope of the surface and the inertia amplify;
//! three to five times the largest difference that was measured, see `docs/fixed-point.md`.
#![expect(clippy::expect_used, reason = "helpers outside of test functions")]

mod convert;
mod watched;

use mm_control::fuzzy::Bundled;
use mm_control::supervisor::Mode;
use mm_control::{ControlError, ControlStack, Input, SupervisedStack, SupervisorParams, Timing};
use mm_model::{Q32, Real, Torque};
use mm_sim::simulation::Simulation;
use mm_tests::{closed, load, load_text, measured};
use watched::{Seen, Watched};

/// What a run of a stack in some scalar gave.
struct Run {
    /// Integral of time times the length of the tip's error, over that of time, m.
    mean_error: f64,
    torques: Vec<Torque<f64, 3>>,
    /// The inputs, every tenth.
    inputs: Vec<Input<f64, 3>>,
}

fn apart(a: &Torque<f64, 3>, b: &Torque<f64, 3>) -> f64 {
    let joints = a.joints.iter().zip(&b.joints).map(|(a, b)| a - b);
    joints.chain([a.right - b.right, a.left - b.left]).fold(0.0, |most, d| Real::max(most, Real::abs(d)))
}

/// The closed loop of a scenario with its stack in another scalar.
fn run<T: Bundled>(simulation: &Simulation) -> Run {
    let Simulation { stack, plant, trajectory, initial, clock, .. } = simulation;
    let stack = convert::stack::<T>(stack, clock.period);
    let mut state = stack.initial_state();
    let mut plant_state = *initial;
    let mut result = Run { mean_error: 0.0, torques: Vec::new(), inputs: Vec::new() };
    let mut weight = 0.0;
    for tick in 0..clock.ticks {
        let t = clock.time(tick);
        let reference = trajectory.at(t);
        let tip = plant.robot().tip_position(&plant_state.q);
        result.mean_error += t * (tip - reference.position).norm();
        weight += t;
        let input = Input { q: plant_state.q, nu: plant_state.nu, reference };
        if tick.is_multiple_of(10) {
            result.inputs.push(input);
        }
        let output = stack.update(&mut state, &convert::input(&input)).expect("in range");
        let torque = convert::torque(&output.torque);
        result.torques.push(torque);
        let step = clock.period / f64::from(clock.substeps);
        for i in 0..clock.substeps {
            let sines = plant.sines(&plant_state.q);
            plant_state = plant.step(t + f64::from(i) * step, &plant_state, &sines, &torque);
        }
    }
    result.mean_error /= weight;
    result
}

/// Largest difference of the torques that fresh stacks in `f64` and another scalar ask for, N m.
fn fresh_difference<T: Bundled>(simulation: &Simulation, inputs: &[Input<f64, 3>]) -> f64 {
    let Simulation { stack, clock, .. } = simulation;
    let (double, other) =
        (convert::stack::<f64>(stack, clock.period), convert::stack::<T>(stack, clock.period));
    inputs.iter().fold(0.0, |most, input| {
        let expected = double.update(&mut double.initial_state(), input).expect("finite");
        let output = other.update(&mut other.initial_state(), &convert::input(input)).expect("in range");
        let (a, b) = (expected.signals.commanded, convert::torque(&output.signals.commanded));
        Real::max(most, apart(&a, &b))
    })
}

/// Compares the loops; gives the inputs of the fixed one.
fn compare(name: &str, simulation: &Simulation) -> Vec<Input<f64, 3>> {
    let (fixed, single, double) = (run::<Q32>(simulation), run::<f32>(simulation), run::<f64>(simulation));
    let error = |run: &Run| Real::abs(run.mean_error - double.mean_error);
    measured(&format!("{name}: mean error in f64, m"), double.mean_error);
    measured(&format!("{name}: difference of it in f32, m"), error(&single));
    measured(&format!("{name}: difference of it in fixed point, m"), error(&fixed));
    let most = simulation.stack.robot().params().limits.joint_torque.into_iter().fold(0.0, Real::max);
    let loops = |run: &Run| {
        let pairs = run.torques.iter().zip(&double.torques);
        pairs.fold(0.0, |worst, (a, b)| Real::max(worst, apart(a, b) / most))
    };
    measured(
        &format!("{name}: largest difference of two loops' torques in f32, of the limit"),
        loops(&single),
    );
    measured(
        &format!("{name}: largest difference of two loops' torques in fixed point, of the limit"),
        loops(&fixed),
    );
    let fresh = fresh_difference::<Q32>(simulation, &fixed.inputs) / most;
    measured(
        &format!("{name}: largest difference of first torques in f32, of the limit"),
        fresh_difference::<f32>(simulation, &fixed.inputs) / most,
    );
    measured(&format!("{name}: largest difference of first torques in fixed point, of the limit"), fresh);
    assert!(error(&fixed) <= 3e-8, "{name}: mean error {} for {}", fixed.mean_error, double.mean_error);
    assert!(loops(&fixed) <= 4e-7, "{name}: torques differ by {} of the limit", loops(&fixed));
    assert!(fresh <= 3e-7, "{name}: first torques differ by {fresh} of the limit");
    fixed.inputs
}

/// The largest and smallest results inside an update over the inputs of a run.
fn watch(name: &str, simulation: &Simulation, inputs: &[Input<f64, 3>]) -> Seen {
    let stack = convert::stack::<Watched>(&simulation.stack, simulation.clock.period);
    let mut state = stack.initial_state();
    let setup = Seen::take();
    for input in inputs {
        stack.update(&mut state, &convert::input(input)).expect("finite");
    }
    let seen = Seen::take();
    measured(&format!("{name}: largest result in setup"), setup.largest);
    measured(&format!("{name}: largest result in an update"), seen.largest);
    measured(&format!("{name}: smallest result in an update"), seen.smallest);
    #[expect(clippy::cast_precision_loss, reason = "for a report")]
    for (what, count) in [("sums", seen.sums), ("products", seen.products), ("quotients", seen.quotients)] {
        measured(&format!("{name}: {what} in an update"), count as f64 / inputs.len() as f64);
    }
    seen
}

fn tracks(name: &str, duration_s: f64) {
    let simulation = closed(&load(name, &[&format!("simulation.duration_s={duration_s:?}")]));
    let inputs = compare(name, &simulation);
    let seen = watch(name, &simulation, &inputs);
    assert!(seen.largest < 2.0_f64.powi(24), "{name}: {} leaves less than 4 bits of room", seen.largest);
}

#[test]
fn square_compare_is_tracked() {
    tracks("square-compare", 6.0);
}

#[test]
fn spiral_disturbed_is_tracked() {
    tracks("spiral-disturbed", 6.0);
}

#[test]
fn step_disturbed_is_tracked() {
    tracks("step-disturbed", 6.0);
}

/// A robot of the thesis's shape with all lengths times `scale` and all masses and torques times their due powers, with uneven links.
fn scaled_robot(scale: f64) -> String {
    let (mass, inertia, torque) = (scale.powi(3), scale.powi(5), scale.powi(4));
    let mut text = format!(
        "[robot]\npreset = \"thesis\"\nbase_mass_kg = {:?}\nbase_yaw_inertia_kg_m2 = {:?}\nwheel_radius_m = {:?}\n\
         track_width_m = {:?}\nwheel_torque_limit_n_m = {:?}\n",
        50.0 * mass,
        1.7 * inertia,
        0.07 * scale,
        0.23 * scale,
        60.0 * torque,
    );
    for (m, a, limit) in [(4.3, 0.47, 150.0), (5.1, 0.55, 200.0), (3.3, 0.43, 150.0)] {
        let (m, a) = (m * mass, a * scale);
        let i = m * a * a / 12.0;
        text += &format!(
            "[[robot.link]]\nlength_m = {a:?}\nmass_kg = {m:?}\ncom_m = {:?}\ninertia_kg_m2 = [{i:?}, {i:?}, {i:?}]\ntorque_limit_n_m = {:?}\n",
            0.6 * a,
            limit * torque,
        );
    }
    text
}

#[test]
fn robots_of_other_sizes_are_controlled() {
    for (scale, duration) in [(0.5, 5.0), (2.0, 5.0)] {
        let text = format!(
            "name = \"scaled\"\n[simulation]\nduration_s = {duration:?}\n[trajectory]\nkind = \"sinusoid\"\n{}",
            scaled_robot(scale)
        );
        let simulation = closed(&load_text("scaled.toml", &text, &[]));
        let name = format!("robot times {scale}");
        let inputs = compare(&name, &simulation);
        watch(&name, &simulation, &inputs);
    }
}

fn thesis() -> (ControlStack<Q32, 3>, Input<Q32, 3>) {
    let simulation = closed(&load("square-compare", &[]));
    let reference = simulation.trajectory.at(0.0);
    let input = Input { q: simulation.initial.q, nu: simulation.initial.nu, reference };
    (convert::stack(&simulation.stack, 1e-3), convert::input(&input))
}

/// Every number of an input, one after another, at sizes up to and beyond the range.
#[test]
fn leaving_the_range_is_an_error_and_changes_nothing() {
    let (stack, good) = thesis();
    let mut state = stack.initial_state();
    stack.update(&mut state, &good).expect("in range");
    let sizes = [1e2, 1e4, 1e5, 1e6, 1e7, 1e8, 2.6e8, f64::INFINITY, f64::NAN];
    let mut refused = 0;
    for size in sizes.into_iter().flat_map(|size| [size, -size]).map(Q32::from_f64) {
        let places: [fn(&mut Input<Q32, 3>) -> &mut Q32; 14] = [
            |i| &mut i.q.x,
            |i| &mut i.q.heading,
            |i| &mut i.q.joints[0],
            |i| &mut i.q.joints[2],
            |i| &mut i.nu.forward,
            |i| &mut i.nu.yaw_rate,
            |i| &mut i.nu.joints[0],
            |i| &mut i.nu.joints[1],
            |i| &mut i.nu.joints[2],
            |i| &mut i.reference.position.x,
            |i| &mut i.reference.position.z,
            |i| &mut i.reference.velocity.x,
            |i| &mut i.reference.velocity.z,
            |i| &mut i.reference.acceleration.y,
        ];
        for place in places {
            let mut input = good;
            *place(&mut input) = size;
            let mut after = state;
            let outcome = stack.update(&mut after, &input);
            if let Err(error) = outcome {
                refused += 1;
                assert!(after == state, "the state has changed: {size}");
                assert_eq!(
                    matches!(error, ControlError::NonFinite(_)),
                    !size.is_finite(),
                    "{error} of {size}"
                );
            } else {
                let output = outcome.expect("just looked at");
                assert!(size.is_finite(), "{size} passed");
                let limits = &stack.robot().params().limits;
                let within =
                    output.torque.joints.iter().zip(&limits.joint_torque).all(|(t, &limit)| t.abs() <= limit);
                assert!(
                    within && output.torque.right.abs() <= limits.wheel_torque,
                    "beyond limits at {size}"
                );
            }
        }
    }
    measured("refused, of 252", f64::from(refused));
    assert!(refused > 14 * 4, "large inputs have to overflow");
}

/// What is refused holds the last torque, then stops, and the findings say so; then it runs again.
#[test]
fn a_supervised_stack_survives_an_overflow() {
    let (stack, good) = thesis();
    let period = Q32::from_f64(1e-3);
    let params = SupervisorParams::for_robot(stack.robot(), period);
    let stack = SupervisedStack::try_new(stack, params).expect("in range");
    let mut state = stack.initial_state();
    let first = stack.update(&mut state, Timing::exact(period), &good);
    assert_eq!(first.mode, Mode::Run, "{:?}", first.findings);
    let mut bad = good;
    bad.nu.forward = Q32::from_f64(2e8);
    let mut modes = Vec::new();
    for _ in 0..10 {
        let command = stack.update(&mut state, Timing::exact(period), &bad);
        assert!(!command.findings.is_empty(), "an overflow is found");
        assert!(command.torque.is_finite(), "and gives no torque that is none");
        modes.push(command.mode);
    }
    assert_eq!(modes.first(), Some(&Mode::Hold), "{modes:?}");
    assert!(modes.iter().skip(3).all(|mode| *mode != Mode::Run && *mode != Mode::Hold), "{modes:?}");
    stack.reset(&mut state);
    assert_eq!(stack.update(&mut state, Timing::exact(period), &good).mode, Mode::Run);
}
