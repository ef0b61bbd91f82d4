//! `[robot]` and `[plant]`.

use schemars::JsonSchema;
use serde::Deserialize;

use super::hardware::{Actuators, Sensors};
use super::{NonNegative, Positive};

/// The robot that the controller knows: a preset or a file, and any field that shall differ from it.
#[derive(Debug, Clone, Default, PartialEq, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Robot {
    /// A built-in robot; excludes `file`. Default: `thesis`, when `file` is not given.
    pub preset: Option<Preset>,
    /// A TOML file whose top-level keys are the fields of `[robot]`, sought in the folder of the scenario
    /// file; a name given by `--set` is sought from the working directory.
    pub file: Option<String>,
    /// The fields given in the file or here.
    #[serde(flatten)]
    pub fields: RobotFields,
}

/// A built-in robot.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Preset {
    /// The robot of Table 5.1, completed by what the table leaves out.
    Thesis,
}

/// A robot, or the fields of one that differ from its preset.
#[derive(Debug, Clone, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RobotFields {
    /// Mass of the base with its wheels. In `thesis`: 50.
    #[schemars(with = "Option<Positive>")]
    pub base_mass_kg: Option<f64>,
    /// Inertia of the base about the vertical through its centre of mass. In `thesis`: 50 (0.5^2 + 0.4^2)/12.
    #[schemars(with = "Option<NonNegative>")]
    pub base_yaw_inertia_kg_m2: Option<f64>,
    /// Centre of mass of the base, ahead of the wheel axle. In `thesis`: 0.06.
    pub base_com_offset_m: Option<f64>,
    /// Yaw axis of the arm, ahead of the wheel axle. In `thesis`: 0.06.
    pub arm_offset_m: Option<f64>,
    /// Height of the foot of link 1 above the ground. In `thesis`: 0.
    pub mount_height_m: Option<f64>,
    /// Radius of the driving wheels. In `thesis`: 0.06.
    #[schemars(with = "Option<Positive>")]
    pub wheel_radius_m: Option<f64>,
    /// Distance between the two driving wheels. In `thesis`: 0.2.
    #[schemars(with = "Option<Positive>")]
    pub track_width_m: Option<f64>,
    /// Gravitational acceleration, downwards. In `thesis`: 9.81.
    #[schemars(with = "Option<NonNegative>")]
    pub gravity_m_s2: Option<f64>,
    /// Joint angles that the arm starts in and returns to. In `thesis`: 0, 60, -120 degrees.
    pub rest_posture_rad: Option<[f64; 3]>,
    /// Largest torque of each driving wheel, either way. In `thesis`: 60.
    #[schemars(with = "Option<Positive>")]
    pub wheel_torque_limit_n_m: Option<f64>,
    /// The links from the base to the tip; each entry changes the fields it gives of the link at its place.
    #[serde(default)]
    #[schemars(length(max = 3))]
    pub link: Vec<Link>,
}

/// A link of the arm, or the fields of one that differ from its preset.
#[derive(Debug, Clone, Copy, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Link {
    /// Length from the link's joint to the next joint or the tip. In `thesis`: 0.5 each.
    #[schemars(with = "Option<Positive>")]
    pub length_m: Option<f64>,
    /// Mass. In `thesis`: 4, 6, 4.
    #[schemars(with = "Option<Positive>")]
    pub mass_kg: Option<f64>,
    /// Centre of mass, along the link from its joint. In `thesis`: at the end of the link.
    #[schemars(with = "Option<NonNegative>")]
    pub com_m: Option<f64>,
    /// Principal inertias about the centre of mass, `[axial, pitch, normal]`: about the link's axis, about
    /// the joint's pitch axis and about the third axis. Link 1 stands upright: its axis is the vertical.
    /// In `thesis`: mass times length squared over 12, about every axis.
    #[schemars(with = "Option<[NonNegative; 3]>")]
    pub inertia_kg_m2: Option<[f64; 3]>,
    /// Range of the joint angle, `[lo, hi]`; crossings are counted, there are no end stops.
    /// In `thesis`: [-pi, pi], [-0.35, 1.92], [-2.79, 2.79].
    pub joint_limit_rad: Option<[f64; 2]>,
    /// Largest torque of the joint, either way. In `thesis`: 150, 200, 150.
    #[schemars(with = "Option<Positive>")]
    pub torque_limit_n_m: Option<f64>,
}

/// How the simulated robot differs from the one that the controller knows.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Plant {
    /// Factor on all masses and inertias of the plant, never on those the controller knows.
    #[serde(default = "default_mass_scale")]
    #[schemars(with = "Positive")]
    pub mass_scale: f64,
    /// Factors on single parameters of the plant, on top of `mass_scale`.
    #[serde(default)]
    pub scale: PlantScale,
    /// Friction in the wheels and joints of the plant.
    #[serde(default)]
    pub friction: Friction,
    /// Mass of a point load at the tip, unknown to the controller and not scaled.
    #[serde(default)]
    #[schemars(with = "NonNegative")]
    pub payload_kg: f64,
    /// When the tip takes the load, at the speed of the tip.
    #[serde(default)]
    #[schemars(with = "NonNegative")]
    pub payload_from_s: f64,
    /// When it drops the load. Default: with the run.
    #[schemars(with = "Option<Positive>")]
    pub payload_to_s: Option<f64>,
    /// What the controller reads.
    #[serde(default)]
    pub sensors: Sensors,
    /// What becomes of its commands.
    #[serde(default)]
    pub actuators: Actuators,
}

impl Default for Plant {
    fn default() -> Self {
        Self {
            mass_scale: default_mass_scale(),
            scale: PlantScale::default(),
            friction: Friction::default(),
            payload_kg: 0.0,
            payload_from_s: 0.0,
            payload_to_s: None,
            sensors: Sensors::default(),
            actuators: Actuators::default(),
        }
    }
}

const fn default_mass_scale() -> f64 {
    1.0
}

/// Factors on single parameters of the plant, on top of `mass_scale`; the controller never knows them.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct PlantScale {
    /// On the mass of the base.
    #[schemars(with = "Positive")]
    pub base_mass: f64,
    /// On the inertia of the base about the vertical.
    #[schemars(with = "Positive")]
    pub base_yaw_inertia: f64,
    /// On the distance of the base's centre of mass ahead of the wheel axle.
    #[schemars(with = "NonNegative")]
    pub base_com: f64,
    /// On the mass of each link; inertias stay as they are.
    #[schemars(with = "[Positive; 3]")]
    pub link_mass: [f64; 3],
    /// On the three principal inertias of each link.
    #[schemars(with = "[Positive; 3]")]
    pub link_inertia: [f64; 3],
    /// On the distance of each link's centre of mass from its joint.
    #[schemars(with = "[NonNegative; 3]")]
    pub link_com: [f64; 3],
}

impl Default for PlantScale {
    fn default() -> Self {
        Self {
            base_mass: 1.0,
            base_yaw_inertia: 1.0,
            base_com: 1.0,
            link_mass: [1.0; 3],
            link_inertia: [1.0; 3],
            link_com: [1.0; 3],
        }
    }
}

/// Friction in the wheels and joints of the plant: a viscous part and a Coulomb part smoothed around zero.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Friction {
    /// Viscous torque of each driving wheel over its rate, N m s/rad.
    #[serde(default)]
    #[schemars(with = "NonNegative")]
    pub wheel_viscous_n_m_s: f64,
    /// Coulomb torque of each driving wheel.
    #[serde(default)]
    #[schemars(with = "NonNegative")]
    pub wheel_coulomb_n_m: f64,
    /// Viscous torque of each joint over its rate, N m s/rad.
    #[serde(default)]
    #[schemars(with = "[NonNegative; 3]")]
    pub joint_viscous_n_m_s: [f64; 3],
    /// Coulomb torque of each joint.
    #[serde(default)]
    #[schemars(with = "[NonNegative; 3]")]
    pub joint_coulomb_n_m: [f64; 3],
    /// Rate over which the Coulomb torque changes sign.
    #[serde(default = "default_smoothing")]
    #[schemars(with = "Positive")]
    pub smoothing_rad_s: f64,
}

impl Default for Friction {
    fn default() -> Self {
        Self {
            wheel_viscous_n_m_s: 0.0,
            wheel_coulomb_n_m: 0.0,
            joint_viscous_n_m_s: [0.0; 3],
            joint_coulomb_n_m: [0.0; 3],
            smoothing_rad_s: default_smoothing(),
        }
    }
}

const fn default_smoothing() -> f64 {
    0.01
}
