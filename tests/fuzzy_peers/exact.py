"""The centroid of a piecewise-linear set without sampling error, in two ways that share nothing with ours."""

from itertools import combinations

import numpy as np
from skfuzzy.defuzzify import defuzz

import definition
from fis import System, Term

Array = np.ndarray

STRAIGHT = ("trimf", "trapmf", "linsmf", "linzmf")
QUADRATURE_POINTS = 1_000_000
# Fits into a cache, and is too small for numpy to spread a product over threads, which costs more than it saves.
BLOCK = 1 << 13


def is_straight(system: System) -> bool:
    """Whether the output sets consist of straight lines."""
    shapes = {term.shape for output in system.outputs for term in output.terms}
    return not system.is_sugeno and shapes <= set(STRAIGHT) and system.settings["AggMethod"] != "probor"


def by_quadrature(system: System, points: Array) -> Array:
    """The centroids by 10^6 samples in the middles of equal parts."""
    columns = []
    fired = definition.strengths(system, points)
    for j, output in enumerate(system.outputs):
        step = (output.hi - output.lo) / QUADRATURE_POINTS
        area, moment = np.zeros(len(points)), np.zeros(len(points))
        for start in range(0, QUADRATURE_POINTS, BLOCK):
            k = np.arange(start, min(start + BLOCK, QUADRATURE_POINTS))
            y = output.lo + (k + 0.5) * step
            for i, m in enumerate(definition.output_sets(system, j, fired, y)):
                area[i] += m.sum()
                moment[i] += m @ y
        columns.append(moment / area)
    return np.column_stack(columns)


def by_corners(system: System, points: Array) -> Array:
    """The centroids by scikit-fuzzy's defuzzification, which is exact for straight lines between its samples.

    It is given every corner of the set as a sample. A vertical side is two samples next to each other.
    """
    columns = []
    fired = definition.strengths(system, points)
    for j, output in enumerate(system.outputs):
        corners = [corner for term in output.terms for corner in _corners(term)]
        corners = np.unique([output.lo, output.hi, *(c for c in corners if output.lo < c < output.hi)])
        column = []
        for weights in fired.T:
            y = _with_crossings(system, j, weights, corners)
            column.append(defuzz(y, next(definition.output_sets(system, j, weights[:, None], y)), "centroid"))
        columns.append(column)
    return np.column_stack(columns)


def _corners(term: Term) -> list[float]:
    return [near for corner in term.parameters for near in _vertical(term, corner)]


def _vertical(term: Term, corner: float) -> list[float]:
    doubled = term.parameters.count(corner) > 1
    return [np.nextafter(corner, -np.inf), corner, np.nextafter(corner, np.inf)] if doubled else [corner]


def _with_crossings(system: System, j: int, weights: Array, y: Array) -> Array:
    """The corners `y` of the terms, and all places between them where two lines of the set can cross.

    A rule that fires draws two of them between neighbouring corners: its term and its cut.
    """
    lines = []
    for weight, rule in zip(weights, system.rules, strict=True):
        if weight > 0.0 and rule.outputs[j]:
            own = definition.signed_degrees(system.outputs[j], rule.outputs[j], y)
            lines.append(own * weight if system.settings["ImpMethod"] == "prod" else own)
            lines.append(np.full_like(y, weight))
    found = [y]
    for one, other in combinations(lines, 2):
        gap = one - other
        left, right = gap[:-1], gap[1:]
        crosses = left * right < 0.0
        part = left[crosses] / (left[crosses] - right[crosses])
        found.append(y[:-1][crosses] + part * np.diff(y)[crosses])
    return np.unique(np.concatenate(found))
