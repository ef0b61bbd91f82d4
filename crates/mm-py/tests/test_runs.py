"""Runs: parity with the command line, Python in the loop, what is saved, interrupts, and errors with places."""

import json
import os
import pickle
import signal
import subprocess
import sys
import threading

import numpy as np
import pytest

import mmsim

SHORT = {"simulation.duration_s": 2.0}


def cli(*arguments: str, **more) -> subprocess.CompletedProcess:
    return subprocess.run([sys.executable, "-m", "mmsim", *arguments], capture_output=True, text=True, **more)


def test_python_and_command_line_give_the_same_digest(tmp_path):
    for name, kind, seed in [("square", "bsmc", 0), ("square-realistic", "bfsmc", 5), ("verify-circle", None, 0)]:
        run = mmsim.simulate(name, kind, overrides=SHORT, seed=seed)
        more = ["--controller", kind] if kind else []
        sets = ["--set", "simulation.duration_s=2.0", "--seed", str(seed)]
        said = cli("run", "--scenario", name, *more, *sets, "--no-log", "--json")
        summary = json.loads(said.stdout)
        assert summary["digest"] == run.digest
        assert summary["metrics"] == run.metrics


def test_columns_are_what_the_metrics_are_made_of():
    run = mmsim.simulate("square", overrides={**SHORT, "simulation.log_rate_hz": 1000.0})
    assert run.t.shape == (2000,)
    np.testing.assert_allclose(run.error, run.tip - run.reference)
    np.testing.assert_allclose(run.tip, mmsim.Robot.thesis().tip_position(run.q), atol=1e-12)
    assert run.metrics["max_error_m"] == pytest.approx(np.linalg.norm(run.error, axis=1).max())
    itae = (np.abs(run.error) * run.t[:, None]).sum(axis=0) * 1e-3
    assert [run.metrics["itae_m_s2"][axis] for axis in "xyz"] == pytest.approx(itae)
    p, dp, _ = run.scenario.trajectory.at(run.t)
    assert (p == run.reference).all()
    assert (dp == run.reference_velocity).all()


def test_a_plant_in_python_agrees_with_the_own_one():
    """Twin: the same model, one RK4 step a period; the paths agree to what the sines' series rounds."""
    robot = mmsim.Robot.thesis()

    def rate(q, nu, tau):
        v, heading = nu[0], q[2]
        return np.array([v * np.cos(heading), v * np.sin(heading), *nu[1:]]), robot.forward_dynamics(q, nu, tau)

    def plant(_t, q, nu, tau, h):
        k1q, k1n = rate(q, nu, tau)
        k2q, k2n = rate(q + h / 2 * k1q, nu + h / 2 * k1n, tau)
        k3q, k3n = rate(q + h / 2 * k2q, nu + h / 2 * k2n, tau)
        k4q, k4n = rate(q + h * k3q, nu + h * k3n, tau)
        return q + h / 6 * (k1q + 2 * k2q + 2 * k3q + k4q), nu + h / 6 * (k1n + 2 * k2n + 2 * k3n + k4n)

    short = {"simulation.duration_s": 0.5}
    own, ours = mmsim.simulate("square", overrides=short), mmsim.simulate("square", overrides=short, plant=plant)
    np.testing.assert_allclose(ours.q, own.q, atol=1e-10)
    assert ours.summary["plant"] == "python"


def test_a_plant_that_steps_like_the_own_one_has_its_digest():
    robot = mmsim.Robot.thesis()
    own = mmsim.simulate("sinusoid", overrides=SHORT)
    ours = mmsim.simulate("sinusoid", overrides=SHORT, plant=lambda _t, q, nu, tau, h: robot.step(q, nu, tau, h))
    assert ours.digest == own.digest


def test_a_controller_in_python_is_limited_and_checked():
    run = mmsim.simulate("square", lambda *_: [1e6] * 5, overrides={"simulation.duration_s": 0.01})
    assert run.saturated.all()
    assert (np.abs(run.tau) <= 200).all()
    with pytest.raises(mmsim.ControlError, match="not finite at t = 0.005"):
        mmsim.simulate("square", lambda t, *_: [np.nan if t >= 0.005 else 0.0] * 5, overrides=SHORT)
    with pytest.raises(ZeroDivisionError):
        mmsim.simulate("square", lambda *_: 1 / 0, overrides=SHORT)
    with pytest.raises(ValueError, match="torque"):
        mmsim.simulate("square", lambda *_: [0.0] * 4, overrides=SHORT)
    with pytest.raises(ValueError, match="faults"):
        mmsim.simulate("square-faults", lambda *_: [0.0] * 5, overrides=SHORT)
    with pytest.raises(ValueError, match=r"\(q, nu\)"):
        mmsim.simulate("square", plant=lambda *_: 3, overrides=SHORT)


def test_pickles_and_files_give_the_run_back(tmp_path):
    run = mmsim.simulate("square", overrides=SHORT)
    again = pickle.loads(pickle.dumps(run))
    back = mmsim.Run.load(run.save(tmp_path / "run.npz"))
    for other in (again, back):
        assert other.digest == run.digest
        assert other.metrics == run.metrics
        assert all((other.columns()[name] == values).all() for name, values in run.columns().items())
        assert other.scenario == run.scenario
    log = run.save(tmp_path / "run.mcap")
    assert log.read_bytes().startswith(b"\x89MCAP0\r\n")
    with pytest.raises(ValueError, match="npz or .mcap"):
        run.save(tmp_path / "run.csv")


def test_a_scenario_travels_with_its_files(tmp_path):
    robot = mmsim.Robot(base_mass_kg=30.0)
    text = robot.to_toml().replace("[robot]\n", "").replace("[[robot.link]]", "[[link]]")
    (tmp_path / "robot.toml").write_text(text)
    file = tmp_path / "own.toml"
    file.write_text(mmsim.scenarios()["square"].replace('preset = "thesis"', 'file = "robot.toml"'))
    scenario = mmsim.Scenario(file, SHORT)
    assert scenario.robot == robot
    packed = pickle.dumps(scenario)
    (tmp_path / "robot.toml").unlink()
    file.unlink()
    there = pickle.loads(packed)
    assert there == scenario
    assert mmsim.simulate(there).digest == mmsim.simulate(scenario).digest


def test_errors_have_places(tmp_path):
    file = tmp_path / "bad.toml"
    file.write_text('name = "x"\n[simulation]\nduration_s = 1.0\n[trajectory]\nkind = "sqare"\n')
    with pytest.raises(mmsim.ScenarioError) as caught:
        mmsim.Scenario(file)
    error = caught.value
    assert (error.file, error.line, error.key) == (str(file), 5, "trajectory.kind")
    assert error.nearest == "square" or "square" in (error.expected or "")
    again = pickle.loads(pickle.dumps(error))
    assert (again.line, again.problems) == (error.line, error.problems)
    with pytest.raises(mmsim.ScenarioError) as caught:
        mmsim.simulate("square", overrides={"plant.mass_scal": 2})
    assert caught.value.nearest == "mass_scale"
    with pytest.raises(mmsim.ScenarioError, match="no bundled scenario"):
        mmsim.simulate("sqare")


def test_ctrl_c_ends_a_run(tmp_path):
    # What starts the tests may have Ctrl-C ignored.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
        with pytest.raises(KeyboardInterrupt):
            mmsim.simulate("square", overrides={"simulation.duration_s": 20_000.0}, log=tmp_path / "long.mcap")
    finally:
        signal.signal(signal.SIGINT, before)
    assert (tmp_path / "long.mcap").read_bytes().endswith(b"\x89MCAP0\r\n")


def test_tables_and_figures():
    pandas = pytest.importorskip("pandas")
    pytest.importorskip("matplotlib")
    run = mmsim.simulate("square", overrides=SHORT)
    table = run.to_pandas()
    assert isinstance(table, pandas.DataFrame)
    assert table["tau.right"].iloc[7] == run.tau[7, 0]
    assert len(run.plot().axes) == 4


def test_bundled_scenarios_are_those_of_the_command():
    listed = cli("scenario", "list").stdout
    assert all(name in listed for name in mmsim.scenarios())


def test_the_command_has_its_exit_codes(tmp_path):
    assert cli("--scenario", "nothing").returncode == 2
    assert cli("--version").stdout.strip() == f"mmsim {mmsim.__version__}"
