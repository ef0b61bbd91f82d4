"""The examples, run as a user would."""

import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).parent.parent / "examples"


def run(name: str, *arguments: str) -> str:
    done = subprocess.run(
        [sys.executable, str(EXAMPLES / name), *arguments], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_table_5_2(tmp_path):
    pytest.importorskip("matplotlib")
    said = run("table_5_2.py", str(tmp_path))
    assert "bfsmc-thesis" in said
    pictures = list(tmp_path.glob("square-compare-*.png"))
    assert len(pictures) == 3
    assert all(picture.read_bytes().startswith(b"\x89PNG") for picture in pictures)


def test_tuning():
    assert "median RMS" in run("tuning.py", "3", "2")


def test_fuzzy():
    assert "finished" in run("fuzzy.py")


def test_gym():
    pytest.importorskip("gymnasium")
    said = run("gym_env.py")
    rms = float(said.split(":")[1].split("mm")[0])
    assert rms < 30


@pytest.mark.parametrize(("name", "duration_s"), [("sinusoid", 60.0), ("square", 98.0)])
def test_mujoco(name, duration_s, monkeypatch):
    """Law: with wheels on a floor and an engine of its own, the tip is within 5 mm RMS after the first five seconds."""
    pytest.importorskip("mujoco")
    monkeypatch.syspath_prepend(str(EXAMPLES))
    import mujoco_plant

    found = mujoco_plant.run(name, duration_s)
    assert found["MuJoCo"] <= 5.0
    assert found["ours"] <= found["MuJoCo"]
