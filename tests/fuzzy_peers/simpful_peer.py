"""simpful: minimum implication, min/prod, any aggregation; samples from end to end as MATLAB does."""

from collections.abc import Callable
from functools import cache
from multiprocessing import Pool, cpu_count

import numpy as np
import simpful as sf
from simpful.simpful import probor

from fis import Rule, System, Term, Variable

Array = np.ndarray

# The bell is not its own, but it takes any function.
CURVED: dict[str, Callable[..., Callable[[float], float]]] = {
    "gaussmf": lambda s, c: sf.Gaussian_MF(c, s),
    "gauss2mf": lambda s1, c1, s2, c2: sf.DoubleGaussian_MF(c1, s1, c2, s2),
    "gbellmf": lambda a, b, c: lambda x: 1.0 / (1.0 + abs((x - c) / a) ** (2.0 * b)),
    "sigmf": lambda a, c: sf.Sigmoid_MF(c, a),
}
AGGREGATIONS = {"max": max, "sum": sum, "probor": probor}


def fuzzy_set(description: Term, name: str) -> sf.FuzzySet:
    """The peer's set.

    Straight shapes are given by points, with 0 beyond the outer ones: the peer's own triangle is 1 on the whole
    side where a foot coincides with the peak.
    """
    p = description.parameters
    if description.shape in CURVED:
        return sf.FuzzySet(function=cache(CURVED[description.shape](*p)), term=name)
    corners = {
        "trimf": lambda: [(p[0], 0.0), (p[1], 1.0), (p[2], 0.0)],
        "trapmf": lambda: [(p[0], 0.0), (p[1], 1.0), (p[2], 1.0), (p[3], 0.0)],
        "linsmf": lambda: [(p[0], 0.0), (p[1], 1.0)],
        "linzmf": lambda: [(p[0], 1.0), (p[1], 0.0)],
    }[description.shape]()
    ends = [corners[0][1], corners[-1][1]]
    if corners[0][0] == corners[1][0]:
        corners = corners[1:]
    if corners[-2][0] == corners[-1][0]:
        corners = corners[:-1]
    by_points = sf.FuzzySet(points=corners, term=name, boundary_values=ends)
    return sf.FuzzySet(function=cache(by_points.get_value), term=name)


def build(system: System, make: Callable[[Term, str], sf.FuzzySet] = fuzzy_set) -> sf.FuzzySystem:
    """The peer's system."""
    settings = system.settings
    product = ["AND_PRODUCT"] if settings["AndMethod"] == "prod" else None
    made = sf.FuzzySystem(operators=product, show_banner=False, verbose=False)
    for i, variable in enumerate(system.inputs):
        made.add_linguistic_variable(f"x{i}", _linguistic(variable, make))
    for j, variable in enumerate(system.outputs):
        if not system.is_sugeno:
            made.add_linguistic_variable(f"y{j}", _linguistic(variable, make))
            continue
        for k, description in enumerate(variable.terms, 1):
            _add_consequent(made, f"y{j}t{k}", description)
    disjunction = "OR_p" if settings["OrMethod"] == "probor" else "OR"
    made.add_rules([text for rule in system.rules for text in _rule_texts(rule, system.is_sugeno, disjunction)])
    return made


def run(made: sf.FuzzySystem, system: System, points: Array, samples: int) -> Array:
    """The outputs at all points, a row each."""
    rows = []
    names = [f"y{j}" for j in range(len(system.outputs))]
    aggregation = AGGREGATIONS.get(system.settings["AggMethod"], max)
    for point in points:
        for i, x in enumerate(point):
            made.set_variable(f"x{i}", x)
        if system.is_sugeno:
            found = made.Sugeno_inference(names, ignore_warnings=True)
        else:
            found = made.Mamdani_inference(
                names, subdivisions=samples, aggregation_function=aggregation, ignore_warnings=True
            )
        rows.append([float(found[name]) for name in names])
    return np.array(rows)


def evaluate(system: System, points: Array, samples: int = 101) -> Array:
    """The outputs at all points; spread over the processors, the peer is slow."""
    parts = np.array_split(points, 4 * cpu_count())
    with Pool() as pool:
        return np.vstack(pool.starmap(_evaluate_part, [(system, part, samples) for part in parts]))


def _evaluate_part(system: System, points: Array, samples: int) -> Array:
    return run(build(system), system, points, samples)


def _linguistic(variable: Variable, make: Callable[[Term, str], sf.FuzzySet]) -> sf.LinguisticVariable:
    sets = [make(description, f"t{k}") for k, description in enumerate(variable.terms, 1)]
    return sf.LinguisticVariable(sets, universe_of_discourse=[variable.lo, variable.hi])


def _add_consequent(made: sf.FuzzySystem, name: str, description: Term) -> None:
    if description.shape == "constant":
        made.set_crisp_output_value(name, description.parameters[0])
        return
    *factors, constant = description.parameters
    products = [f"({factor!r})*x{i}" for i, factor in enumerate(factors)]
    made.set_output_function(name, "+".join([*products, f"({constant!r})"]))


def _rule_texts(rule: Rule, is_sugeno: bool, disjunction: str) -> list[str]:
    clauses = [
        f"((NOT (x{i} IS t{-index})))" if index < 0 else f"(x{i} IS t{index})"
        for i, index in enumerate(rule.inputs)
        if index
    ]
    antecedent = clauses[0]
    for clause in clauses[1:]:
        antecedent = f"({antecedent} {disjunction if rule.is_or else 'AND'} {clause})"
    terms = [(j, f"y{j}t{index}" if is_sugeno else f"t{index}") for j, index in enumerate(rule.outputs) if index]
    return [f"IF {antecedent} THEN (y{j} IS {term}) WEIGHT {rule.weight!r}" for j, term in terms]
