"""Our exact centroid is exact, and how far the sampling engines are from it.

Law: the centroid of a set bounded by straight lines has a closed form. References: 10^6 samples in the middles of equal
parts (error of order 1e-12 for a set without a vertical side, 1e-6 with one, in parts of the range), and scikit-fuzzy's
defuzzification, which joins its samples by straight lines and is therefore exact once every corner of the set is a
sample. Tolerances: 1e-6 of the range, and 1e-11 of it.
"""

from pathlib import Path

import numpy as np
import pytest

import exact
import fis
import fuzzylab_peer
import fuzzylite_peer
import fuzzytool_peer
import ours
import report
import simpful_peer
import skfuzzy_peer

STRAIGHT = [name for name, path in sorted(ours.FILES.items()) if exact.is_straight(fis.read(path))]
# Enough to meet every rule, few enough for 10^6 samples each, and for engines that take milliseconds for one.
POINTS = 200
SLOW_POINTS = 100
COARSE = {1: 2801, 2: 45, 3: 13}


def widths(system: fis.System) -> np.ndarray:
    """Widths of the ranges of the outputs."""
    return np.array([output.hi - output.lo for output in system.outputs])


@pytest.mark.parametrize("name", STRAIGHT)
def test_quadrature(name: str) -> None:
    """A million samples."""
    path = ours.FILES[name]
    system = fis.read(path)
    points = ours.random_points(system, POINTS)
    apart = (ours.evaluate(path, points, "exact") - exact.by_quadrature(system, points)) / widths(system)
    assert np.abs(apart).max() <= 1e-6


@pytest.fixture(params=[(name, implication) for name in STRAIGHT for implication in ("min", "prod")])
def path(request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    """A system whose output sets have straight sides, with terms cut off and scaled."""
    name, implication = request.param
    return ours.variant(ours.FILES[name], tmp_path, ImpMethod=implication)


def test_straight_lines_between_all_corners(path: Path) -> None:
    """Two closed forms."""
    system = fis.read(path)
    points = ours.random_points(system, POINTS)
    apart = (ours.evaluate(path, points, "exact") - exact.by_corners(system, points)) / widths(system)
    assert np.abs(apart).max() <= 1e-11


@pytest.mark.parametrize("name", STRAIGHT)
def test_how_far_the_peers_are(name: str) -> None:
    """Each peer as it comes out of its box: none is exact.

    scikit-fuzzy samples the inputs' terms too and joins the samples by straight lines, also across the jump of the
    thesis's system at 0, next to which it is off by up to half of the range. The others stay below a hundredth of it.
    """
    path = ours.FILES[name]
    system = fis.read(path)
    points = ours.grid(system, COARSE[len(system.inputs)])
    few = ours.random_points(system, SLOW_POINTS)
    closed = ours.evaluate(path, points, "exact")
    closed_few = ours.evaluate(path, few, "exact")

    def enter(engine: str, found: np.ndarray, reference: np.ndarray) -> None:
        far = float(np.abs((found - reference) / widths(system)).max())
        report.enter(report.EXACTNESS, name, engine, f"{100.0 * far:.2g}")
        assert 0.0 < far < (0.5 if engine.startswith("scikit-fuzzy") else 0.01)

    enter("pyfuzzylite, 1000 middles", fuzzylite_peer.run(fuzzylite_peer.build(system, 1000), points), closed)
    enter("fuzzytool, 501 points", fuzzytool_peer.evaluate(system, points, 501), closed)
    enter("fuzzytool, 101 points as MATLAB", fuzzytool_peer.evaluate(system, points), closed)
    if name in ("steering", "thesis", "tipper"):
        enter("simpful, 1000 points", simpful_peer.evaluate(system, few, 1000), closed_few)
        enter("fuzzylab, 101 points", fuzzylab_peer.evaluate(system, few), closed_few)
        enter("scikit-fuzzy, 101 points", skfuzzy_peer.evaluate(system, few), closed_few)
