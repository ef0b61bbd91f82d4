"""Reads .fis files for the peers; on its own, it shares no code with the reader under test."""

import re
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Term:
    """A fuzzy set, or what a Sugeno rule concludes."""

    shape: str
    parameters: tuple[float, ...]


@dataclass(frozen=True)
class Variable:
    """An input or an output."""

    lo: float
    hi: float
    terms: tuple[Term, ...]


@dataclass(frozen=True)
class Rule:
    """A rule; terms count from 1, negative is NOT, 0 is absent."""

    inputs: tuple[int, ...]
    outputs: tuple[int, ...]
    weight: float
    is_or: bool


@dataclass(frozen=True)
class System:
    """A fuzzy system as its file describes it."""

    settings: dict[str, str]
    inputs: tuple[Variable, ...]
    outputs: tuple[Variable, ...]
    rules: tuple[Rule, ...]

    @property
    def is_sugeno(self) -> bool:
        """Whether rules conclude numbers."""
        return self.settings["Type"] == "sugeno"


def read(path: Path) -> System:
    """Reads a file."""
    sections: dict[str, list[str]] = {}
    lines: list[str] = []
    for line in path.read_text().splitlines():
        line = line.strip()
        if line.startswith("["):
            lines = sections.setdefault(line.strip("[]"), [])
        elif line and line[0] not in "%#":
            lines.append(line)
    settings = {key: value.strip("'\"") for key, value in map(_pair, sections["System"])}

    def variables(kind: str) -> tuple[Variable, ...]:
        numbers = range(1, int(settings[f"Num{kind}s"]) + 1)
        return tuple(_variable(sections[f"{kind}{number}"]) for number in numbers)

    inputs = variables("Input")
    rules = tuple(_rule(line, len(inputs)) for line in sections["Rules"])
    assert len(rules) == int(settings["NumRules"]), path
    return System(settings, inputs, variables("Output"), rules)


def _pair(line: str) -> tuple[str, str]:
    key, _, value = line.partition("=")
    return key.strip(), value.strip()


def _variable(lines: list[str]) -> Variable:
    pairs = dict(map(_pair, lines))
    lo, hi = map(float, pairs["Range"].strip("[]").split())
    terms = []
    for number in range(1, int(pairs["NumMFs"]) + 1):
        found = re.fullmatch(r"'[^']*'\s*:\s*'(\w+)'\s*,\s*\[([^]]*)\]", pairs[f"MF{number}"])
        assert found, pairs[f"MF{number}"]
        terms.append(Term(found[1], tuple(map(float, found[2].split()))))
    return Variable(lo, hi, tuple(terms))


def _rule(line: str, inputs: int) -> Rule:
    found = re.fullmatch(r"([-\d ]+),([-\d ]+)\(([\d.]+)\)\s*:\s*([12])", line)
    assert found, line
    antecedent = tuple(map(int, found[1].split()))
    assert len(antecedent) == inputs, line
    return Rule(antecedent, tuple(map(int, found[2].split())), float(found[3]), found[4] == "2")
