"""The robot: laws of its matrices, shapes, and what it refuses.

Laws: M is symmetric and positive definite; M' - 2 C is skew-symmetric; forward and inverse dynamics undo each other; J is the
derivative of the tip. Tolerances: rounding of double precision, some units of the last place times the condition of M; for
differences, the step's square.
"""

import pickle

import numpy as np
import pytest

import mmsim

RNG = np.random.default_rng(7)
K = 200
Q = RNG.uniform(-2, 2, (K, 6))
NU = RNG.uniform(-1, 1, (K, 5))
TAU = RNG.uniform(-20, 20, (K, 5))


@pytest.fixture(scope="module")
def robot() -> mmsim.Robot:
    return mmsim.Robot(base_mass_kg=31.0, base_com_offset_m=0.03)


def test_mass_matrix_is_symmetric_and_positive_definite(robot):
    m = robot.mass_matrix(Q)
    np.testing.assert_allclose(m, m.transpose(0, 2, 1), atol=1e-12)
    assert (np.linalg.eigvalsh(m) > 0).all()


def test_rates_of_mass_and_coriolis_are_skew(robot):
    h = 1e-6
    cos, sin = np.cos(Q[:, 2]), np.sin(Q[:, 2])
    rate = np.column_stack([NU[:, 0] * cos, NU[:, 0] * sin, NU[:, 1:]])
    dm = (robot.mass_matrix(Q + h * rate) - robot.mass_matrix(Q - h * rate)) / (2 * h)
    skew = dm - 2 * robot.coriolis_matrix(Q, NU)
    np.testing.assert_allclose(skew, -skew.transpose(0, 2, 1), atol=1e-7)


def test_dynamics_undo_each_other(robot):
    dnu = robot.forward_dynamics(Q, NU, TAU)
    np.testing.assert_allclose(robot.inverse_dynamics(Q, NU, dnu), TAU, rtol=1e-9, atol=1e-9)


def test_bias_is_made_of_its_parts(robot):
    parts = np.einsum("kij,kj->ki", robot.coriolis_matrix(Q, NU), NU) + robot.gravity(Q)
    np.testing.assert_allclose(robot.bias(Q, NU), parts, rtol=1e-10, atol=1e-10)


def test_jacobian_is_the_tips_derivative(robot):
    h = 1e-6
    cos, sin = np.cos(Q[:, 2]), np.sin(Q[:, 2])
    rate = np.column_stack([NU[:, 0] * cos, NU[:, 0] * sin, NU[:, 1:]])
    velocity = (robot.tip_position(Q + h * rate) - robot.tip_position(Q - h * rate)) / (2 * h)
    np.testing.assert_allclose(np.einsum("kij,kj->ki", robot.tip_jacobian(Q), NU), velocity, atol=1e-8)
    j = robot.tip_jacobian(Q)
    np.testing.assert_allclose(
        robot.manipulability(Q), np.sqrt(np.linalg.det(j @ j.transpose(0, 2, 1))), rtol=1e-8, atol=1e-12
    )


def test_one_state_is_a_row_of_many(robot):
    many = robot.forward_dynamics(Q, NU, TAU)
    for k in range(5):
        assert (robot.forward_dynamics(Q[k], NU[k], TAU[k]) == many[k]).all()
    beside = robot.forward_dynamics(Q, NU[3], TAU[3])
    assert beside.shape == (K, 5)
    assert (beside[3] == many[3]).all()


def test_layouts_and_types_do_not_matter(robot):
    wanted = robot.gravity(Q)
    assert (robot.gravity(np.asfortranarray(Q)) == wanted).all()
    assert (robot.gravity(np.repeat(Q, 2, axis=0)[::2]) == wanted).all()
    assert (robot.gravity(Q.tolist()) == wanted).all()
    single = Q.astype(np.float32)
    assert (robot.gravity(single) == robot.gravity(single.astype(np.float64))).all()
    assert robot.gravity(np.empty((0, 6))).shape == (0, 5)
    assert robot.manipulability(Q[0]).shape == ()


@pytest.mark.parametrize(
    ("q", "message"),
    [
        (np.zeros(5), r"q: expected shape \(6,\) or \(k, 6\), got \(5,\)"),
        (np.zeros((2, 3, 6)), r"got \(2, 3, 6\)"),
    ],
)
def test_shapes_are_refused_by_name(robot, q, message):
    with pytest.raises(ValueError, match=message):
        robot.gravity(q)


def test_numbers_of_rows_have_to_agree(robot):
    with pytest.raises(ValueError, match="nu has 3 rows, q has 2"):
        robot.bias(np.zeros((2, 6)), np.zeros((3, 5)))
    with pytest.raises(TypeError, match="q: expected an array of numbers"):
        robot.gravity("abc")


def test_fields_are_checked():
    with pytest.raises(mmsim.ScenarioError) as caught:
        mmsim.Robot(base_mas_kg=3.0)
    assert caught.value.nearest == "base_mass_kg"
    assert isinstance(caught.value, ValueError)
    with pytest.raises(mmsim.ScenarioError) as caught:
        mmsim.Robot(base_mass_kg=-1.0)
    assert "base_mass_kg" in caught.value.key
    assert (caught.value.line, caught.value.column) != (None, None)


def test_text_pickle_and_file_give_the_same_robot(robot, tmp_path):
    assert pickle.loads(pickle.dumps(robot)) == robot
    # A robot file has the keys of the table at its top.
    text = robot.to_toml().replace("[robot]\n", "").replace("[[robot.link]]", "[[link]]")
    file = tmp_path / "robot.toml"
    file.write_text(text)
    assert mmsim.Robot.from_toml(file) == robot
    assert robot.params["base_mass_kg"] == 31.0
    assert mmsim.Robot(**robot.params) == robot
    file.write_text("base_mass_kg = 'heavy'\n")
    with pytest.raises(mmsim.ScenarioError) as caught:
        mmsim.Robot.from_toml(file)
    assert (caught.value.file, caught.value.line) == (str(file), 1)
