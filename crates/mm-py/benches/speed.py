"""What the way through Python costs: `python speed.py [MMSIM]`, MMSIM being the command to compare with.

Prints the time of one ``Controller.update``, of a batched forward dynamics per state, and of ``simulate`` beside the command
without a log, each the least of many alternated runs: ratios and not times are what can be compared between machines.
"""

import shutil
import subprocess
import sys
import time

import numpy as np

import mmsim


def least(work, runs: int) -> float:
    """Least time of a call, s."""
    times = []
    for _ in range(runs):
        begin = time.perf_counter()
        work()
        times.append(time.perf_counter() - begin)
    return min(times)


def main() -> None:
    """Measures and prints."""
    robot = mmsim.Robot.thesis()
    ctrl = mmsim.Controller(robot)
    q, nu = np.array([0, 0, 0, 0.1, 1.0, -2.0]), np.zeros(5)
    p, v, a = robot.tip_position(q), np.zeros(3), np.zeros(3)

    def updates() -> None:
        for _ in range(1000):
            ctrl.update(q, nu, p, v, a)

    print(f"Controller.update: {1e3 * least(updates, 50):.2f} us")
    rng = np.random.default_rng(0)
    k = 100_000
    qs, nus, taus = rng.uniform(-2, 2, (k, 6)), rng.uniform(-1, 1, (k, 5)), rng.uniform(-9, 9, (k, 5))
    took = least(lambda: robot.forward_dynamics(qs, nus, taus), 20)
    print(f"forward_dynamics of {k} states: {1e9 * took / k:.1f} ns each")
    command = sys.argv[1] if len(sys.argv) > 1 else shutil.which("mmsim")
    scenario = mmsim.Scenario("square", {"simulation.log_rate_hz": 100.0})
    here, there = [], []
    for _ in range(20):
        here.append(least(lambda: mmsim.simulate(scenario, progress=False), 1))
        words = [command, "--scenario", "square", "--no-log", "--quiet", "--json"]
        there.append(least(lambda: subprocess.run(words, check=True, capture_output=True), 1))
    print(f"simulate: {1e3 * min(here):.1f} ms, the command {1e3 * min(there):.1f} ms, {min(here) / min(there):.2f} of it")


if __name__ == "__main__":
    main()
