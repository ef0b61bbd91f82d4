//! What a logged sample costs: bytes in the file and time in the loop.
//!
//! A measurement, not a law, so it runs only when asked for, in the profile it is meant for:
//!
//! ```text
//! MMSIM_LOG=run.mcap cargo test -p mm-sim --profile testrelease --test log_cost -- --ignored --nocapture
//! ```
//!
//! The run is 98 s at 100 Hz, with numbers whose low bits are as random as those of a real run; the file is left
//! at `MMSIM_LOG` for other readers.

use mm_model::Real;
use mm_sim::log::{LogHeader, LogSample, LogWriter, RobotShape};
use std::path::PathBuf;
use std::time::Instant;

const SAMPLES: u32 = 9_801;

fn sample(k: u32) -> LogSample {
    let t_s = f64::from(k) / 100.0;
    let wave = |frequency: f64, phase: f64| Real::sin_cos(frequency * t_s + phase).0;
    let five =
        |frequency: f64, size: f64| [0.0, 1.0, 2.0, 3.0, 4.0].map(|phase| size * wave(frequency, phase));
    let three = |frequency: f64, size: f64| [0.0, 1.0, 2.0].map(|phase| size * wave(frequency, phase));
    let (x, y, heading) = (5.0 * wave(0.06, 0.0), 5.0 * wave(0.06, 1.5), wave(0.1, 0.3));
    let joints = [wave(0.2, 0.0), 1.0 + 0.2 * wave(0.3, 0.0), -2.0 + 0.3 * wave(0.4, 0.0)];
    let ((sin_h, cos_h), (sin_psi, cos_psi)) = (Real::sin_cos(heading), Real::sin_cos(heading + joints[0]));
    let ((sin_2, cos_2), (sin_23, cos_23)) = (Real::sin_cos(joints[1]), Real::sin_cos(joints[1] + joints[2]));
    let rho = 0.5 * (cos_2 + cos_23);
    LogSample {
        t_s,
        x,
        y,
        heading,
        joints,
        forward: 0.3 + 0.1 * wave(1.0, 0.0),
        yaw_rate: 0.1 * wave(1.1, 0.0),
        joint_rates: three(0.3, 0.2),
        wheel_angles: [5.0 * t_s, 5.1 * t_s],
        p_d: three(0.06, 5.0),
        dp_d: three(0.06, 0.3),
        tip: [
            x + 0.06 * cos_h + rho * cos_psi,
            y + 0.06 * sin_h + rho * sin_psi,
            0.5 + 0.5 * (sin_2 + sin_23),
        ],
        error: three(3.0, 1e-3),
        nu_c: five(0.5, 0.4),
        sliding: five(7.0, 1e-3),
        torque_commanded: five(2.0, 10.0),
        torque_applied: five(2.0, 10.0),
        disturbance: [0.0, 0.0, 10.0 * wave(2.0, 0.0), 10.0 * wave(2.0, 0.0), 10.0 * wave(2.0, 0.0)],
        fuzzy: five(5.0, 2.0),
        learned: five(1.9, 9.0),
        manipulability: 0.45 + 0.01 * wave(0.3, 0.0),
        damping: 0.0,
        reaching_bound: five(2.1, 4.0),
        ..LogSample::default()
    }
}

#[test]
#[ignore = "a measurement"]
fn cost_of_a_sample() {
    let default = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("log_cost.mcap");
    let path = std::env::var_os("MMSIM_LOG").map_or(default, PathBuf::from);
    let samples: Vec<LogSample> = (0..SAMPLES).map(sample).collect();
    let reference: Vec<[f64; 4]> = samples.iter().map(|s| [s.t_s, s.p_d[0], s.p_d[1], s.p_d[2]]).collect();
    let header = LogHeader {
        scenario_name: "cost",
        scenario_text: "name = \"cost\"\n",
        versions: &[],
        seed: 0,
        controller: "none",
        robot: RobotShape {
            wheel_radius_m: 0.06,
            track_width_m: 0.2,
            arm_offset_m: 0.06,
            mount_height_m: 0.0,
            link_lengths_m: [0.5; 3],
            base_mass_kg: 50.0,
            base_com_offset_m: 0.06,
            base_yaw_inertia_kg_m2: 1.708,
            link_masses_kg: [4.0, 6.0, 4.0],
            link_com_m: [0.5; 3],
            link_inertias_kg_m2: [[0.1; 3]; 3],
        },
        reference: &reference,
    };
    let mut writer = LogWriter::create(&path, &header).expect("a directory of our own");
    let start = Instant::now();
    for sample in &samples {
        writer.write(sample).expect("space on the disk");
    }
    let per_sample = start.elapsed() / SAMPLES;
    writer.finish("{}", "0").expect("space on the disk");
    let bytes = std::fs::metadata(&path).expect("the file").len();
    println!("{}: {per_sample:?} and {} bytes a sample", path.display(), bytes / u64::from(SAMPLES));
}
