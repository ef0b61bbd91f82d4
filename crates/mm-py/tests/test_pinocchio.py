"""The model against Pinocchio, which knows nothing of our equations, on random robots and states.

Reference: a planar joint for the base, whose velocity stands in the base's frame, so that the wheels' constraint takes its second
component away; three revolute joints. Law: M, C nu + g, g, forward dynamics, tip and Jacobian agree to 1e-10 of their largest
number; C itself is not unique, its product with nu and its skewness are (test_robot). Tolerance: rounding, some 1e5 units of the
last place for badly conditioned arms.
"""

import numpy as np
import pytest

import mmsim

pin = pytest.importorskip("pinocchio")

ROBOTS = 1000
#: Velocities of the planar joint and the arm that the constraint leaves.
FREE = [0, 2, 3, 4, 5]


def random_robot(rng) -> dict:
    u = rng.uniform
    return {
        "base_mass_kg": u(5, 100),
        "base_yaw_inertia_kg_m2": u(0.2, 5),
        "base_com_offset_m": u(-0.1, 0.2),
        "arm_offset_m": u(-0.2, 0.3),
        "mount_height_m": u(0, 0.5),
        "wheel_radius_m": u(0.04, 0.2),
        "track_width_m": u(0.2, 0.8),
        "gravity_m_s2": u(0, 15),
        "link": [
            {
                "length_m": (length := u(0.1, 1)),
                "mass_kg": u(0.3, 10),
                "com_m": length * u(0.1, 1),
                "inertia_kg_m2": [u(0.005, 0.02), u(0.02, 0.3), u(0.02, 0.3)],
            }
            for _ in range(3)
        ],
    }


def model_of(fields: dict):
    """The robot as Pinocchio sees it; its frame ``tip`` is the last."""
    model = pin.Model()
    model.gravity.linear = np.array([0, 0, -fields["gravity_m_s2"]])
    base = model.addJoint(0, pin.JointModelPlanar(), pin.SE3.Identity(), "base")
    yaw = np.diag([1.0, 1.0, fields["base_yaw_inertia_kg_m2"]])
    com = np.array([fields["base_com_offset_m"], 0, 0])
    model.appendBodyToJoint(base, pin.Inertia(fields["base_mass_kg"], com, yaw), pin.SE3.Identity())
    parent, place = base, np.array([fields["arm_offset_m"], 0, fields["mount_height_m"]])
    for number, link in enumerate(fields["link"]):
        axial, pitch, normal = link["inertia_kg_m2"]
        # Joints 2 and 3 raise the link with a positive angle: they turn about -y.
        joint = pin.JointModelRZ() if number == 0 else pin.JointModelRevoluteUnaligned(0, -1, 0)
        parent = model.addJoint(parent, joint, pin.SE3(np.eye(3), place), f"joint{number + 1}")
        along = np.array([0, 0, 1]) if number == 0 else np.array([1, 0, 0])
        tensor = np.diag([normal, pitch, axial] if number == 0 else [axial, pitch, normal])
        inertia = pin.Inertia(link["mass_kg"], link["com_m"] * along, tensor)
        model.appendBodyToJoint(parent, inertia, pin.SE3.Identity())
        place = link["length_m"] * along
    model.addFrame(pin.Frame("tip", parent, 0, pin.SE3(np.eye(3), place), pin.FrameType.OP_FRAME))
    return model


def agree(ours, theirs, what) -> None:
    scale = max(np.abs(theirs).max(), 1e-3)
    assert np.abs(ours - theirs).max() <= 1e-10 * scale, what


def test_a_thousand_random_robots_agree():
    rng = np.random.default_rng(1)
    for number in range(ROBOTS):
        fields = random_robot(rng)
        robot, model = mmsim.Robot(**fields), model_of(fields)
        data, tip = model.createData(), model.getFrameId("tip")
        q, nu, tau = rng.uniform(-3, 3, 6), rng.uniform(-2, 2, 5), rng.uniform(-30, 30, 5)
        theirs = np.array([q[0], q[1], np.cos(q[2]), np.sin(q[2]), *q[3:]])
        v = np.array([nu[0], 0, *nu[1:]])
        m = pin.crba(model, data, theirs)
        m = (np.triu(m) + np.triu(m, 1).T)[np.ix_(FREE, FREE)]
        bias = pin.rnea(model, data, theirs, v, np.zeros(6))[FREE]
        gravity = pin.computeGeneralizedGravity(model, data, theirs)[FREE]
        agree(robot.mass_matrix(q), m, (number, "M"))
        agree(robot.gravity(q), gravity, (number, "g"))
        agree(robot.bias(q, nu), bias, (number, "C nu + g"))
        agree(robot.coriolis_matrix(q, nu) @ nu, bias - gravity, (number, "C nu"))
        # The wheels' torques push and turn the base.
        r, half = fields["wheel_radius_m"], fields["track_width_m"] / 2
        force = np.array([(tau[0] + tau[1]) / r, (tau[0] - tau[1]) * half / r, *tau[2:]])
        acceleration = np.linalg.solve(m, force - bias)
        agree(robot.forward_dynamics(q, nu, tau), acceleration, (number, "forward dynamics"))
        agree(robot.inverse_dynamics(q, nu, acceleration), tau, (number, "inverse dynamics"))
        pin.forwardKinematics(model, data, theirs)
        pin.updateFramePlacements(model, data)
        agree(robot.tip_position(q), data.oMf[tip].translation, (number, "tip"))
        jacobian = pin.computeFrameJacobian(model, data, theirs, tip, pin.ReferenceFrame.LOCAL_WORLD_ALIGNED)
        agree(robot.tip_jacobian(q), jacobian[:3, FREE], (number, "J"))
