"""Robust trajectory tracking of mobile manipulators: models, controllers, simulation.

A two-wheel differential-drive base carries a three-joint arm whose tip follows a path in space while base and arm cooperate. The
compiled part runs the very code that firmware links; a run in Python, on the command line and in Rust has the same digest.

>>> import mmsim
>>> run = mmsim.simulate("square", overrides={"simulation.duration_s": 2.0})
>>> run.ended
'finished'
"""

from ._batch import Comparison, Sweep, Tuned, compare, reproduce, sweep, tune
from ._mmsim import (
    Command,
    ControlError,
    Controller,
    Fis,
    FuzzyError,
    Robot,
    Scenario,
    ScenarioError,
    Supervisor,
    Table,
    Trajectory,
    __version__,
)
from ._run import Run, scenarios, simulate

__all__ = [
    "Command",
    "Comparison",
    "ControlError",
    "Controller",
    "Fis",
    "FuzzyError",
    "Robot",
    "Run",
    "Scenario",
    "ScenarioError",
    "Supervisor",
    "Sweep",
    "Table",
    "Trajectory",
    "Tuned",
    "__version__",
    "compare",
    "reproduce",
    "scenarios",
    "simulate",
    "sweep",
    "tune",
]
