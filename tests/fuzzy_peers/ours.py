"""The engine under test, by the example `evaluate` of mm-fis, and the points at which engines are compared."""

import io
import os
import subprocess
from pathlib import Path

import numpy as np

from fis import System

Array = np.ndarray

ROOT = Path(__file__).resolve().parents[2]
FILES = {
    path.stem: path
    for folder in ("scenarios/fis", "crates/mm-fis/tests/systems")
    for path in sorted((ROOT / folder).glob("*.fis"))
}
POINTS_PER_INPUT = {1: 2801, 2: 101, 3: 22}


def evaluate(path: Path, points: Array, accuracy: str) -> Array:
    """Our outputs at all points, a row each."""
    lines = "".join(",".join(map(repr, row)) + "\n" for row in points.tolist())
    command = [os.environ["FUZZY_EVALUATE"], str(path), accuracy]
    run = subprocess.run(command, input=lines, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr
    return np.loadtxt(io.StringIO(run.stdout), delimiter=",", ndmin=2)


def grid(system: System, count: int = 0) -> Array:
    """Evenly spaced points over the ranges of the inputs, ends included: 2,801 for one input, or above 10,000."""
    count = count or POINTS_PER_INPUT[len(system.inputs)]
    axes = [np.linspace(variable.lo, variable.hi, count) for variable in system.inputs]
    return np.column_stack([axis.ravel() for axis in np.meshgrid(*axes, indexing="ij")])


def random_points(system: System, count: int) -> Array:
    """The same pseudo-random points every time."""
    uniform = np.random.default_rng(1975).random((count, len(system.inputs)))
    lo = np.array([variable.lo for variable in system.inputs])
    hi = np.array([variable.hi for variable in system.inputs])
    return lo + uniform * (hi - lo)


def variant(path: Path, folder: Path, rules: list[str] | None = None, **settings: str) -> Path:
    """A copy of a file with other settings or rules."""
    head, _, tail = path.read_text().partition("[Rules]")
    body = tail if rules is None else "\n" + "\n".join(rules) + "\n"
    if rules is not None:
        settings["NumRules"] = str(len(rules))
    lines = []
    for line in head.splitlines():
        key = line.partition("=")[0]
        if key in settings:
            value = settings[key]
            line = f"{key}={value}" if value.isdigit() else f"{key}='{value}'"
        lines.append(line)
    copy = folder / f"{path.stem}-variant.fis"
    copy.write_text("\n".join(lines) + "\n[Rules]" + body)
    return copy
