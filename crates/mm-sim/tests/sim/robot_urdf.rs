//! Robots from URDF: a robot of others is understood, and what does not fit is named.
//!
//! Law: a robot whose joints are turned or start elsewhere is the same robot with other joint angles. Reference: a robot written by
//! hand, whose tip is computed by hand. Tolerance: 1e-9, some digits of the numbers written down here.

#![expect(clippy::panic, reason = "a helper of tests reports like a test")]

use mm_model::{Configuration, Robot};
use mm_sim::robot::{ImportOptions, Imported, import};

use crate::common::command::Folder;

fn imported(text: &str) -> Imported {
    import("my.urdf", text, &ImportOptions::default()).unwrap_or_else(|error| panic!("{error}"))
}

/// As others write one: a footprint, the arm upright at zero, pitch about +y and -y, a yaw that starts to the left, a fixed castor.
const FOREIGN: &str = r#"<?xml version="1.0"?>
<robot name="foreign">
  <link name="base_footprint"/>
  <link name="chassis"><inertial><origin xyz="0.1 0 0.05"/><mass value="20"/>
    <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="2"/></inertial></link>
  <joint name="up" type="fixed"><parent link="base_footprint"/><child link="chassis"/><origin xyz="0 0 0.1"/></joint>
  <link name="wl"><inertial><mass value="1"/><inertia ixx="0" ixy="0" ixz="0" iyy="0.002" iyz="0" izz="0"/></inertial>
    <collision><origin rpy="1.5708 0 0"/><geometry><cylinder radius="0.1" length="0.04"/></geometry></collision></link>
  <link name="wr"><inertial><mass value="1"/><inertia ixx="0" ixy="0" ixz="0" iyy="0.002" iyz="0" izz="0"/></inertial>
    <visual><geometry><sphere radius="0.1"/></geometry></visual></link>
  <joint name="jl" type="continuous"><parent link="chassis"/><child link="wl"/><origin xyz="0 0.25 0"/><axis xyz="0 1 0"/></joint>
  <joint name="jr" type="continuous"><parent link="chassis"/><child link="wr"/><origin xyz="0 -0.25 0"/><axis xyz="0 -1 0"/></joint>
  <link name="turret"><inertial><origin xyz="0 0 0.1"/><mass value="2"/>
    <inertia ixx="0.03" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.01"/></inertial></link>
  <joint name="yaw" type="revolute"><parent link="chassis"/><child link="turret"/><origin xyz="0.15 0 0.2" rpy="0 0 0.5"/>
    <axis xyz="0 0 -1"/><limit lower="-1" upper="2" effort="40" velocity="2"/></joint>
  <link name="upper"><inertial><origin xyz="0 0 0.15"/><mass value="3"/>
    <inertia ixx="0.05" ixy="0" ixz="0" iyy="0.04" iyz="0" izz="0.006"/></inertial></link>
  <joint name="shoulder" type="revolute"><parent link="turret"/><child link="upper"/><origin xyz="0 0 0.25"/><axis xyz="0 1 0"/>
    <limit lower="-1.5" upper="1.2" effort="50" velocity="2"/><dynamics damping="0.3"/></joint>
  <link name="fore"><inertial><origin xyz="0.2 0 0"/><mass value="1.5"/>
    <inertia ixx="0.001" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.03"/></inertial></link>
  <joint name="elbow" type="revolute"><parent link="upper"/><child link="fore"/><origin xyz="0 0 0.4"/><axis xyz="0 -1 0"/>
    <limit lower="-2" upper="2" effort="30" velocity="2"/></joint>
  <link name="hand"/>
  <joint name="grip" type="fixed"><parent link="fore"/><child link="hand"/><origin xyz="0.35 0 0"/></joint>
</robot>
"#;

#[test]
fn a_robot_of_others_is_understood() {
    let Imported { params: p, notes } = imported(FOREIGN);
    let close = |name: &str, found: f64, expected: f64| {
        assert!((found - expected).abs() < 1e-9, "{name}: {found}, not {expected}");
    };
    close("mass with wheels", p.base_mass, 22.0);
    close("centre of mass ahead", p.base_com_offset, 2.0 / 22.0);
    close(
        "yaw inertia",
        p.base_yaw_inertia,
        2.0 + 2.0 * 0.25 * 0.25 + 20.0 * 0.01 - 22.0 * (2.0 / 22.0) * (2.0 / 22.0),
    );
    close("track", p.track_width, 0.5);
    close("radius", p.wheel_radius, 0.1);
    close("height", p.mount_height, 0.3);
    close("offset", p.arm_offset, 0.15);
    for (link, length) in p.links.iter().zip([0.25, 0.4, 0.35]) {
        close("length", link.length, length);
    }
    let upper = &p.links[1];
    close("axial", upper.axial_inertia, 0.006);
    close("pitch", upper.pitch_inertia, 0.04);
    close("normal", upper.normal_inertia, 0.05);
    let half = core::f64::consts::FRAC_PI_2;
    // Yaw runs the other way and starts at 0.5; the shoulder stands upright at zero and turns down; the elbow starts bent by -90 degrees.
    for (index, (lo, hi)) in [(-2.0 + 0.5, 1.0 + 0.5), (half - 1.2, half + 1.5), (-half - 2.0, -half + 2.0)]
        .into_iter()
        .enumerate()
    {
        close("lower end", p.limits.joints[index].0, lo);
        close("upper end", p.limits.joints[index].1, hi);
    }
    let robot = Robot::try_new(p).unwrap_or_else(|error| panic!("{error}"));
    // All angles of the file at zero: the forearm level, 0.35 m along 0.5 rad, over a shoulder at 0.55 m and 0.4 m of upper arm.
    let tip = robot.tip_position(&Configuration { x: 0.0, y: 0.0, heading: 0.0, joints: [0.5, half, -half] });
    close("tip x", tip.x, 0.15 + 0.35 * 0.877_582_561_890_372_8);
    close("tip y", tip.y, 0.35 * 0.479_425_538_604_203);
    close("tip z", tip.z, 0.3 + 0.25 + 0.4);
    let all = notes.join("\n");
    for part in [
        "joint `yaw` at angle u is joint 1 of the model at -u + 0.5000 rad",
        "joint `shoulder` at angle u is joint 2 of the model at -u + 1.5708 rad",
        "joint `elbow` at angle u is joint 3 of the model at u + -1.5708 rad",
        "joint `shoulder`: damping 0.3",
        "no effort of the wheels: 60 N m, the preset's",
        "the wheels' inertia about their axle",
    ] {
        assert!(all.contains(part), "{part:?} is not in:\n{all}");
    }
}

#[test]
fn what_does_not_fit_is_named_with_its_place() {
    let cases: [(&str, &str, &str, &str); 18] = [
        ("<robot name=\"foreign\">", "<robot name=\"foreign\"", "not XML", "my.urdf:3:"),
        (
            "<robot name=\"foreign\">",
            "<robot name=\"foreign\"><joint/>",
            "joint without a name",
            "my.urdf:2:23",
        ),
        ("origin xyz=\"0 0 0.25\"", "origin xyz=\"0.1 0 0.25\"", "off the axis of `yaw`", "my.urdf:19:3"),
        ("origin xyz=\"0 0 0.4\"", "origin xyz=\"0 0.05 0.4\"", "0.0500 m out of its plane", "my.urdf:23:3"),
        (
            "<axis xyz=\"0 -1 0\"/>\n    <limit lower=\"-2\"",
            "<axis xyz=\"1 0 0\"/>\n    <limit lower=\"-2\"",
            "not parallel to that of `shoulder`",
            "my.urdf:23:3",
        ),
        (
            "<axis xyz=\"0 0 -1\"/>",
            "<axis xyz=\"0 1 0\"/>",
            "does not turn about the vertical",
            "my.urdf:15:3",
        ),
        (
            "joint name=\"grip\" type=\"fixed\"",
            "joint name=\"grip\" type=\"prismatic\"",
            "of a type that the model does not have",
            "my.urdf:26:3",
        ),
        (
            "joint name=\"grip\" type=\"fixed\"",
            "joint name=\"grip\" type=\"continuous\"",
            "the fourth of 4 joints in a row",
            "my.urdf:26:3",
        ),
        (
            "<child link=\"hand\"/>",
            "<child link=\"hend\"/>",
            "not connected to `base_footprint`",
            "my.urdf:25:3",
        ),
        (
            "xyz=\"0.2 0 0\"",
            "xyz=\"-0.2 0 0\"",
            "centre of mass is 0.2000 m behind its joint",
            "my.urdf:21:3",
        ),
        ("<mass value=\"1.5\"/>", "<mass value=\"0\"/>", "no mass", "my.urdf:21:3"),
        ("<sphere radius=\"0.1\"/>", "<mesh filename=\"wheel.stl\"/>", "--wheel-radius-m R", "my.urdf:9:3"),
        ("<sphere radius=\"0.1\"/>", "<sphere radius=\"0.2\"/>", "the wheels have radii", "my.urdf:11:3"),
        ("xyz=\"0.15 0 0.2\"", "xyz=\"0.15 0.1 0.2\"", "0.1000 m to the left", "my.urdf:15:3"),
        (
            "<robot name=\"foreign\">",
            "<robot name=\"foreign\"><link name=\"hand\"/>",
            "a second link `hand`",
            "my.urdf:",
        ),
        ("<mass value=\"1.5\"/>", "<mass value=\"six\"/>", "value = \"six\" of `<mass>`", "my.urdf:21:"),
        (
            "<mass value=\"1.5\"/>",
            "<mass value=\"-1\"/>",
            "expected a finite number, zero or above",
            "my.urdf:21:",
        ),
        ("<axis xyz=\"0 0 -1\"/>", "<axis xyz=\"0 nan -1\"/>", "expected three finite numbers", "my.urdf:"),
    ];
    for (from, to, says, place) in cases {
        assert_eq!(FOREIGN.matches(from).count(), 1, "{from:?} is in the file once");
        let broken = FOREIGN.replace(from, to);
        let found = import("my.urdf", &broken, &ImportOptions::default());
        let shown = found.err().unwrap_or_else(|| panic!("{to:?} is accepted")).to_string();
        assert!(shown.contains(says), "{says:?} is not in:\n{shown}");
        assert!(shown.contains("--> my.urdf:") && shown.contains(place), "{place:?} is not in:\n{shown}");
        assert!(shown.contains("expected"), "what was expected:\n{shown}");
    }
}

#[test]
fn the_options_settle_what_a_urdf_leaves_open() {
    let mesh = FOREIGN
        .replace("<sphere radius=\"0.1\"/>", "<mesh filename=\"wheel.stl\"/>")
        .replace("name=\"grip\" type=\"fixed\"", "name=\"grip\" type=\"continuous\"");
    let options = ImportOptions {
        tip: Some("hand".to_owned()),
        wheel_radius_m: Some(0.12),
        fixed: vec!["grip".to_owned()],
    };
    let robot = import("my.urdf", &mesh, &options).unwrap_or_else(|error| panic!("{error}")).params;
    assert!(
        (robot.wheel_radius - 0.12).abs() < 1e-12 && (robot.mount_height - 0.32).abs() < 1e-12,
        "the radius that was given"
    );
    let two = FOREIGN.replace("</robot>", "<link name=\"eye\"/><joint name=\"e\" type=\"fixed\"><parent link=\"fore\"/><child link=\"eye\"/></joint></robot>");
    let error = import("my.urdf", &two, &ImportOptions::default())
        .err()
        .unwrap_or_else(|| panic!("accepted"))
        .to_string();
    assert!(error.contains("2 frames could be the tip") && error.contains("`hand`, `eye`"), "{error}");
    let error =
        import("my.urdf", &two, &ImportOptions { tip: Some("hnd".to_owned()), ..ImportOptions::default() });
    assert!(
        error.is_err_and(|error| error.to_string().contains("the nearest known name is `hand`")),
        "a slip"
    );
}

#[test]
fn the_commands_go_from_file_to_file() {
    let folder = Folder::new("robot");
    folder.write("my.urdf", FOREIGN);
    let ended = folder.expect(0, &["robot", "import", "my.urdf", "-o", "robot.toml"]);
    assert!(
        ended.stdout.is_empty() && ended.stderr.contains("note: my.urdf: joint `yaw`"),
        "{}",
        ended.stderr
    );
    let run = [
        "--scenario",
        "verify-straight",
        "--set",
        "robot.file=robot.toml",
        "--no-log",
        "--set",
        "simulation.duration_s=1",
    ];
    folder.expect(0, &run);
    let ended = folder.expect(0, &["robot", "export", "--robot", "robot.toml", "-o", "again.urdf"]);
    assert!(ended.stderr.contains("no rest posture"), "{}", ended.stderr);
    folder.expect(0, &["robot", "import", "again.urdf", "-o", "again.toml"]);
    let fields = |name: &str| -> Vec<f64> {
        let text = std::fs::read_to_string(folder.path(name)).unwrap_or_else(|error| panic!("{error}"));
        let lines = text
            .lines()
            .filter_map(|line| line.split_once(" = "))
            .flat_map(|(_, value)| value.split(['[', ',', ']']));
        lines.filter_map(|word| word.trim().parse().ok()).collect()
    };
    let (one, two) = (fields("robot.toml"), fields("again.toml"));
    assert!(one.len() == two.len() && one.len() == 39, "{} and {} numbers", one.len(), two.len());
    assert!(one.iter().zip(&two).all(|(a, b)| (a - b).abs() < 1e-12), "the same robot:\n{one:?}\n{two:?}");
    let text = folder.expect(0, &["robot", "export"]).stdout;
    assert!(
        text.contains("<limit lower=\"-0.35\" upper=\"1.92\" effort=\"200\""),
        "the preset on standard output:\n{text}"
    );
    folder.write("bad.toml", "base_mass_kg = -1\n");
    let ended = folder.expect(2, &["robot", "export", "--robot", "bad.toml"]);
    assert!(ended.stderr.contains("bad.toml:1:16"), "{}", ended.stderr);
    for args in [["robot", "import", "none.urdf"], ["robot", "export", "--robot=none.toml"]] {
        let ended = folder.expect(2, &args);
        assert!(ended.stderr.contains("none."), "{}", ended.stderr);
    }
}
