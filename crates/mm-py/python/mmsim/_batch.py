"""Many runs: ``compare``, ``sweep``, ``tune``, ``reproduce``."""

from __future__ import annotations

import math
import os
import time
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, CancelledError, Executor, Future, ThreadPoolExecutor, wait
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _mmsim
from ._mmsim import Scenario, ScenarioError
from ._run import Overrides, Progress, Run, ScenarioLike, loaded, simulate

if TYPE_CHECKING:
    import pandas

#: What is kept of a sample.
QUANTITIES = (
    "rmse_m",
    "max_error_m",
    "itae_m_s2",
    "torque_tv_n_m_per_s",
    "saturated_fraction",
    "max_speed_m_s",
)
#: A chunk of samples is made to last this long, s, so that sending it does not count.
_CHUNK_S = 2.0

Row = tuple[int, int, str, float, Sequence[float], str]


@dataclass(frozen=True)
class Comparison:
    """Runs of one scenario with several controllers; ``runs`` by controller, in the order asked for."""

    runs: dict[str, Run]

    def metric(self, name: str) -> dict[str, Any]:
        """A metric of every run, by a dotted name such as ``"itae_m_s2.sum"``."""
        found = {}
        for kind, run in self.runs.items():
            value: Any = run.metrics
            for key in name.split("."):
                value = value[int(key)] if isinstance(value, list) else value[key]
            found[kind] = value
        return found

    def to_pandas(self) -> pandas.DataFrame:
        """The metrics as a table, a row for each controller."""
        import pandas

        table = pandas.json_normalize([run.metrics for run in self.runs.values()])
        return table.set_index(pandas.Index(list(self.runs), name="controller"))

    def __repr__(self) -> str:
        lines = [f"{'':22}{'ITAE sum':>12}{'RMSE, mm':>12}{'variation':>12}"]
        for kind, run in self.runs.items():
            m = run.metrics
            itae, variation = m["itae_m_s2"]["sum"], m["torque_tv_n_m_per_s"]["sum"]
            lines.append(f"{kind:22}{itae:12.5g}{1e3 * m['rmse_m']['norm']:12.4g}{variation:12.5g}")
        return "\n".join(lines)


def compare(
    scenario: ScenarioLike,
    controllers: Iterable[str],
    *,
    overrides: Overrides | None = None,
    seed: int | None = None,
    jobs: int | None = None,
) -> Comparison:
    """Runs one scenario with several controllers, on all cores.

    Parameters
    ----------
    scenario : Scenario, str or os.PathLike
    controllers : iterable of str
    overrides, seed
        As of ``simulate``.
    jobs : int, optional
        Threads; as many as there are cores by default.

    Examples
    --------
    >>> import mmsim
    >>> both = mmsim.compare("square-compare", ["bsmc", "bfsmc"], overrides={"simulation.duration_s": 1.0})
    >>> list(both.runs)
    ['bsmc', 'bfsmc']
    """
    ready = [loaded(scenario, overrides, kind, seed) for kind in controllers]
    with ThreadPoolExecutor(jobs or os.cpu_count()) as pool:
        runs = list(pool.map(lambda one: simulate(one, progress=False), ready))
    return Comparison({one.controller: run for one, run in zip(ready, runs)})


@dataclass(frozen=True)
class Sweep:
    """Samples of a sweep.

    Attributes
    ----------
    scenario : Scenario
    seed : int
    rows : list of tuple
        Number, seed, how it ended, time simulated, quantities, digest.
    report : dict
        The object of ``mmsim sweep --json``.
    """

    scenario: Scenario
    seed: int
    rows: list[Row]
    report: dict[str, Any]

    @property
    def values(self) -> npt.NDArray[np.float64]:
        """The quantities, shape (samples, 6), in the order of the columns of ``to_pandas``."""
        return np.array([row[4] for row in self.rows])

    @property
    def digests(self) -> list[str]:
        """Digest of every sample."""
        return [row[5] for row in self.rows]

    def sample(self, number: int) -> Scenario:
        """The scenario of a sample."""
        edits = _mmsim.sample_edits(self.scenario, self.seed, number)
        return self.scenario._with_edits(edits)

    def to_pandas(self) -> pandas.DataFrame:
        """The samples as a table."""
        import pandas

        columns = ("sample", "seed", "ended", "simulated_s", *QUANTITIES, "digest")
        flat = [(*row[:4], *row[4], row[5]) for row in self.rows]
        return pandas.DataFrame(flat, columns=list(columns)).set_index("sample")

    def __repr__(self) -> str:
        report = self.report
        return (
            f"Sweep({report['scenario']!r}, {report['controller']!r}, {len(self.rows)} samples, "
            f"{report['failures']} failed)"
        )


def sweep(
    scenario: ScenarioLike,
    samples: int,
    *,
    executor: Executor | None = None,
    controller: str | None = None,
    overrides: Overrides | None = None,
    seed: int | None = None,
    jobs: int | None = None,
    chunk: int | None = None,
    retries: int = 2,
    progress: bool | None = None,
) -> Sweep:
    """Runs many random samples of one scenario: plants, disturbances and starts as its ``[sweep]`` says.

    Parameters
    ----------
    scenario : Scenario, str or os.PathLike
    samples : int
    executor : concurrent.futures.Executor, optional
        Where to run them: a process pool, ``dask.distributed``'s ``client.get_executor()``, MPI's ``MPIPoolExecutor``. Without
        one, threads of this process. The result is the same.
    controller, overrides
        As of ``simulate``.
    seed : int, optional
        Seed of the sweep; the scenario's by default.
    jobs : int, optional
        Threads where there is no executor; as many as there are cores by default.
    chunk : int, optional
        Samples sent at a time; by default as many as take about two seconds.
    retries : int
        How often a chunk that a worker lost is sent again.

    Returns
    -------
    Sweep

    Examples
    --------
    >>> import mmsim
    >>> result = mmsim.sweep("square", 4, overrides={"simulation.duration_s": 0.5})
    >>> len(result.rows)
    4
    """
    if samples < 1:
        raise ValueError(f"samples: expected at least 1, got {samples}")
    ready = loaded(scenario, overrides, controller)
    seed = ready.seed if seed is None else seed
    shown = Progress(f"{ready.name}: sweep", samples, progress)
    try:
        if executor is None:
            rows = _mmsim.sweep_rows(ready, seed, 0, samples, jobs, shown)
        else:
            rows = _elsewhere(executor, (ready, seed, samples), chunk, retries, shown)
    finally:
        shown.clear()
    again = ["run", "--scenario", str(scenario) if not isinstance(scenario, Scenario) else ready.name]
    again += [word for edit in ready.edits for word in ("--set", edit)]
    return Sweep(ready, seed, rows, _mmsim.sweep_report(ready, seed, rows, again))


def _chunk(scenario: Scenario, seed: int, first: int, end: int) -> list[Row]:
    """Runs some samples: what is sent to a worker."""
    return _mmsim.sweep_rows(scenario, seed, first, end, 1)


def _pieces(first: int, end: int, size: int) -> Iterator[tuple[int, int]]:
    for start in range(first, end, size):
        yield start, min(start + size, end)


def _elsewhere(
    executor: Executor, work: tuple[Scenario, int, int], chunk: int | None, retries: int, shown: Progress
) -> list[Row]:
    scenario, seed, samples = work
    rows: dict[int, list[Row]] = {}
    first = 0
    if chunk is None:
        # The first sample, here, says how long one takes.
        begin = time.perf_counter()
        rows[0] = _chunk(scenario, seed, 0, 1)
        took = max(time.perf_counter() - begin, 1e-6)
        workers = getattr(executor, "_max_workers", None) or 8
        chunk = max(1, min(math.ceil(_CHUNK_S / took), math.ceil((samples - 1) / workers) or 1))
        first = 1
    if chunk < 1:
        raise ValueError(f"chunk: expected at least 1, got {chunk}")
    tried: dict[Future[list[Row]], tuple[int, int, int]] = {}

    def send(start: int, end: int, attempt: int) -> None:
        tried[executor.submit(_chunk, scenario, seed, start, end)] = (start, end, attempt)

    for start, end in _pieces(first, samples, chunk):
        send(start, end, 0)
    done = sum(map(len, rows.values()))
    try:
        while tried:
            # Asked now and then, so that Ctrl-C is heard.
            finished, _ = wait(list(tried), timeout=0.1, return_when=FIRST_COMPLETED)
            for future in finished:
                start, end, attempt = tried.pop(future)
                try:
                    rows[start] = future.result()
                except (ScenarioError, KeyboardInterrupt):
                    raise
                except (Exception, CancelledError):
                    if attempt >= retries:
                        raise
                    send(start, end, attempt + 1)
                    continue
                done += end - start
            shown(done)
    finally:
        for future in tried:
            future.cancel()
    return [row for start in sorted(rows) for row in rows[start]]


@dataclass(frozen=True)
class Tuned:
    """The gains that cost least.

    Attributes
    ----------
    controller : str
    gains : dict
        By key of ``[controller.gains]``: arguments of ``Controller``.
    cost, default_cost, given_cost : float
        Of these gains, the defaults, and those of the scenario.
    metrics : dict
    digest : str
    toml : str
        A file for ``controller.gains_file``.
    """

    controller: str
    gains: dict[str, Any]
    factors: list[float]
    cost: float
    default_cost: float
    given_cost: float
    metrics: dict[str, Any] | None
    digest: str | None
    toml: str

    def __repr__(self) -> str:
        return f"Tuned({self.controller!r}, cost {self.cost:.5g}, by default {self.default_cost:.5g}, gains {self.gains})"


def tune(
    scenario: ScenarioLike,
    controller: str | None = None,
    *,
    overrides: Overrides | None = None,
    seed: int | None = None,
    jobs: int | None = None,
    progress: bool | None = None,
) -> Tuned:
    """Searches for the gains that cost least on a scenario, by a particle swarm as its ``[tune]`` says.

    Parameters
    ----------
    scenario : Scenario, str or os.PathLike
    controller : str, optional
        Kind of the controller instead of the scenario's.
    overrides : mapping, optional
        For example ``{"tune.particles": 8, "tune.iterations": 10}``.
    seed : int, optional
        Seed of the search.

    Returns
    -------
    Tuned

    Examples
    --------
    >>> import mmsim
    >>> few = {"simulation.duration_s": 0.5, "tune.particles": 2, "tune.iterations": 2}
    >>> mmsim.tune("square", "bsmc", overrides=few).controller
    'bsmc'
    """
    ready = loaded(scenario, overrides, controller)
    total = ready.tune_runs
    shown = Progress(f"{ready.name}: tune", total, progress)
    try:
        return Tuned(**_mmsim.tune(ready, seed, jobs, shown))
    finally:
        shown.clear()


def reproduce(
    out: str | os.PathLike[str] = "out/reproduce",
    *,
    overrides: Overrides | None = None,
    jobs: int | None = None,
) -> dict[str, Any]:
    """Runs all experiments of the thesis: figures and tables in ``out``, the object of ``mmsim reproduce --json`` returned.

    Parameters
    ----------
    out : str or os.PathLike
        Folder for the files.
    overrides : mapping, optional
        Laid over every scenario.
    """
    return _mmsim.reproduce(out, jobs or 0, dict(overrides) if overrides else None)
