"""What the way through Python costs: `python speed.py MMSIM DYNAMICS`, the commands `mmsim` and `dynamics` (of mm-benches) built for release.

Prints the time of one ``Controller.update``, of a batched forward dynamics beside a loop in Rust, and of ``simulate`` beside the
command without a log, and of a sweep over a pool of two processes beside one by itself, each the least of alternated runs: ratios and not
times are what can be compared between machines.
"""

import subprocess
import sys
import time
from concurrent.futures import ProcessPoolExecutor

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
    command, dynamics = sys.argv[1:]
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
    here, there = [], []
    for _ in range(20):
        here.append(least(lambda: robot.forward_dynamics(qs, nus, taus), 2))
        out = subprocess.run([dynamics, str(k), "2"], check=True, capture_output=True, text=True).stdout
        there.append(1e-9 * min(map(int, out.split())))
    report(f"forward_dynamics of {k} states, the loop in Rust", here, there)
    scenario = mmsim.Scenario("square", {"simulation.log_rate_hz": 100.0})
    words = [command, "--scenario", "square", "--no-log", "--quiet", "--json"]
    here, there = [], []
    for _ in range(20):
        here.append(least(lambda: mmsim.simulate(scenario, progress=False), 1))
        there.append(least(lambda: subprocess.run(words, check=True, capture_output=True), 1))
    report("simulate, the command", here, there)
    here, there = [], []
    with ProcessPoolExecutor(2) as pool:
        list(pool.map(abs, range(8)))  # the processes are there
        for _ in range(3):
            here.append(least(lambda: mmsim.sweep("square-compare", 80, executor=pool), 1))
            there.append(least(lambda: mmsim.sweep("square-compare", 80, jobs=2), 1))
    report("sweep of 80 over two processes, over two threads", here, there)


def report(names: str, here: list[float], there: list[float]) -> None:
    """Prints the least of both and their ratio."""
    ratio = min(here) / min(there)
    print(f"{names}: {1e3 * min(here):.2f} ms, {1e3 * min(there):.2f} ms, ratio {ratio:.2f}")


if __name__ == "__main__":
    main()
