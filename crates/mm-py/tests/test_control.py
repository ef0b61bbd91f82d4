"""Controllers and supervisors: the same torques as in a run, states that are kept, and what is refused."""

import pickle
import threading

import numpy as np
import pytest

import mmsim

Q, NU, P = [0, 0, 0, 0.1, 1.0, -2.0], [0.1, 0, 0, 0, 0], [0.6, 0.0, 0.5]
KINDS = [
    "bsmc",
    "bsmc-sat",
    "bfsmc-thesis",
    "bfsmc",
    "ctc",
    "pid",
    "lqr",
    "smc-decentralized",
    "backstepping-adaptive",
    "super-twisting",
]


@pytest.fixture
def robot() -> mmsim.Robot:
    return mmsim.Robot.thesis()


@pytest.mark.parametrize("kind", KINDS)
def test_a_run_is_the_same_with_the_controller_in_python(robot, kind):
    """Twin: the simulator's own stack; the digests are equal."""
    short = {"simulation.duration_s": 0.3}
    own = mmsim.simulate("square", kind, overrides=short)
    ctrl = mmsim.Controller(robot, kind, period_s=own.summary["control_period_s"])
    assert mmsim.simulate("square", ctrl, overrides=short).digest == own.digest


@pytest.mark.parametrize("kind", KINDS)
def test_a_pickle_goes_on_where_it_was(robot, kind):
    ctrl = mmsim.Controller(robot, kind)
    for _ in range(5):
        ctrl.update(Q, NU, P)
    other = pickle.loads(pickle.dumps(ctrl))
    assert (other.update(Q, NU, P) == ctrl.update(Q, NU, P)).all()


def test_the_estimator_is_pickled_too(robot):
    ctrl = mmsim.Controller(robot, estimator={"kind": "observer", "cutoff_hz": 50.0})
    for k in range(5):
        ctrl.update_measured([1e-3 * k, *Q[1:]], P)
    other = pickle.loads(pickle.dumps(ctrl))
    assert (other.update_measured(Q, P) == ctrl.update_measured(Q, P)).all()
    with pytest.raises(ValueError, match="update_measured"):
        ctrl.update(Q, NU, P)


def test_reset_forgets(robot):
    ctrl = mmsim.Controller(robot)
    first = ctrl.update(Q, NU, P)
    for _ in range(10):
        ctrl.update(Q, NU, P)
    ctrl.reset()
    assert (ctrl.update(Q, NU, P) == first).all()


def test_status_and_signals(robot):
    ctrl = mmsim.Controller(robot)
    assert ctrl.signals is None
    assert not any(ctrl.status.values())
    ctrl.update(Q, NU, [30.0, 0.0, 0.5])
    assert ctrl.status["speed_limited"]
    np.testing.assert_allclose(ctrl.signals["error"], robot.tip_position(Q) - [30.0, 0.0, 0.5])


def test_an_input_that_is_not_finite_changes_nothing(robot):
    ctrl, twin = mmsim.Controller(robot), mmsim.Controller(robot)
    for one in (ctrl, twin):
        one.update(Q, NU, P)
    with pytest.raises(mmsim.ControlError):
        ctrl.update([np.nan, *Q[1:]], NU, P)
    assert (ctrl.update(Q, NU, P) == twin.update(Q, NU, P)).all()
    assert issubclass(mmsim.ControlError, RuntimeError)


@pytest.mark.parametrize(
    ("arguments", "key"),
    [
        ({"kind": "bsmcc"}, "controller.kind"),
        ({"period_s": -1.0}, "simulation"),
        ({"switching_gains": [1.0] * 5}, "switching_gains"),
        ({"switching_gain": [-1.0] * 5}, "switching_gain"),
        ({"outer": {"weights": [0.0] * 5}}, "weights"),
    ],
)
def test_arguments_are_refused_by_key(robot, arguments, key):
    with pytest.raises(mmsim.ScenarioError) as caught:
        mmsim.Controller(robot, **arguments)
    assert any(key in problem["key"] for problem in caught.value.problems)


def test_float32_and_lists_are_taken(robot):
    a, b = mmsim.Controller(robot), mmsim.Controller(robot)
    q = np.array(Q, dtype=np.float32)
    assert (a.update(q, NU, P) == b.update(q.tolist(), NU, P)).all()


def test_threads_have_controllers_of_their_own(robot):
    wanted = [mmsim.Controller(robot).update(Q, NU, P) for _ in range(4)]
    found: list = [None] * 4

    def work(index: int) -> None:
        ctrl = mmsim.Controller(robot)
        for _ in range(200):
            ctrl.reset()
            found[index] = ctrl.update(Q, NU, P)

    threads = [threading.Thread(target=work, args=(index,)) for index in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all((a == b).all() for a, b in zip(wanted, found))


def test_a_supervisor_holds_stops_and_recovers(robot):
    ctrl = mmsim.Controller(robot, supervisor={"recovery_periods": 3})
    supervised = mmsim.Supervisor(ctrl)
    rest = [0.0] * 5
    tip = robot.tip_position(Q)
    first = supervised.update(Q, rest, tip)
    assert (first.mode, first.findings, first.brake) == ("run", [], False)
    assert (first.torque == ctrl.update(Q, rest, tip)).all()
    held = supervised.update([np.nan] * 6, rest, tip)
    assert held.mode == "hold"
    assert held.findings == ["state-not-finite"]
    modes = [supervised.missed().mode for _ in range(4)]
    assert "stop" in modes
    back = [supervised.update(Q, rest, tip).mode for _ in range(10)]
    assert back[-1] == "run"
    for command in (first, held):
        assert np.isfinite(command.torque).all()
