"""What was measured, for the tables at the end of a run."""

from collections import defaultdict

import numpy as np

Array = np.ndarray

AGREEMENT = "Largest difference from the peer, at the peer's own samples"
EXACTNESS = "Largest distance from the exact centroid, in percent of the output's range"
tables: dict[str, dict[str, dict[str, str]]] = defaultdict(lambda: defaultdict(dict))


def largest(a: Array, b: Array) -> float:
    """Largest magnitude of a difference; a NaN counts as infinite."""
    assert a.shape == b.shape, (a.shape, b.shape)
    return float(np.nan_to_num(np.abs(a - b), nan=np.inf).max())


def enter(table: str, row: str, column: str, value: str) -> None:
    """Enters a number into a table."""
    tables[table][row][column] = value


def lines(table: str) -> list[str]:
    """A table as Markdown; a dash where the peer has no such feature."""
    rows = tables[table]
    columns = list(dict.fromkeys(column for row in rows.values() for column in row))
    head = ["system", *columns]
    body = [[row, *(cells.get(column, "-") for column in columns)] for row, cells in sorted(rows.items())]
    return ["| " + " | ".join(line) + " |" for line in [head, ["---"] * len(head), *body]]
