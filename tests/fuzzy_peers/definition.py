"""Our definitions written down plainly over pyfuzzylite's membership values: slow, and easy to check by eye.

It tells a difference of definition from an error: where a peer defines something else, what the peer's own
membership values give under our definition has to be what our engine gives.
"""

from collections.abc import Callable, Iterator

import numpy as np

import fuzzylite_peer
from fis import Rule, System, Term, Variable

Array = np.ndarray

T_NORMS = {"min": np.minimum, "prod": np.multiply}
S_NORMS = {"max": np.maximum, "probor": lambda a, b: a + b - a * b, "sum": np.add}


def degrees(term: Term, x: Array) -> Array:
    """The peer's membership values."""
    return np.asarray(fuzzylite_peer.term(term, "t").membership(x))


def signed_degrees(variable: Variable, index: int, x: Array) -> Array:
    """Degree of a term, or of its complement for a negative index."""
    own = degrees(variable.terms[abs(index) - 1], x)
    return 1.0 - own if index < 0 else own


def strengths(system: System, points: Array) -> Array:
    """Firing strength of every rule (row) at every point (column); a point outside a range counts as the nearer end."""
    settings = system.settings

    def strength(rule: Rule) -> Array:
        join = S_NORMS[settings["OrMethod"]] if rule.is_or else T_NORMS[settings["AndMethod"]]
        joined = None
        for variable, index, column in zip(system.inputs, rule.inputs, points.T, strict=True):
            if index:
                own = signed_degrees(variable, index, np.clip(column, variable.lo, variable.hi))
                joined = own if joined is None else join(joined, own)
        neutral = np.full(len(points), 0.0 if rule.is_or else 1.0)
        return rule.weight * (neutral if joined is None else joined)

    return np.array([strength(rule) for rule in system.rules])


def output_sets(system: System, j: int, fired: Array, y: Array) -> Iterator[Array]:
    """The aggregated set of output `j` over the samples `y`, for one column of `strengths` after the other.

    What is equal for all of them is computed once; rules without strength add nothing to any aggregation.
    """
    imply = T_NORMS[system.settings["ImpMethod"]]
    aggregate = S_NORMS[system.settings["AggMethod"]]
    indices = [rule.outputs[j] for rule in system.rules]
    shapes = {index: signed_degrees(system.outputs[j], index, y) for index in set(indices) if index}
    for weights in fired.T:
        joined = None
        for weight, index in zip(weights, indices, strict=True):
            if index and weight > 0.0:
                shaped = imply(weight, shapes[index])
                joined = shaped if joined is None else aggregate(joined, shaped)
        yield np.zeros_like(y) if joined is None else joined


def defuzzify(method: str, y: Array, m: Array, middle: float) -> float:
    """One number for a set sampled at `y`; the middle of the range where nothing fired."""
    if not m.any():
        return middle
    highest = y[m == m.max()]
    match method:
        case "centroid":
            return float(m @ y / m.sum())
        case "bisector":
            return float(y[np.argmax(np.cumsum(m) >= 0.5 * m.sum())])
        case "mom":
            return float(highest.mean())
        case "som":
            return float(highest[np.argmin(np.abs(highest))])
        case "lom":
            return float(highest[np.argmax(np.abs(highest))])
    raise ValueError(method)


def ends(output: Variable) -> Array:
    """101 samples from end to end."""
    return np.linspace(output.lo, output.hi, 101)


def middles(output: Variable) -> Array:
    """Samples in the middles of 100 parts.

    Rounded so that the two next to the middle of a range about 0 have the same magnitude: som and lom compare them.
    """
    step = (output.hi - output.lo) / 100.0
    return (output.lo + 0.5 * step) + np.arange(100) * step


def evaluate(system: System, points: Array, samples: Callable[[Variable], Array] = ends) -> Array:
    """The outputs of a Mamdani system at all points."""
    columns = []
    fired = strengths(system, points)
    for j, output in enumerate(system.outputs):
        y = samples(output)
        middle = 0.5 * (output.lo + output.hi)
        method = system.settings["DefuzzMethod"]
        columns.append([defuzzify(method, y, m, middle) for m in output_sets(system, j, fired, y)])
    return np.column_stack(columns)
