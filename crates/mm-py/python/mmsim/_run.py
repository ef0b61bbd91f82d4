"""Runs of scenarios: ``simulate`` and ``Run``."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Union

import numpy as np
import numpy.typing as npt

from . import _mmsim
from ._mmsim import Controller, Scenario

if TYPE_CHECKING:
    import pandas
    from matplotlib.figure import Figure

Array = npt.NDArray[np.float64]
#: ``controller(t, q, nu, p_d, dp_d, ddp_d) -> tau``
ControlFunction = Callable[[float, Array, Array, Array, Array, Array], npt.ArrayLike]
#: ``plant(t, q, nu, tau, period_s) -> (q, nu)``
PlantFunction = Callable[[float, Array, Array, Array, float], "tuple[npt.ArrayLike, npt.ArrayLike]"]
#: A scenario, a file, or the name of a bundled one.
ScenarioLike = Union[Scenario, str, "os.PathLike[str]"]
#: Dotted keys of a scenario and their values.
Overrides = Mapping[str, Any]

#: Names of the columns of five, for tables.
CHANNELS = ("forward", "yaw", "joint1", "joint2", "joint3")
_NAMES = {
    "q": ("x", "y", "heading", "joint1", "joint2", "joint3"),
    "tau": ("right", "left", "joint1", "joint2", "joint3"),
    "tip": ("x", "y", "z"),
    "reference": ("x", "y", "z"),
    "reference_velocity": ("x", "y", "z"),
    "error": ("x", "y", "z"),
}


def scenarios() -> dict[str, str]:
    """Names and texts of the bundled scenarios.

    Examples
    --------
    >>> import mmsim
    >>> "square-compare" in mmsim.scenarios()
    True
    """
    return _mmsim.bundled()


def loaded(
    scenario: ScenarioLike,
    overrides: Overrides | None = None,
    controller: str | None = None,
    seed: int | None = None,
) -> Scenario:
    """The scenario that arguments stand for."""
    changes = dict(overrides) if overrides else None
    if isinstance(scenario, Scenario):
        if changes is None and controller is None and seed is None:
            return scenario
        return scenario.edited(changes, controller=controller, seed=seed)
    return Scenario(scenario, changes, controller=controller, seed=seed)


class Progress:
    """A line on the terminal that tells how far something is; silent where there is no terminal."""

    def __init__(self, what: str, total: float, wanted: bool | None) -> None:
        self._what, self._total = what, total
        self._shown = sys.stderr.isatty() if wanted is None else wanted

    def __call__(self, done: float) -> None:
        if self._shown:
            print(f"\r{self._what} {100 * done / self._total:.0f} %", end="", file=sys.stderr, flush=True)

    def clear(self) -> None:
        """Takes the line away."""
        if self._shown:
            print("\r" + " " * (len(self._what) + 7) + "\r", end="", file=sys.stderr, flush=True)


class Run:
    """What a run gives: samples at the scenario's ``log_rate_hz``, metrics over every control period, and the digest.

    Attributes
    ----------
    t : numpy.ndarray, shape (k,)
        Time, s.
    q, nu, tau : numpy.ndarray, shape (k, 6), (k, 5), (k, 5)
        True configuration and velocity, torque at the plant's input.
    tip, reference, reference_velocity, error : numpy.ndarray, shape (k, 3)
        True tip, where it should be, how fast that moves, tip minus reference; m, m/s.
    nu_c, sliding, equivalent, fuzzy, learned : numpy.ndarray, shape (k, 5)
        Signals of the controller.
    disturbance : numpy.ndarray, shape (k, 5)
        Disturbances as generalized forces.
    saturated : numpy.ndarray of bool, shape (k,)
    summary : dict
        The object of ``mmsim run --json``; ``metrics``, ``digest``, ``warnings`` and ``ended`` are taken from it.
    scenario : Scenario

    Examples
    --------
    >>> import mmsim
    >>> run = mmsim.simulate("square", overrides={"simulation.duration_s": 1.0})
    >>> run.q.shape
    (100, 6)
    """

    t: Array
    q: Array
    nu: Array
    tau: Array
    tip: Array
    reference: Array
    reference_velocity: Array
    error: Array
    nu_c: Array
    sliding: Array
    equivalent: Array
    fuzzy: Array
    learned: Array
    disturbance: Array
    saturated: npt.NDArray[np.bool_]

    def __init__(self, scenario: Scenario, columns: Mapping[str, Any], summary: dict[str, Any]) -> None:
        self.scenario = scenario
        self.summary = summary
        self._columns = tuple(columns)
        for name, values in columns.items():
            setattr(self, name, values)

    @property
    def metrics(self) -> dict[str, Any]:
        """Metrics of the summary, by name."""
        metrics: dict[str, Any] = self.summary["metrics"]
        return metrics

    @property
    def digest(self) -> str:
        """XXH3-128 of the trajectory, the same on the command line and in Rust."""
        return str(self.summary["digest"])

    @property
    def warnings(self) -> list[str]:
        """What one should know besides the numbers."""
        return list(self.summary["warnings"])

    @property
    def ended(self) -> str:
        """``"finished"``, ``"diverged"``, ``"refused"``, ``"fault"`` or ``"interrupted"``."""
        return str(self.summary["ended"])

    def columns(self) -> dict[str, Any]:
        """All arrays by name."""
        return {name: getattr(self, name) for name in self._columns}

    def to_pandas(self) -> pandas.DataFrame:
        """The samples as a table, a row each, indexed by time; columns such as ``q.x`` and ``tau.right``."""
        import pandas

        data: dict[str, Any] = {}
        for name, values in self.columns().items():
            if name == "t":
                continue
            if values.ndim == 1:
                data[name] = values
                continue
            for index, channel in enumerate(_NAMES.get(name, CHANNELS)):
                data[f"{name}.{channel}"] = values[:, index]
        return pandas.DataFrame(data, index=pandas.Index(self.t, name="t"))

    def plot(self) -> Figure:
        """Path from above, error, torques and sliding variables; a matplotlib figure.

        Examples
        --------
        >>> import mmsim
        >>> run = mmsim.simulate("square", overrides={"simulation.duration_s": 1.0})
        >>> run.plot().savefig("square.png")  # doctest: +SKIP
        """
        from matplotlib.figure import Figure

        figure = Figure(figsize=(10, 7), layout="constrained")
        axes = figure.subplots(2, 2)
        above, errors, torques, surfaces = axes.flat
        above.plot(self.reference[:, 0], self.reference[:, 1], "k--", lw=1, label="desired")
        above.plot(self.tip[:, 0], self.tip[:, 1], lw=1.5, label="tip")
        above.plot(self.q[:, 0], self.q[:, 1], lw=1, label="base")
        above.set(xlabel="x, m", ylabel="y, m", aspect="equal", title="from above")
        for index, axis in enumerate("xyz"):
            errors.plot(self.t, 1e3 * self.error[:, index], lw=1, label=axis)
        errors.set(xlabel="t, s", ylabel="mm", title="error of the tip")
        for index, name in enumerate(_NAMES["tau"]):
            torques.plot(self.t, self.tau[:, index], lw=1, label=name)
        torques.set(xlabel="t, s", ylabel="N m", title="torques")
        for index, name in enumerate(CHANNELS):
            surfaces.plot(self.t, self.sliding[:, index], lw=1, label=name)
        surfaces.set(xlabel="t, s", ylabel="m/s, rad/s", title="sliding variables")
        for axis, values in ((errors, 1e3 * self.error), (surfaces, self.sliding)):
            # The start may be a thousand times what follows: linear for 99 % of the samples, logarithmic beyond.
            most = float(np.percentile(np.abs(values), 99)) if values.size else 0.0
            if 0 < 20 * most < np.abs(values).max():
                axis.set_yscale("symlog", linthresh=most)
        for axis in axes.flat:
            axis.grid(visible=True, lw=0.3)
            axis.legend(fontsize=8)
        figure.suptitle(f"{self.summary['scenario']}, {self.summary['controller']}")
        return figure

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Writes the run: ``.npz`` with all arrays and the summary, or ``.mcap``, the log of the command line.

        The log is written by running the scenario again, which gives the same bits; a run with a controller or a plant in
        Python is logged by ``simulate(..., log=path)``.

        Raises
        ------
        ValueError
            Another ending, or a run that cannot be repeated.
        """
        path = Path(path)
        if path.suffix == ".npz":
            header = {"summary": self.summary, "scenario": self.scenario.__reduce__()[1][0]}
            np.savez_compressed(path, header=np.array(json.dumps(header)), **self.columns())
        elif path.suffix == ".mcap":
            if self.summary["controller"] == "python" or self.summary.get("plant") == "python":
                raise ValueError("a run with Python in the loop cannot be repeated: simulate(..., log=path)")
            _mmsim.log_run(self.scenario, path)
        else:
            raise ValueError(f"{path}: expected a name that ends in .npz or .mcap")
        return path

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Run:
        """Reads what ``save`` wrote to an ``.npz``."""
        with np.load(path, allow_pickle=False) as file:
            header = json.loads(str(file["header"]))
            columns = {name: file[name] for name in file.files if name != "header"}
        return cls(Scenario._restored(header["scenario"]), columns, header["summary"])

    def __repr__(self) -> str:
        summary = self.summary
        rmse = self.metrics["rmse_m"]["norm"]
        return (
            f"Run({summary['scenario']!r}, {summary['controller']!r}, {self.ended}, {summary['simulated_s']:g} s, "
            f"rmse {1e3 * rmse:.3g} mm, digest {self.digest[:8]})"
        )

    def __reduce__(self) -> tuple[Any, ...]:
        return (Run, (self.scenario, self.columns(), self.summary))


def simulate(
    scenario: ScenarioLike,
    controller: str | Controller | ControlFunction | None = None,
    *,
    overrides: Overrides | None = None,
    seed: int | None = None,
    plant: PlantFunction | None = None,
    log: str | os.PathLike[str] | None = None,
    progress: bool | None = None,
) -> Run:
    """Runs a scenario.

    Parameters
    ----------
    scenario : Scenario, str or os.PathLike
        A scenario, a file, or the name of a bundled one.
    controller : str, Controller or callable, optional
        Kind of the controller instead of the scenario's; or one that is updated from here: a ``Controller``, or
        ``controller(t, q, nu, p_d, dp_d, ddp_d) -> tau``. Torques are cut to the robot's limits.
    overrides : mapping, optional
        Dotted keys and their values, such as ``{"plant.mass_scale": 1.25}``.
    seed : int, optional
        Seed of everything random.
    plant : callable, optional
        ``plant(t, q, nu, tau, period_s) -> (q, nu)``: moves the robot in the model's place.
    log : str or os.PathLike, optional
        Writes an MCAP log besides.
    progress : bool, optional
        Whether to show how far it is; by default on a terminal.

    Returns
    -------
    Run

    Raises
    ------
    ScenarioError
        With ``file``, ``line``, ``column`` and ``key``.
    KeyboardInterrupt
        At Ctrl-C; a log is then whole up to there.

    Examples
    --------
    >>> import mmsim
    >>> run = mmsim.simulate("square", controller="bsmc", overrides={"simulation.duration_s": 1.0})
    >>> run.summary["controller"]
    'bsmc'
    """
    kind = controller if isinstance(controller, str) else None
    function: Any = None if isinstance(controller, str) else controller
    if isinstance(function, Controller):
        stack = function

        def function(
            _t: float, q: Array, nu: Array, p_d: Array, dp_d: Array, ddp_d: Array
        ) -> npt.ArrayLike:
            return stack.update(q, nu, p_d, dp_d, ddp_d)

    ready = loaded(scenario, overrides, kind, seed)
    shown = Progress(ready.name, 1.0, progress)
    try:
        columns = _mmsim.simulate(ready, function, plant, log, shown)
    finally:
        shown.clear()
    summary = columns.pop("summary")
    if plant is not None:
        summary["plant"] = "python"
    return Run(ready, columns, summary)
