"""Our engine and its peers compute the same outputs wherever their definitions agree.

Law: a fuzzy system is its file; engines that mean the same by it differ by rounding only. Reference: four engines from
PyPI, each fed by a reader of .fis files that shares nothing with ours. Points: 2,801 for one input, a grid of more
than 10,000 for several. Tolerance: 1e-12, with outputs up to 100 in magnitude; about 100 samples are added up.

What each peer means by the outputs:

- pyfuzzylite samples in the middles of 100 parts of an output's range: our `midpoints:100`;
- fuzzytool, simpful and fuzzylab sample at 101 points from end to end, as MATLAB does: our `ends:101`;
- Sugeno systems have no samples.

A peer is left out where it lacks a feature: simpful and fuzzylab know minimum implication only and few shapes, fuzzylab
neither NOT nor Sugeno nor anything but the maximum as aggregation. fuzzytool takes for the highest samples all that are
nearly highest, and pyfuzzylite has other definitions of bisector, som and lom: these are in `test_differences.py`.
"""

from pathlib import Path

import numpy as np
import pytest

import definition
import fis
import fuzzylab_peer
import fuzzylite_peer
import fuzzytool_peer
import ours
import report
import simpful_peer

TOLERANCE = 1e-12
# What they can do of it, at fewer points for two inputs: both take seconds for what the other two do in a tenth of one.
SIMPFUL_AND_FUZZYLAB = ["steering", "thesis", "tipper"]
POINTS_PER_INPUT = {1: 2801, 2: 51}
ALL = sorted(ours.FILES)
MAMDANI = [name for name in ALL if not fis.read(ours.FILES[name]).is_sugeno]


def check(path: Path, peer: str, points: np.ndarray, expected: np.ndarray, accuracy: str) -> None:
    """Our outputs are the peer's."""
    difference = report.largest(ours.evaluate(path, points, accuracy), expected)
    report.enter(report.AGREEMENT, path.stem, f"{peer}, {accuracy}", f"{difference:.1e}")
    assert difference <= TOLERANCE


def test_there_are_enough_systems() -> None:
    """The thesis's system and at least eight others, at points enough."""
    assert "thesis" in ALL
    assert len(ALL) >= 9
    for name in ALL:
        system = fis.read(ours.FILES[name])
        assert len(ours.grid(system)) >= (2801 if len(system.inputs) == 1 else 10_000)


@pytest.mark.parametrize("name", ALL)
def test_pyfuzzylite(name: str) -> None:
    """Middles of 100 parts; every operator, shape and kind of system."""
    path = ours.FILES[name]
    system = fis.read(path)
    points = ours.grid(system)
    check(path, "pyfuzzylite", points, fuzzylite_peer.evaluate(system, points), "midpoints:100")


@pytest.mark.parametrize("name", ALL)
def test_fuzzytool(name: str) -> None:
    """End to end; every operator, shape and kind of system."""
    path = ours.FILES[name]
    system = fis.read(path)
    points = ours.grid(system)
    check(path, "fuzzytool", points, fuzzytool_peer.evaluate(system, points), "ends:101")


@pytest.mark.parametrize("name", SIMPFUL_AND_FUZZYLAB)
def test_simpful_and_fuzzylab(name: str) -> None:
    """End to end; the second is a port of Octave's toolkit."""
    path = ours.FILES[name]
    system = fis.read(path)
    points = ours.grid(system, POINTS_PER_INPUT[len(system.inputs)])
    check(path, "simpful", points, simpful_peer.evaluate(system, points), "ends:101")
    check(path, "fuzzylab", points, fuzzylab_peer.evaluate(system, points), "ends:101")


@pytest.mark.parametrize("name", MAMDANI)
def test_definition(name: str) -> None:
    """The plain definition, on which other tests lean, agrees too."""
    path = ours.FILES[name]
    system = fis.read(path)
    points = ours.random_points(system, 500)
    found = ours.evaluate(path, points, "ends:101")
    assert report.largest(found, definition.evaluate(system, points)) <= TOLERANCE


@pytest.mark.parametrize("method", ["mom", "som", "lom", "bisector"])
def test_other_defuzzifications(method: str, tmp_path: Path) -> None:
    """fuzzylab has MATLAB's definitions of all of them: som and lom go by magnitude, and of two by the lower.

    The rule base of `steering` has no mirror image, so that no running sum meets exactly half of the whole, where
    rounding would decide on the sample.
    """
    path = ours.variant(ours.FILES["steering"], tmp_path, DefuzzMethod=method)
    system = fis.read(path)
    points = ours.grid(system)
    found = ours.evaluate(path, points, "ends:101")
    difference = report.largest(found, fuzzylab_peer.evaluate(system, points))
    report.enter(report.AGREEMENT, f"steering, {method}", "fuzzylab, ends:101", f"{difference:.1e}")
    assert difference <= TOLERANCE
    assert report.largest(found, definition.evaluate(system, points)) <= TOLERANCE


def test_mean_of_maximum_in_the_middles(tmp_path: Path) -> None:
    """pyfuzzylite's mean of the highest samples is ours.

    Not on the grid: where a term is cut exactly at the height of a sample, rounding decides whether that sample is
    among the highest, and half a part is gained or lost.
    """
    path = ours.variant(ours.FILES["steering"], tmp_path, DefuzzMethod="mom")
    system = fis.read(path)
    points = ours.random_points(system, 2801)
    difference = report.largest(ours.evaluate(path, points, "midpoints:100"), fuzzylite_peer.evaluate(system, points))
    report.enter(report.AGREEMENT, "steering, mom", "pyfuzzylite, midpoints:100", f"{difference:.1e}")
    assert difference <= TOLERANCE
