"""Many runs: the same results wherever they are computed."""

from concurrent.futures import Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor

import numpy as np
import pytest

import mmsim

SHORT = {"simulation.duration_s": 0.3}


def test_compare_keeps_the_order():
    both = mmsim.compare("square", ["bfsmc", "bsmc"], overrides=SHORT)
    assert list(both.runs) == ["bfsmc", "bsmc"]
    alone = mmsim.simulate("square", "bsmc", overrides=SHORT)
    assert both.runs["bsmc"].digest == alone.digest
    assert both.metric("itae_m_s2.sum")["bsmc"] == alone.metrics["itae_m_s2"]["sum"]
    assert "bfsmc" in repr(both)


def test_executors_give_the_local_result():
    local = mmsim.sweep("square", 12, overrides=SHORT, seed=3)
    assert len(set(local.digests)) == 12
    with ProcessPoolExecutor(2) as pool:
        there = mmsim.sweep("square", 12, overrides=SHORT, seed=3, executor=pool, chunk=5)
    assert there.rows == local.rows
    assert there.report == local.report
    with ThreadPoolExecutor(2) as pool:
        assert mmsim.sweep("square", 12, overrides=SHORT, seed=3, executor=pool).rows == local.rows


def test_a_sample_can_be_run_again():
    result = mmsim.sweep("square", 3, overrides=SHORT)
    run = mmsim.simulate(result.sample(2))
    assert run.digest == result.digests[2]
    assert run.metrics["rmse_m"]["norm"] == result.values[2, 0]
    assert np.isfinite(result.values).all()


class Flaky(Executor):
    """Loses every chunk once."""

    def __init__(self) -> None:
        self.lost: set = set()

    def submit(self, function, /, *arguments):
        future: Future = Future()
        if arguments[2:] in self.lost:
            future.set_result(function(*arguments))
        else:
            self.lost.add(arguments[2:])
            future.set_exception(OSError("the worker is gone"))
        return future


def test_lost_chunks_are_sent_again():
    local = mmsim.sweep("square", 6, overrides=SHORT)
    assert mmsim.sweep("square", 6, overrides=SHORT, executor=Flaky(), chunk=2).rows == local.rows
    with pytest.raises(OSError, match="gone"):
        mmsim.sweep("square", 6, overrides=SHORT, executor=Flaky(), chunk=2, retries=0)


def test_dask_gives_the_local_result():
    distributed = pytest.importorskip("distributed")
    local = mmsim.sweep("square", 10, overrides=SHORT)
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,
        distributed.Client(cluster) as client,
    ):
        there = mmsim.sweep("square", 10, overrides=SHORT, executor=client.get_executor(), chunk=3)
    assert there.rows == local.rows


def test_tuning_gives_gains_that_make_a_controller():
    few = {**SHORT, "tune.particles": 3, "tune.iterations": 2}
    tuned = mmsim.tune("square", "bsmc", overrides=few)
    assert tuned.cost <= tuned.default_cost
    run = mmsim.simulate("square", "bsmc", overrides={**SHORT, "controller.gains": tuned.gains})
    assert run.digest == tuned.digest
    mmsim.Controller(mmsim.Robot.thesis(), "bsmc", **tuned.gains)
    assert mmsim.tune("square", "bsmc", overrides=few, jobs=1).gains == tuned.gains


def test_mistakes_are_refused():
    with pytest.raises(ValueError, match="at least 1"):
        mmsim.sweep("square", 0)
    with pytest.raises(mmsim.ScenarioError):
        mmsim.sweep("square", 2, overrides={"sweep.nothing": 1})
