"""Every example in the documentation of the module is run."""

import contextlib
import doctest
import inspect
import io
import pathlib

import pytest

import mmsim
from mmsim import _batch, _run

ROOT = pathlib.Path(__file__).parents[3]
#: Functions and classes, whose methods have examples too.
NAMES = [name for name in mmsim.__all__ if inspect.isclass(getattr(mmsim, name))]


def examples():
    finder = doctest.DocTestFinder(exclude_empty=True)
    for module in (mmsim, _run, _batch):
        yield from (test for test in finder.find(module) if test.examples and test.name == module.__name__)
    for function in (mmsim.compare, mmsim.scenarios, mmsim.simulate, mmsim.sweep, mmsim.tune):
        yield from finder.find(function)
    for name in NAMES:
        kind = getattr(mmsim, name)
        for label, item in [(name, kind), *((f"{name}.{key}", value) for key, value in vars(kind).items())]:
            text = getattr(item, "__doc__", None)
            if text and ">>>" in text:
                yield doctest.DocTestParser().get_doctest(text, {}, label, None, None)


@pytest.mark.parametrize("test", list(examples()), ids=lambda test: test.name)
def test_example(test):
    result = doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE).run(test)
    assert result.attempted
    assert not result.failed


@pytest.mark.parametrize("name", mmsim.__all__)
def test_everything_is_documented(name):
    assert name.startswith("__") or inspect.getdoc(getattr(mmsim, name))


@pytest.mark.parametrize("name", NAMES)
def test_signatures_stand_where_tools_look_for_them(name):
    kind = getattr(mmsim, name)
    for item in (kind, *(value for key, value in vars(kind).items() if callable(value) and not key.startswith("_"))):
        assert "\n--\n" not in (item.__doc__ or "")


@pytest.mark.parametrize("path", ["README.md", "crates/mm-py/README.md"])
def test_the_readme_prints_what_it_says(path):
    text = (ROOT / path).read_text(encoding="utf-8")
    example = text.split("```python\n")[1].split("```")[0]
    said = [line.split("  # ")[1] for line in example.splitlines() if line.startswith("print(")]
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(example, {})
    assert said and printed.getvalue().splitlines() == said
