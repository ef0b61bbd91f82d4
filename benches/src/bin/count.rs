//! Runs one operation a given number of times, for an instruction counter to watch: `count OPERATION TIMES`.
//!
//! Two runs of different length differ by nothing but the operation, so that set-up cancels. Inputs come through a black box, the
//! robot's numbers too, and outputs go into one: nothing is hoisted out of the loop or left out of it.

use std::hint::black_box;

use anyhow::{Context, Result, bail, ensure};
use mm_benches::{numbers, points, recorded, robot, square, stack};
use mm_control::LawKind;
use mm_control::fuzzy::fixed::{self, Evaluate, THESIS_Q15, THESIS_SURFACE};
use mm_control::fuzzy::{Curve, FuzzySystem, SMOOTH, Surface, THESIS};
use mm_model::{Force, Real};
use mm_sim::disturbance::Disturbances;
use mm_sim::plant::Plant;
use mm_sim::simulation::NoRecorder;

fn main() -> Result<()> {
    let mut arguments = std::env::args().skip(1);
    let operation = arguments.next().context("usage: count OPERATION TIMES")?;
    let times = arguments.next().context("usage: count OPERATION TIMES")?.parse()?;
    match operation.as_str() {
        "forward-dynamics" => {
            let robot = robot::<f64>()?;
            repeat(times, &points(), |p| {
                black_box(&robot).forward_dynamics(&p.q, &p.nu, &p.torque, &Force::zero())
            });
        }
        "forward-dynamics-f32" => {
            let robot = robot::<f32>()?;
            repeat(times, &points(), |p| {
                black_box(&robot).forward_dynamics(&p.q, &p.nu, &p.torque, &Force::zero())
            });
        }
        "inverse-dynamics" => {
            let robot = robot::<f64>()?;
            repeat(times, &points(), |p| black_box(&robot).inverse_dynamics(&p.q, &p.nu, &p.acceleration));
        }
        "mass-matrix" => {
            let robot = robot::<f64>()?;
            repeat(times, &points(), |p| black_box(&robot).mass_matrix_at(&p.q));
        }
        "tip-jacobian" => {
            let robot = robot::<f64>()?;
            repeat(times, &points(), |p| black_box(&robot).jacobian(&p.q));
        }
        "sin-cos" => repeat(times, &numbers::<f64>(-3.2, 3.2), |x| Real::sin_cos(*x)),
        "sin-cos-f32" => repeat(times, &numbers::<f32>(-3.2, 3.2), |x| Real::sin_cos(*x)),
        "fuzzy-exact" => {
            let engine = Curve::<f64>::try_new(&THESIS)?;
            repeat(times, &numbers(-1.4, 1.4), |x| black_box(&engine).evaluate(*x));
        }
        "fuzzy-q15" => {
            let engine = fixed::Curve::<8>::try_new(&THESIS_Q15)?;
            repeat(times, &steps(), |q| black_box(&engine).evaluate(*q));
        }
        "fuzzy-surface-q15" => repeat(times, &steps(), |q| black_box(&THESIS_SURFACE).evaluate(*q)),
        "loop-q15" => repeat(times, &steps(), |q| {
            black_box(&THESIS_SURFACE);
            *q
        }),
        "fuzzy-surface" => {
            let surface = Surface::<f64, 65>::from_engine(&Curve::<f64>::try_new(&SMOOTH)?)?;
            repeat(times, &numbers(-1.0, 1.0), |x| black_box(&surface).evaluate(*x));
        }
        "update-bfsmc" => update(LawKind::Bfsmc, times)?,
        "update-bsmc" => update(LawKind::Bsmc, times)?,
        "plant-step" => {
            let plant = Plant::new(robot()?, Disturbances::default(), mm_benches::PERIOD);
            repeat(times, &recorded(LawKind::Bfsmc, 1024)?, |tick| {
                let plant = black_box(&plant);
                plant.step(0.0, &tick.state, &plant.sines(&tick.state.q), &tick.torque)
            });
        }
        "period" => {
            let simulation = square(LawKind::Bfsmc, times.try_into()?)?;
            let Ok(result) = black_box(&simulation).run(&mut NoRecorder);
            black_box(&result);
        }
        other => bail!("no operation `{other}`"),
    }
    Ok(())
}

/// 64 inputs in fixed point, equally spaced over the whole range.
fn steps() -> Vec<i16> {
    (-32_768_i16..=32_767).step_by(1_040).collect()
}

/// Applies `operation` `times` times, to the inputs in turn.
#[inline(always)]
fn repeat<I, O>(times: usize, inputs: &[I], mut operation: impl FnMut(&I) -> O) {
    for input in inputs.iter().cycle().take(times) {
        let output = operation(black_box(input));
        black_box(&output);
    }
}

/// Replays the start of a recorded run to the controller, so that its state goes where it went.
///
/// The recording is of one length, however much of it is replayed: making it has to cancel.
fn update(kind: LawKind, times: usize) -> Result<()> {
    let ticks = recorded(kind, 8_000)?;
    ensure!(times <= ticks.len(), "at most {} updates", ticks.len());
    let stack = stack(kind)?;
    let mut state = stack.initial_state();
    for tick in ticks.iter().take(times) {
        let output = black_box(&stack).update(&mut state, black_box(&tick.input))?;
        black_box(&output);
    }
    Ok(())
}
