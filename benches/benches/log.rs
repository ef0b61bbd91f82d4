//! Times one logged sample over all topics, compression included: `cargo bench -p mm-benches --bench log`.

use anyhow::Result;
use criterion::Criterion;
use mm_model::{Real, RobotParams};
use mm_sim::log::{LogHeader, LogSample, LogWriter, RobotShape};

/// A sample whose numbers have low bits as random as those of a real run, so that they compress no better.
fn sample(k: u32) -> LogSample {
    let t_s = f64::from(k) / 100.0;
    let wave = |frequency: f64, phase: f64| Real::sin_cos(frequency * t_s + phase).0;
    let five =
        |frequency: f64, size: f64| [0.0, 1.0, 2.0, 3.0, 4.0].map(|phase| size * wave(frequency, phase));
    let three = |frequency: f64, size: f64| [0.0, 1.0, 2.0].map(|phase| size * wave(frequency, phase));
    LogSample {
        t_s,
        x: wave(0.06, 0.0),
        y: wave(0.06, 1.5),
        heading: wave(0.1, 0.3),
        joints: three(0.2, 1.0),
        forward: wave(1.0, 0.0),
        yaw_rate: wave(1.1, 0.0),
        joint_rates: three(0.3, 0.2),
        wheel_angles: [5.0 * t_s, 5.1 * t_s],
        p_d: three(0.06, 5.0),
        dp_d: three(0.06, 0.3),
        tip: three(0.07, 5.0),
        error: three(3.0, 1e-3),
        nu_c: five(0.5, 0.4),
        sliding: five(7.0, 1e-3),
        torque_commanded: five(2.0, 10.0),
        torque_applied: five(2.1, 10.0),
        disturbance: five(2.2, 10.0),
        fuzzy: five(5.0, 2.0),
        learned: five(1.9, 9.0),
        manipulability: wave(0.3, 0.0),
        reaching_bound: five(2.3, 4.0),
        ..LogSample::default()
    }
}

fn main() -> Result<()> {
    let header = LogHeader {
        scenario_name: "cost",
        scenario_text: "name = \"cost\"\n",
        edits: &[],
        files: &[],
        versions: &[],
        seed: 0,
        controller: "none",
        robot: RobotShape::from(&RobotParams::thesis()),
        reference: &[[0.0; 4]],
    };
    let mut writer = LogWriter::to_sink(std::io::sink(), "nowhere", &header)?;
    let samples: Vec<LogSample> = (0..10_000).map(sample).collect();
    let mut next = 0_u32;
    let mut criterion = Criterion::default().configure_from_args();
    criterion.bench_function("logged sample, all topics", |bencher| {
        bencher.iter(|| {
            let kind = usize::try_from(next).unwrap_or(0) % samples.len();
            let fresh = LogSample { t_s: f64::from(next) / 100.0, ..samples[kind] };
            next += 1;
            writer.write(&fresh)
        });
    });
    criterion.final_summary();
    writer.finish("{}", "0")?;
    Ok(())
}
