"""Fuzzy systems: values known by hand, tables within their bounds, and errors with places."""

import pickle

import numpy as np
import pytest

import mmsim


def test_the_rule_base_of_the_thesis():
    fis = mmsim.Fis.thesis()
    # One triangle fires alone: its centroid.
    assert fis.evaluate(-1.4) == pytest.approx(1 / 3, abs=1e-12)
    x = np.linspace(-1, 1, 101)
    assert fis.evaluate(x).shape == (101,)
    assert fis.evaluate(x.reshape(1, 101)).shape == (1, 101)
    one_by_one = [float(fis.evaluate(value)) for value in x]
    assert (fis.evaluate(x) == one_by_one).all()


def test_a_table_keeps_its_bound():
    fis = mmsim.Fis.smooth()
    table = fis.compile(bits=16)
    x = np.linspace(-1, 1, 2001)
    worst = np.abs(table.evaluate(x) - fis.evaluate(x)).max()
    # The inputs are rounded to 16 bits besides.
    assert worst <= table.error + 2e-4
    assert table.bytes < 1000
    assert "SMOOTH" in table.to_rust("SMOOTH")
    assert "int16_t" in table.to_c("smooth")


def test_two_inputs_are_the_last_axis():
    text = (
        "[System]\nName='sum'\nType='sugeno'\nNumInputs=2\nNumOutputs=1\nNumRules=1\nAndMethod='prod'\nOrMethod='max'\n"
        "ImpMethod='prod'\nAggMethod='sum'\nDefuzzMethod='wtaver'\n"
        "[Input1]\nName='a'\nRange=[-1 1]\nNumMFs=1\nMF1='any':'trapmf',[-2 -1 1 2]\n"
        "[Input2]\nName='b'\nRange=[-1 1]\nNumMFs=1\nMF1='any':'trapmf',[-2 -1 1 2]\n"
        "[Output1]\nName='y'\nRange=[-2 2]\nNumMFs=1\nMF1='plus':'linear',[1 1 0]\n"
        "[Rules]\n1 1, 1 (1) : 1\n"
    )
    fis = mmsim.Fis.from_text(text)
    x = np.array([[0.25, 0.5], [-0.5, 0.125]])
    np.testing.assert_allclose(fis.evaluate(x), x.sum(axis=1))
    assert pickle.loads(pickle.dumps(fis)).evaluate(x[0]) == fis.evaluate(x[0])
    with pytest.raises(ValueError, match="2 inputs"):
        fis.evaluate(np.zeros(3))


def test_errors_have_places(tmp_path):
    file = tmp_path / "bad.fis"
    lines = mmsim.Fis.smooth().to_fis().splitlines()
    number = next(number for number, line in enumerate(lines) if line.startswith("MF1="))
    lines[number] = lines[number].replace("trimf", "trinf").replace("trapmf", "trabmf")
    file.write_text("\n".join(lines))
    with pytest.raises(mmsim.FuzzyError) as caught:
        mmsim.Fis.from_file(file)
    assert (caught.value.file, caught.value.line) == (str(file), number + 1)
    with pytest.raises(FileNotFoundError):
        mmsim.Fis.from_file(tmp_path / "none.fis")
