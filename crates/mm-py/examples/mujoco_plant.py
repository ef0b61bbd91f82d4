"""The controller drives a MuJoCo model of the robot: an engine that knows nothing of our equations.

Two wheels on the floor with friction, four frictionless casters at the corners of the 0.5 m x 0.4 m base, three joints with torque
motors, all from ``Robot.params``. The controller is the scenario's, without gains for the contact.

    python mujoco_plant.py [sinusoid square]

prints, for our plant and MuJoCo's, ITAE, torque variation and the RMS error of the tip after the first five seconds; in MuJoCo
the tip is where the engine has it, tilt and sinking of the base included. Contact is MuJoCo's own, its parameters untouched.

The reference is brought up to its speed within a second: set out at once, as the thesis has it, the wheels slip under 60 N m and the
robot tips over, in MuJoCo as it would in a hall.
"""

from __future__ import annotations

import sys

import mujoco
import numpy as np

import mmsim

#: Half of the base's size, m.
HALF = (0.25, 0.2)
CASTER_M = 0.03
#: Of a wheel, which is taken from the base's mass, kg.
WHEEL_KG = 0.2
#: Time over which the reference is brought up to its speed, s.
RAMP_S = 1.0
#: Steps of the engine in a control period.
SUBSTEPS = 2


def described(robot: mmsim.Robot) -> str:
    """The robot in MuJoCo's language."""
    p = robot.params
    r, half = p["wheel_radius_m"], p["track_width_m"] / 2
    mass, com = p["base_mass_kg"] - 2 * WHEEL_KG, p["base_com_offset_m"]
    # What is left for the box when the wheels, beside the axle's middle, have theirs.
    yaw = p["base_yaw_inertia_kg_m2"] - 2 * WHEEL_KG * (half**2 + com**2)
    com *= p["base_mass_kg"] / mass
    # Roll and pitch of the base, which the planar model does not have: those of a box as flat as the wheels are high.
    roll, pitch = (mass / 12 * ((2 * side) ** 2 + (2 * r) ** 2) for side in (HALF[1], HALF[0]))
    casters = "\n".join(
        f'<geom type="sphere" size="{CASTER_M}" pos="{x} {y} {CASTER_M - r}" condim="1" friction="0 0 0" mass="0"/>'
        for x in (-HALF[0], HALF[0])
        for y in (-HALF[1], HALF[1])
    )
    wheels = "\n".join(
        f'<body name="{name}_wheel" pos="0 {y} 0"><joint name="{name}" type="hinge" axis="0 1 0"/>'
        f'<inertial pos="0 0 0" mass="{WHEEL_KG}" diaginertia="1e-4 {WHEEL_KG * r**2 / 2} 1e-4"/>'
        f'<geom type="cylinder" size="{r} 0.01" euler="90 0 0" condim="3" friction="1 0.005 0.0001" mass="0"/></body>'
        for name, y in (("right", -half), ("left", half))
    )
    arm, closing = "", ""
    place = f"{p['arm_offset_m']} 0 {p['mount_height_m'] - r}"
    for number, link in enumerate(p["link"]):
        axial, pitch_inertia, normal = link["inertia_kg_m2"]
        upright = number == 0
        axis, inertia = ("0 0 1", (normal, pitch_inertia, axial)) if upright else ("0 -1 0", (axial, pitch_inertia, normal))
        along = (lambda x: f"0 0 {x}") if upright else (lambda x: f"{x} 0 0")
        arm += (
            f'<body name="link{number + 1}" pos="{place}"><joint name="joint{number + 1}" type="hinge" axis="{axis}"/>'
            f'<inertial pos="{along(link["com_m"])}" mass="{link["mass_kg"]}" diaginertia="{" ".join(map(str, inertia))}"/>'
            f'<geom type="capsule" fromto="0 0 0 {along(link["length_m"])}" size="0.02" contype="0" conaffinity="0" mass="0"/>'
        )
        closing += "</body>"
        place = along(link["length_m"])
    motors = "\n".join(
        f'<motor joint="{name}"/>' for name in ("right", "left", "joint1", "joint2", "joint3")
    )
    return f"""
<mujoco><option timestep="{1e-3 / SUBSTEPS}" gravity="0 0 {-p["gravity_m_s2"]}" integrator="implicitfast" cone="elliptic"/>
  <compiler inertiafromgeom="false" balanceinertia="true"/>
  <worldbody>
    <geom type="plane" size="0 0 1" condim="1" friction="0 0 0"/>
    <body name="base" pos="0 0 {r}"><freejoint/>
      <inertial pos="{com} 0 0" mass="{mass}" diaginertia="{roll} {pitch} {yaw}"/>
      <geom type="box" size="{HALF[0]} {HALF[1]} 0.02" contype="0" conaffinity="0" mass="0"/>
      {casters}{wheels}{arm}<site name="tip" pos="{place}"/>{closing}
    </body>
  </worldbody>
  <actuator>{motors}</actuator>
</mujoco>"""


class Plant:
    """A plant for ``mmsim.simulate``; ``tips`` are where the engine had the tip at the begin of each period."""

    def __init__(self, robot: mmsim.Robot) -> None:
        self.model = mujoco.MjModel.from_xml_string(described(robot))
        self.data = mujoco.MjData(self.model)
        self.robot = robot
        self.tips: list[np.ndarray] = []
        self.placed = False

    def place(self, q: np.ndarray, nu: np.ndarray) -> None:
        """Puts the robot into a state, its wheels rolling."""
        p, data = self.robot.params, self.data
        data.qpos[:2] = q[:2]
        data.qpos[3:7] = np.cos(q[2] / 2), 0, 0, np.sin(q[2] / 2)
        data.qpos[9:] = q[3:]
        data.qvel[:2] = nu[0] * np.cos(q[2]), nu[0] * np.sin(q[2])
        data.qvel[5] = nu[1]
        turn = p["track_width_m"] / 2 * nu[1]
        data.qvel[6:8] = (nu[0] + turn) / p["wheel_radius_m"], (nu[0] - turn) / p["wheel_radius_m"]
        data.qvel[8:] = nu[2:]
        mujoco.mj_forward(self.model, data)
        self.placed = True

    def state(self) -> tuple[np.ndarray, np.ndarray]:
        """Configuration and velocity as the controller is told them: pose of the axle's middle, speed along the heading."""
        position, velocity = self.data.qpos, self.data.qvel
        w, x, y, z = position[3:7]
        heading = np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
        # The quaternion has no turns; the controller counts them.
        heading += 2 * np.pi * round((self.heading - heading) / (2 * np.pi))
        self.heading = heading
        forward = velocity[0] * np.cos(heading) + velocity[1] * np.sin(heading)
        return np.array([*position[:2], heading, *position[9:]]), np.array([forward, velocity[5], *velocity[8:]])

    def __call__(
        self, _t: float, q: np.ndarray, nu: np.ndarray, tau: np.ndarray, _period: float
    ) -> tuple[np.ndarray, np.ndarray]:
        if not self.placed:
            self.heading = q[2]
            self.place(q, nu)
        self.tips.append(self.data.site("tip").xpos.copy())
        self.data.ctrl[:] = tau
        mujoco.mj_step(self.model, self.data, SUBSTEPS)
        return self.state()


def rms_mm(error: np.ndarray, t: np.ndarray) -> float:
    """RMS length after the first five seconds, mm."""
    return 1e3 * float(np.sqrt((error[t >= 5] ** 2).sum(axis=1).mean()))


def run(name: str, duration_s: float | None = None) -> dict[str, float]:
    """Runs a scenario with our plant and with MuJoCo's and prints both; the RMS errors, mm."""
    overrides = {"simulation.log_rate_hz": 1000.0, "trajectory.start_ramp_s": RAMP_S}
    if duration_s is not None:
        overrides["simulation.duration_s"] = duration_s
    found = {}
    for label in ("ours", "MuJoCo"):
        scenario = mmsim.Scenario(name, overrides, controller="bfsmc")
        plant = Plant(scenario.robot) if label == "MuJoCo" else None
        one = mmsim.simulate(scenario, plant=plant)
        error = one.error if plant is None else np.array(plant.tips) - one.reference
        found[label] = rms_mm(error, one.t)
        itae, variation = one.metrics["itae_m_s2"]["sum"], one.metrics["torque_tv_n_m_per_s"]["sum"]
        print(
            f"{name:10} {label:7} {one.ended}  RMS after 5 s {found[label]:.3f} mm  ITAE {itae:.4g} m s^2"
            f"  torque variation {variation:.4g} N m/s"
        )
    return found


if __name__ == "__main__":
    for scenario_name in sys.argv[1:] or ["sinusoid", "square"]:
        run(scenario_name)
