"""fuzzytool: every operator of .fis files; samples from end to end as MATLAB does."""

from collections.abc import Callable
from functools import reduce
from operator import and_, or_

import fuzzytool as ft
import numpy as np

from fis import Rule, System, Term, Variable

Array = np.ndarray
Shape = Callable[[Array], Array]


def _sigmoid_difference(a1: float, c1: float, a2: float, c2: float) -> Shape:
    one, two = ft.sigmoid(a1, c1), ft.sigmoid(a2, c2)
    return lambda x: np.abs(one(x) - two(x))


def _sigmoid_product(a1: float, c1: float, a2: float, c2: float) -> Shape:
    one, two = ft.sigmoid(a1, c1), ft.sigmoid(a2, c2)
    return lambda x: one(x) * two(x)


# Two shapes of .fis files are not its own and are put together from its sigmoids.
SHAPES: dict[str, Callable[..., Shape]] = {
    "trimf": ft.tri,
    "trapmf": ft.trap,
    "linsmf": ft.ramp_up,
    "linzmf": ft.ramp_down,
    "gaussmf": lambda s, c: ft.gauss(c, s),
    "gauss2mf": lambda s1, c1, s2, c2: ft.gauss2(c1, s1, c2, s2),
    "gbellmf": ft.gbell,
    "sigmf": ft.sigmoid,
    "dsigmf": _sigmoid_difference,
    "psigmf": _sigmoid_product,
    "smf": ft.smf,
    "zmf": ft.zmf,
    "pimf": ft.pimf,
}
AGGREGATIONS = {"max": "max", "probor": "probor", "sum": np.add}


def evaluate(system: System, points: Array, samples: int = 101) -> Array:
    """The outputs at all points.

    What MATLAB calls the centroid, the mean of the samples weighted by their degrees, the peer calls `wtaver`; its
    own centroid halves the first and the last sample.
    """
    inputs = [_variable(f"x{i}", variable, samples) for i, variable in enumerate(system.inputs)]
    arrays = {f"x{i}": column for i, column in enumerate(points.T)}
    infer = _sugeno if system.is_sugeno else _mamdani
    columns = [infer(system, inputs, j, arrays, samples) for j in range(len(system.outputs))]
    return np.column_stack(columns)


def _mamdani(system: System, inputs: list[ft.Variable], j: int, arrays: dict[str, Array], samples: int) -> Array:
    settings = system.settings
    output = _variable("y", system.outputs[j], samples)
    engine = ft.Mamdani(
        tnorm=settings["AndMethod"],
        snorm=settings["OrMethod"],
        implication=settings["ImpMethod"],
        aggregation=AGGREGATIONS[settings["AggMethod"]],
        defuzz={"centroid": "wtaver"}[settings["DefuzzMethod"]],
    )
    for rule in system.rules:
        if rule.outputs[j]:
            engine.rule(_antecedent(rule, inputs), output[f"t{rule.outputs[j]}"], rule.weight)
    return engine.predict(**arrays)


def _sugeno(system: System, inputs: list[ft.Variable], j: int, arrays: dict[str, Array], samples: int) -> Array:
    engine = ft.TSK(tnorm=system.settings["AndMethod"], snorm=system.settings["OrMethod"])
    for rule in system.rules:
        if rule.outputs[j]:
            term = system.outputs[j].terms[rule.outputs[j] - 1]
            engine.rule(_antecedent(rule, inputs), _consequent(term), rule.weight)
    average = engine.predict(**arrays)
    if system.settings["DefuzzMethod"] == "wtaver":
        return average
    # It has no weighted sum: this is its numerator.
    return average * engine.firing(**arrays).sum(axis=0)


def _variable(name: str, description: Variable, samples: int) -> ft.Variable:
    made = ft.Variable(name, (description.lo, description.hi), resolution=samples)
    for k, term in enumerate(description.terms, 1):
        if term.shape in SHAPES:
            made[f"t{k}"] = SHAPES[term.shape](*term.parameters)
    return made


def _antecedent(rule: Rule, inputs: list[ft.Variable]) -> ft.sets.Antecedent:
    clauses = [
        ~variable[f"t{-index}"] if index < 0 else variable[f"t{index}"]
        for variable, index in zip(inputs, rule.inputs, strict=True)
        if index
    ]
    return reduce(or_ if rule.is_or else and_, clauses)


def _consequent(term: Term) -> float | dict[str, float]:
    if term.shape == "constant":
        return term.parameters[0]
    *factors, constant = term.parameters
    return {"const": constant} | {f"x{i}": factor for i, factor in enumerate(factors)}
