"""scikit-fuzzy's control systems: minimum and maximum; terms are straight lines between 101 samples of the range."""

from collections.abc import Callable
from functools import reduce
from operator import and_, or_

import numpy as np
import skfuzzy
from skfuzzy import control

from fis import Rule, System, Variable

Array = np.ndarray

SHAPES: dict[str, Callable[..., Array]] = {
    "trimf": lambda x, a, b, c: skfuzzy.trimf(x, [a, b, c]),
    "trapmf": lambda x, a, b, c, d: skfuzzy.trapmf(x, [a, b, c, d]),
    "gaussmf": lambda x, s, c: skfuzzy.gaussmf(x, c, s),
}


def evaluate(system: System, points: Array, samples: int = 101) -> Array:
    """The outputs at all points."""
    inputs = [_fill(control.Antecedent, f"x{i}", variable, samples) for i, variable in enumerate(system.inputs)]
    outputs = [_fill(control.Consequent, f"y{j}", variable, samples) for j, variable in enumerate(system.outputs)]
    rules = [_rule(rule, inputs, outputs) for rule in system.rules]
    simulation = control.ControlSystemSimulation(control.ControlSystem(rules), cache=False)
    rows = []
    for point in points:
        for i, x in enumerate(point):
            simulation.input[f"x{i}"] = x
        simulation.compute()
        rows.append([simulation.output[f"y{j}"] for j in range(len(outputs))])
    return np.array(rows)


def _fill(
    kind: type[control.Antecedent | control.Consequent], name: str, variable: Variable, samples: int
) -> control.Antecedent | control.Consequent:
    made = kind(np.linspace(variable.lo, variable.hi, samples), name)
    for k, term in enumerate(variable.terms, 1):
        made[f"t{k}"] = SHAPES[term.shape](made.universe, *term.parameters)
    return made


def _rule(rule: Rule, inputs: list[control.Antecedent], outputs: list[control.Consequent]) -> control.Rule:
    clauses = [
        ~variable[f"t{-index}"] if index < 0 else variable[f"t{index}"]
        for variable, index in zip(inputs, rule.inputs, strict=True)
        if index
    ]
    concluded = [
        variable[f"t{index}"] % rule.weight for variable, index in zip(outputs, rule.outputs, strict=True) if index
    ]
    return control.Rule(reduce(or_ if rule.is_or else and_, clauses), concluded)
