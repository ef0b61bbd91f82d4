//! Forward dynamics of many states in a plain loop; prints the time of each run, one a line, in nanoseconds: `dynamics STATES RUNS`.

use std::hint::black_box;
use std::time::Instant;

use anyhow::{Context, Result};
use mm_benches::{many_points, robot};
use mm_model::{Force, Velocity};

fn main() -> Result<()> {
    let mut arguments = std::env::args().skip(1);
    let mut next =
        || -> Result<usize> { Ok(arguments.next().context("usage: dynamics STATES RUNS")?.parse()?) };
    let (count, runs) = (next()?, next()?);
    let robot = black_box(robot::<f64>()?);
    let points = many_points(count);
    let mut rates = vec![Velocity::zero(); points.len()];
    for _ in 0..runs {
        let begin = Instant::now();
        for (rate, point) in rates.iter_mut().zip(black_box(&points)) {
            *rate = robot.forward_dynamics(&point.q, &point.nu, &point.torque, &Force::zero());
        }
        black_box(&mut rates);
        println!("{}", begin.elapsed().as_nanos());
    }
    Ok(())
}
