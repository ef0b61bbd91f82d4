"""Prints the tables after the tests."""

import pytest

import report


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Prints what was measured."""
    for title in report.tables:
        terminalreporter.write_sep("-", title)
        for line in report.lines(title):
            terminalreporter.write_line(line)
