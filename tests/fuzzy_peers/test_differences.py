"""Where engines mean different things by the same file: how far they are apart, and that this is all there is.

Law: a disagreement has a reason that can be named. Each test states the two definitions, shows that the difference is
there (its size is in the table at the end of the run), and where it can, that the peer's own membership values
or another way to put the question to the peer give our number within 1e-12. A test that finds two engines agreeing
where they are said to differ fails: then the peer has changed.
"""

from pathlib import Path

import fuzzylite as fl
import fuzzytool as ft
import numpy as np
import pytest
import simpful as sf

import definition
import fis
import fuzzylab_peer
import fuzzylite_peer
import fuzzytool_peer
import ours
import report
import simpful_peer

TOLERANCE = 1e-12
TITLE = "Largest difference of definitions"


def differ(what: str, peer: str, found: np.ndarray, expected: np.ndarray, at_least: float) -> float:
    """The size of a difference, which is one: no less than `at_least`."""
    size = report.largest(found, expected)
    report.enter(TITLE, what, peer, f"{size:.3g}")
    assert size >= at_least
    return size


def agree(found: np.ndarray, expected: np.ndarray) -> None:
    """Nothing but rounding is between the two."""
    assert report.largest(found, expected) <= TOLERANCE


def test_where_samples_lie() -> None:
    """The same number of samples, from end to end or in the middles: 0.008 of an output between -1 and 1."""
    path = ours.FILES["thesis"]
    points = ours.grid(fis.read(path))
    ends, middles = (ours.evaluate(path, points, accuracy) for accuracy in ("ends:100", "midpoints:100"))
    differ("samples at the ends or in the middles", "own", ends, middles, 5e-3)
    just_below_zero = np.array([[-1e-9]])
    for accuracy, value in [("exact", 0.8889), ("ends:101", 0.8954), ("midpoints:100", 0.8888)]:
        assert ours.evaluate(path, just_below_zero, accuracy)[0, 0] == pytest.approx(value, abs=6e-5)


def test_nothing_fires(tmp_path: Path) -> None:
    """Without a firing rule an output is the middle of its range here and in fuzzytool, 0 in simpful, else NaN."""
    path = ours.variant(ours.FILES["tipper"], tmp_path, rules=["0 1, 1 (1) : 1", "0 2, 3 (1) : 1"])
    system = fis.read(path)
    point = np.array([[5.0, 5.0]])
    assert ours.evaluate(path, point, "exact") == ours.evaluate(path, point, "ends:101") == [[15.0]]
    assert fuzzytool_peer.evaluate(system, point) == [[15.0]]
    assert simpful_peer.run(simpful_peer.build(system), system, point, 101) == [[0.0]]
    assert np.isnan(fuzzylite_peer.evaluate(system, point)).all()
    assert np.isnan(fuzzylab_peer.evaluate(system, point)).all()


def test_nothing_fires_in_a_sum(tmp_path: Path) -> None:
    """Of nothing a weighted sum is 0 here and an average the middle of the range; in pyfuzzylite both are NaN."""
    rules = ["3 0, 4 (1) : 1"]
    for method, value in [("wtsum", 0.0), ("wtaver", 50.0)]:
        path = ours.variant(ours.FILES["fan"], tmp_path, rules=rules, DefuzzMethod=method)
        cold = np.array([[12.0, 50.0]])
        assert ours.evaluate(path, cold, "exact") == [[value]]
        assert np.isnan(fuzzylite_peer.evaluate(fis.read(path), cold)).all()


def test_outside_the_range() -> None:
    """An input outside counts as the nearer end, as in MATLAB; pyfuzzylite does so only when told to, simpful never.

    The term PB of the thesis's system goes on to 4.6, so that its rule fires less and less beyond 1.4.
    """
    path = ours.FILES["thesis"]
    system = fis.read(path)
    points = np.linspace(-4.5, 4.5, 901)[:, None]
    found = ours.evaluate(path, points, "midpoints:100")
    agree(found, fuzzylite_peer.evaluate(system, points))
    free = fuzzylite_peer.run(fuzzylite_peer.build(system, clamp=False), points)
    differ("input outside of its range", "pyfuzzylite", found, free, 1e-4)
    at_4 = np.array([[4.0]])
    unclamped = simpful_peer.run(simpful_peer.build(system), system, at_4, 101)
    differ("input outside of its range", "simpful", ours.evaluate(path, at_4, "ends:101"), unclamped, 1e-4)


def test_input_is_nan() -> None:
    """No number goes in: the middle of the range comes out here, and NaN in pyfuzzylite."""
    path = ours.FILES["tipper"]
    points = np.array([[np.nan, 5.0], [5.0, np.nan]])
    assert (ours.evaluate(path, points, "exact") == 15.0).all()
    assert np.isnan(fuzzylite_peer.evaluate(fis.read(path), points[:1])).all()


@pytest.mark.parametrize("method", ["som", "lom"])
def test_smallest_and_largest_by_magnitude(method: str, tmp_path: Path) -> None:
    """Smallest and largest of the highest samples: by magnitude in MATLAB, Octave and here, by value in pyfuzzylite."""
    path = ours.variant(ours.FILES["steering"], tmp_path, DefuzzMethod=method)
    system = fis.read(path)
    points = ours.random_points(system, 2801)
    found = ours.evaluate(path, points, "midpoints:100")
    by_value = fuzzylite_peer.evaluate(system, points)
    differ(f"{method} by magnitude or by value", "pyfuzzylite", found, by_value, 1.0)
    agree(found, definition.evaluate(system, points, definition.middles))


def test_bisector(tmp_path: Path) -> None:
    """The first sample with half of the whole at or below it, here as in MATLAB; in pyfuzzylite the nearest to half.

    The two are at most one part apart.
    """
    path = ours.variant(ours.FILES["steering"], tmp_path, DefuzzMethod="bisector")
    system = fis.read(path)
    points = ours.random_points(system, 2801)
    found = ours.evaluate(path, points, "midpoints:100")
    nearest = fuzzylite_peer.evaluate(system, points)
    one_part = 0.8
    assert differ("bisector, first or nearest", "pyfuzzylite", found, nearest, 0.5) <= one_part + TOLERANCE
    agree(found, definition.evaluate(system, points, definition.middles))


def test_weights_of_sugeno_rules(tmp_path: Path) -> None:
    """The average is over strengths with their weights; simpful divides by those without, and gets too little."""
    plain = ours.FILES["anfis"]
    points = ours.random_points(fis.read(plain), 100)
    found = ours.evaluate(plain, points, "exact")
    system = fis.read(plain)
    agree(found, simpful_peer.run(simpful_peer.build(system), system, points, 101))

    rules = [f"{1 + k // 3} {1 + k % 3}, {1 + k} ({0.5 if k % 2 else 1}) : 1" for k in range(9)]
    path = ours.variant(plain, tmp_path, rules=rules)
    system = fis.read(path)
    found = ours.evaluate(path, points, "exact")
    less = simpful_peer.run(simpful_peer.build(system), system, points, 101)
    differ("weights of Sugeno rules", "simpful", found, less, 0.1)
    weighted = definition.strengths(system, points)
    unweighted = definition.strengths(fis.read(plain), points)
    agree(found, less * (unweighted.sum(axis=0) / weighted.sum(axis=0))[:, None])


def test_sugeno_rules_with_the_same_conclusion() -> None:
    """Rules that conclude the same term count each by itself; pyfuzzylite given an aggregation joins them first.

    Two rules of `fan` conclude `medium`: with the maximum, the stronger alone would count.
    """
    path = ours.FILES["fan"]
    system = fis.read(path)
    points = ours.grid(system)
    found = ours.evaluate(path, points, "exact")
    agree(found, fuzzylite_peer.run(fuzzylite_peer.build(system), points))
    joined = fuzzylite_peer.run(fuzzylite_peer.build(system, sugeno_aggregation=fl.Maximum()), points)
    differ("Sugeno rules of one conclusion", "pyfuzzylite", found, joined, 0.1)


def test_vertical_sides() -> None:
    """Where a foot and the peak coincide the side is vertical; simpful's triangle is 1 on all of that side.

    In the thesis's system one term ends at 0 with a vertical side and one begins: with simpful's triangles both would
    hold fully everywhere. By points its sets have vertical sides, and it agrees.
    """
    path = ours.FILES["thesis"]
    system = fis.read(path)
    points = ours.random_points(system, 100)

    def own_triangles(term: fis.Term, name: str) -> sf.FuzzySet:
        if term.shape == "trimf":
            return sf.TriangleFuzzySet(*term.parameters, term=name)
        return simpful_peer.fuzzy_set(term, name)

    found = ours.evaluate(path, points, "ends:101")
    shouldered = simpful_peer.run(simpful_peer.build(system, own_triangles), system, points, 101)
    differ("vertical side of a triangle", "simpful", found, shouldered, 0.5)
    agree(found, simpful_peer.run(simpful_peer.build(system), system, points, 101))


def test_the_end_of_a_vertical_side(tmp_path: Path) -> None:
    """A step has its upper value where it stands; pyfuzzylite's S shape the lower one, and its ramp has none."""
    step = ("smf", "linsmf")
    x = np.array([1.0 - 1e-9, 1.0, 1.0 + 1e-9])
    own, ramp = (definition.degrees(fis.Term(shape, (1.0, 1.0)), x) for shape in step)
    assert own.tolist() == [0.0, 0.0, 1.0]
    assert np.isnan(ramp).all()
    for shape in step:
        path = tmp_path / "step.fis"
        text = ours.FILES["fan"].read_text()
        path.write_text(text.replace("'zmf',[14 24]", f"'{shape}',[20 20]"))
        path = ours.variant(path, tmp_path, rules=["1 0, 4 (1) : 1"], DefuzzMethod="wtsum")
        points = np.column_stack([x + 19.0, np.full(3, 50.0)])
        assert ours.evaluate(path, points, "exact")[:, 0].tolist() == [0.0, 100.0, 100.0]


def test_not_in_a_conclusion(tmp_path: Path) -> None:
    """`THEN y is NOT t` concludes the complement of t, here as in MATLAB; in pyfuzzylite it negates the strength.

    pyfuzzylite has no complement of a term, but takes a term made from its own.
    """
    path = ours.variant(ours.FILES["steering"], tmp_path, rules=["1, -1 (1) : 1", "3, 3 (1) : 1", "5, -5 (1) : 1"])
    system = fis.read(path)
    points = ours.random_points(system, 500)
    found = ours.evaluate(path, points, "midpoints:100")

    class Complement(fl.Term):
        """What a term leaves."""

        def __init__(self, name: str, term: fl.Term) -> None:
            super().__init__(name)
            self.term = term

        def membership(self, x: fl.Scalar) -> fl.Scalar:
            """One minus the degree."""
            return 1.0 - self.term.membership(x)

    def concluding(texts: list[str]) -> np.ndarray:
        engine = fuzzylite_peer.build(fis.read(ours.FILES["steering"]))
        output = engine.output_variables[0]
        output.terms += [Complement(f"not_{term.name}", term) for term in output.terms]
        engine.rule_blocks[0].rules = [fl.Rule.create(text) for text in texts]
        for rule in engine.rule_blocks[0].rules:
            rule.load(engine)
        return fuzzylite_peer.run(engine, points)

    agree(found, concluding([f"if x0 is t{i} then y0 is {c}" for i, c in [(1, "not_t1"), (3, "t3"), (5, "not_t5")]]))
    negated = concluding([f"if x0 is t{i} then y0 is {c}" for i, c in [(1, "not t1"), (3, "t3"), (5, "not t5")]])
    differ("NOT in a conclusion", "pyfuzzylite", found, negated, 1.0)
    agree(ours.evaluate(path, points, "ends:101"), definition.evaluate(system, points))


def test_two_gaussians_that_overlap() -> None:
    """`gauss2mf` with crossed centres is a product below 1 everywhere; fuzzytool and simpful take one side."""
    x = np.linspace(-3.0, 3.0, 601)
    parameters = (1.0, 1.0, 1.0, -1.0)
    product = definition.degrees(fis.Term("gauss2mf", parameters), x)
    agree(product, np.exp(-0.5 * (np.minimum(x - 1.0, 0.0) ** 2 + np.maximum(x + 1.0, 0.0) ** 2)))
    differ("gauss2mf with crossed centres", "fuzzytool", product, ft.gauss2(1.0, 1.0, -1.0, 1.0)(x), 0.1)
    peer = sf.DoubleGaussian_MF(1.0, 1.0, -1.0, 1.0)
    differ("gauss2mf with crossed centres", "simpful", product, np.array([peer(v) for v in x]), 0.1)


def test_halved_ends() -> None:
    """fuzzytool's own centroid weighs the first and the last sample by half (trapezoidal rule), MATLAB's does not."""
    path = ours.FILES["thesis"]
    system = fis.read(path)
    y = np.linspace(-1.0, 1.0, 101)
    points = ours.grid(system, 281)
    fired = definition.strengths(system, points)
    sets = list(definition.output_sets(system, 0, fired, y))
    halved = np.array([[ft.defuzz.centroid(y, m)] for m in sets])
    whole = np.array([[ft.defuzz.weighted_average(y, m)] for m in sets])
    found = ours.evaluate(path, points, "ends:101")
    agree(found, whole)
    differ("weight of the end samples", "fuzzytool", found, halved, 1e-3)
