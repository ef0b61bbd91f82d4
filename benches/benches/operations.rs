//! Times the operations of one control period: `cargo bench -p mm-benches`.
//!
//! Times depend on the machine and on what else it does; `cargo xtask bench-instructions` counts the same operations exactly.

use std::hint::black_box;

use anyhow::Result;
use criterion::{BatchSize, Criterion, Throughput};
use mm_benches::{numbers, points, recorded, robot, square, stack};
use mm_control::LawKind;
use mm_control::fuzzy::{Curve, FuzzySystem, SMOOTH, Surface, THESIS};
use mm_model::Force;
use mm_sim::disturbance::Disturbances;
use mm_sim::plant::Plant;
use mm_sim::simulation::NoRecorder;

fn main() -> Result<()> {
    let mut criterion = Criterion::default().configure_from_args();
    dynamics(&mut criterion)?;
    fuzzy(&mut criterion)?;
    control(&mut criterion)?;
    plant(&mut criterion)?;
    criterion.final_summary();
    Ok(())
}

/// Feeds `inputs` in turn to `operation`.
fn cycle<I, O>(criterion: &mut Criterion, name: &str, inputs: &[I], mut operation: impl FnMut(&I) -> O) {
    let mut inputs = inputs.iter().cycle();
    criterion.bench_function(name, |bencher| {
        bencher.iter(|| inputs.next().map(|input| operation(black_box(input))));
    });
}

fn dynamics(criterion: &mut Criterion) -> Result<()> {
    let double = robot::<f64>()?;
    let single = robot::<f32>()?;
    cycle(criterion, "forward dynamics, f64", &points(), |p| {
        black_box(&double).forward_dynamics(&p.q, &p.nu, &p.torque, &Force::zero())
    });
    cycle(criterion, "forward dynamics, f32", &points(), |p| {
        black_box(&single).forward_dynamics(&p.q, &p.nu, &p.torque, &Force::zero())
    });
    Ok(())
}

fn fuzzy(criterion: &mut Criterion) -> Result<()> {
    let engine = Curve::<f64>::try_new(&THESIS)?;
    let surface = Surface::<f64, 65>::from_engine(&Curve::<f64>::try_new(&SMOOTH)?)?;
    cycle(criterion, "fuzzy system, exact", &numbers(-1.4, 1.4), |x| black_box(&engine).evaluate(*x));
    cycle(criterion, "fuzzy system, surface", &numbers(-1.0, 1.0), |x| black_box(&surface).evaluate(*x));
    Ok(())
}

fn control(criterion: &mut Criterion) -> Result<()> {
    for kind in LawKind::ALL {
        let stack = stack(kind)?;
        let ticks = recorded(kind, 1000)?;
        let mut group = criterion.benchmark_group("controller update");
        group.throughput(Throughput::Elements(1000));
        group.bench_function(kind.name(), |bencher| {
            bencher.iter(|| {
                let mut state = stack.initial_state();
                for tick in &ticks {
                    black_box(black_box(&stack).update(&mut state, black_box(&tick.input)).is_ok());
                }
                state
            });
        });
        group.finish();
    }
    Ok(())
}

fn plant(criterion: &mut Criterion) -> Result<()> {
    let plant = Plant::new(robot()?, Disturbances::default(), mm_benches::PERIOD);
    cycle(criterion, "plant step, Runge-Kutta", &recorded(LawKind::Bfsmc, 1024)?, |tick| {
        let plant = black_box(&plant);
        plant.step(0.0, &tick.state, &plant.sines(&tick.state.q), &tick.torque)
    });
    let mut group = criterion.benchmark_group("closed loop");
    group.throughput(Throughput::Elements(1000));
    let simulation = square(LawKind::Bfsmc, 1000)?;
    group.bench_function("1000 periods of the square, bfsmc", |bencher| {
        bencher.iter_batched(
            || simulation.clone(),
            |simulation| simulation.run(&mut NoRecorder),
            BatchSize::LargeInput,
        );
    });
    group.finish();
    Ok(())
}
