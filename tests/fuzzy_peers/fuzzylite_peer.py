"""pyfuzzylite: every operator and shape of .fis files; samples at the middles of equal parts."""

from collections.abc import Callable

import fuzzylite as fl
import numpy as np

from fis import Rule, System, Term, Variable

Array = np.ndarray

SHAPES: dict[str, Callable[..., fl.Term]] = {
    "trimf": lambda a, b, c: fl.Triangle("", a, b, c),
    "trapmf": lambda a, b, c, d: fl.Trapezoid("", a, b, c, d),
    "linsmf": lambda a, b: fl.Ramp("", a, b),
    "linzmf": lambda a, b: fl.Ramp("", b, a),
    "gaussmf": lambda s, c: fl.Gaussian("", c, s),
    "gauss2mf": lambda s1, c1, s2, c2: fl.GaussianProduct("", c1, s1, c2, s2),
    "gbellmf": lambda a, b, c: fl.Bell("", c, a, b),
    "sigmf": lambda a, c: fl.Sigmoid("", c, a),
    "dsigmf": lambda a1, c1, a2, c2: fl.SigmoidDifference("", c1, a1, a2, c2),
    "psigmf": lambda a1, c1, a2, c2: fl.SigmoidProduct("", c1, a1, a2, c2),
    "smf": lambda a, b: fl.SShape("", a, b),
    "zmf": lambda a, b: fl.ZShape("", a, b),
    "pimf": lambda a, b, c, d: fl.PiShape("", a, b, c, d),
    "constant": lambda value: fl.Constant("", value),
    "linear": lambda *factors: fl.Linear("", list(factors)),
}
T_NORMS = {"min": fl.Minimum, "prod": fl.AlgebraicProduct}
S_NORMS = {"max": fl.Maximum, "probor": fl.AlgebraicSum, "sum": fl.UnboundedSum}
DEFUZZIFIERS = {
    "centroid": fl.Centroid,
    "bisector": fl.Bisector,
    "mom": fl.MeanOfMaximum,
    "som": fl.SmallestOfMaximum,
    "lom": fl.LargestOfMaximum,
}


def term(description: Term, name: str) -> fl.Term:
    """The peer's term."""
    made = SHAPES[description.shape](*description.parameters)
    made.name = name
    return made


def build(
    system: System, resolution: int = 100, clamp: bool = True, sugeno_aggregation: fl.SNorm | None = None
) -> fl.Engine:
    """The peer's engine.

    Without an aggregation a Sugeno engine sums the strengths of the rules that conclude the same term.
    """
    settings = system.settings
    inputs = [
        fl.InputVariable(
            name=f"x{i}", minimum=variable.lo, maximum=variable.hi, lock_range=clamp, terms=_terms(variable)
        )
        for i, variable in enumerate(system.inputs)
    ]
    if system.is_sugeno:
        average = settings["DefuzzMethod"] == "wtaver"
        defuzzifier = fl.WeightedAverage() if average else fl.WeightedSum()
        aggregation, implication = sugeno_aggregation, None
    else:
        defuzzifier = DEFUZZIFIERS[settings["DefuzzMethod"]](resolution)
        aggregation = S_NORMS[settings["AggMethod"]]()
        implication = T_NORMS[settings["ImpMethod"]]()
    outputs = [
        fl.OutputVariable(
            name=f"y{i}",
            minimum=variable.lo,
            maximum=variable.hi,
            aggregation=aggregation,
            defuzzifier=defuzzifier,
            terms=_terms(variable),
        )
        for i, variable in enumerate(system.outputs)
    ]
    block = fl.RuleBlock(
        conjunction=T_NORMS[settings["AndMethod"]](),
        disjunction=S_NORMS[settings["OrMethod"]](),
        implication=implication,
        activation=fl.General(),
        rules=[fl.Rule.create(rule_text(rule)) for rule in system.rules],
    )
    return fl.Engine("", input_variables=inputs, output_variables=outputs, rule_blocks=[block])


def run(engine: fl.Engine, points: Array) -> Array:
    """The outputs at all points, a row each."""
    engine.restart()
    engine.input_values = points
    with np.errstate(invalid="ignore", divide="ignore"):
        engine.process()
    outputs = [np.broadcast_to(y.value, len(points)) for y in engine.output_variables]
    return np.column_stack(outputs)


def evaluate(system: System, points: Array) -> Array:
    """The outputs at all points, sampled at the middles of 100 parts."""
    return run(build(system), points)


def rule_text(rule: Rule) -> str:
    """The rule in the peer's language."""
    joint = " or " if rule.is_or else " and "
    inputs = joint.join(
        f"x{i} is {'not ' if index < 0 else ''}t{abs(index)}" for i, index in enumerate(rule.inputs) if index
    )
    outputs = " and ".join(f"y{i} is t{index}" for i, index in enumerate(rule.outputs) if index)
    return f"if {inputs} then {outputs} with {rule.weight!r}"


def _terms(variable: Variable) -> list[fl.Term]:
    return [term(description, f"t{i}") for i, description in enumerate(variable.terms, 1)]
