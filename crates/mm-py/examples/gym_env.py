"""A Gymnasium environment: the robot, a reference of a bundled scenario, and torques that the agent chooses.

    python gym_env.py

checks the environment with Gymnasium's own checker and runs one episode with the controller as the agent.
"""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces

import mmsim


class TrackingEnv(gymnasium.Env[np.ndarray, np.ndarray]):
    """The tip of the robot is to follow the reference of a scenario.

    Observation, float64, shape (20,): q (6), nu (5), error of the tip (3), velocity (3) and acceleration (3) of the reference. Action,
    float32, shape (5,): torques as fractions of their limits. Reward: minus the error in metres, times the period. An episode
    ends at the scenario's end (truncated) or when the tip is a metre away (terminated).
    """

    metadata: dict[str, Any] = {"render_modes": []}

    def __init__(self, scenario: str = "square", period_s: float = 5e-3, duration_s: float = 10.0) -> None:
        overrides = {"simulation.duration_s": duration_s, "controller.estimator.kind": "none"}
        self.scenario = mmsim.Scenario(scenario, overrides)
        self.robot, self.trajectory = self.scenario.robot, self.scenario.trajectory
        self.period_s, self.duration_s = period_s, duration_s
        p = self.robot.params
        self.limits = np.array([p["wheel_torque_limit_n_m"]] * 2 + [link["torque_limit_n_m"] for link in p["link"]])
        self.action_space = spaces.Box(-1.0, 1.0, (5,), np.float32)
        self.observation_space = spaces.Box(-np.inf, np.inf, (20,), np.float64)
        # Where the scenario starts.
        start = mmsim.simulate(self.scenario, overrides={"simulation.duration_s": 1e-3}, progress=False)
        self.start = start.q[0], start.nu[0]

    def observation(self) -> np.ndarray:
        """What the agent sees."""
        p, dp, ddp = self.trajectory.at(self.t)
        return np.concatenate([self.q, self.nu, self.robot.tip_position(self.q) - p, dp, ddp])

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[np.ndarray, dict[str, Any]]:
        """Back to the start, with joints turned by up to 0.05 rad."""
        super().reset(seed=seed, options=options)
        self.t, (q, self.nu) = 0.0, self.start
        self.q = q + np.concatenate([np.zeros(3), self.np_random.uniform(-0.05, 0.05, 3)])
        return self.observation(), {}

    def step(self, action: np.ndarray) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        """One period with a torque."""
        tau = np.clip(np.asarray(action, dtype=np.float64), -1, 1) * self.limits
        for _ in range(5):
            self.q, self.nu = self.robot.step(self.q, self.nu, tau, self.period_s / 5)
        self.t += self.period_s
        seen = self.observation()
        error = float(np.linalg.norm(seen[11:14]))
        return seen, -error * self.period_s, not error < 1.0, self.t >= self.duration_s, {"error_m": error}


def episode(env: TrackingEnv, seed: int = 0) -> float:
    """RMS error of an episode with the controller as the agent, m."""
    seen, _ = env.reset(seed=seed)
    ctrl = mmsim.Controller(env.robot, period_s=env.period_s)
    squares = []
    while True:
        p = env.robot.tip_position(seen[:6]) - seen[11:14]
        tau = ctrl.update(seen[:6], seen[6:11], p, seen[14:17], seen[17:20])
        seen, _, terminated, truncated, info = env.step(tau / env.limits)
        squares.append(info["error_m"] ** 2)
        if terminated or truncated:
            return float(np.sqrt(np.mean(squares)))


if __name__ == "__main__":
    from gymnasium.utils.env_checker import check_env

    environment = TrackingEnv()
    check_env(environment, skip_render_check=True)
    print(f"RMS error of an episode: {1e3 * episode(environment):.3f} mm")
