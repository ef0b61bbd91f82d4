"""fuzzylab, a port of Octave's fuzzy-logic-toolkit: three shapes, 101 points, all five defuzzifications of MATLAB."""

import sys
import warnings
from types import ModuleType

import numpy as np

from fis import System, Variable

# It imports its plots with everything else; nothing here draws.
sys.modules.setdefault("matplotlib", ModuleType("matplotlib"))
sys.modules.setdefault("matplotlib.pyplot", ModuleType("matplotlib.pyplot"))
import fuzzylab  # noqa: E402

Array = np.ndarray


def build(system: System) -> fuzzylab.mamfis:
    """The peer's system."""
    settings = system.settings
    made = fuzzylab.mamfis(
        AndMethod=settings["AndMethod"],
        OrMethod=settings["OrMethod"],
        ImplicationMethod=settings["ImpMethod"],
        AggregationMethod=settings["AggMethod"],
        DefuzzificationMethod=settings["DefuzzMethod"],
    )
    made.Inputs = [_variable(variable) for variable in system.inputs]
    made.Outputs = [_variable(variable) for variable in system.outputs]
    made.addRule([[*rule.inputs, *rule.outputs, rule.weight, 2 if rule.is_or else 1] for rule in system.rules])
    return made


def evaluate(system: System, points: Array) -> Array:
    """The outputs at all points, sampled at 101 points."""
    with np.errstate(invalid="ignore"), warnings.catch_warnings():
        # It takes an array of one number for a number.
        warnings.simplefilter("ignore", DeprecationWarning)
        return fuzzylab.evalfis(build(system), points)


def _variable(variable: Variable) -> fuzzylab.fisvar:
    made = fuzzylab.fisvar([variable.lo, variable.hi])
    made.MembershipFunctions = [
        fuzzylab.fismf(description.shape, list(description.parameters)) for description in variable.terms
    ]
    return made
