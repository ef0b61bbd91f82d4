"""What a viewer gets of `mmsim --live`: the run, byte for byte that of the log, and its gains to turn."""

from __future__ import annotations

import json
import os
import signal
import socket
import subprocess
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from mcap.reader import make_reader
from websockets.exceptions import ConnectionClosed

from viewer import Viewer

MMSIM = os.environ["MMSIM"]
GAIN = "controller.outer.position_gain_1_s"
BFSMC = {"fuzzy_gain", "fuzzy_scale", "learning_limit", "observer_bandwidth_1_s"}
ONCE = {"/robot_description", "/reference"}


class Served:
    """A run that is served, on a port of its own."""

    def __init__(self, *arguments: str, out: str | None = None) -> None:
        """Starts the run and waits until it waits."""
        log = ["--out", out] if out else ["--no-log"]
        command = [MMSIM, "--scenario", "square", "--live", "--live-address", "127.0.0.1:0", "--json", *log]
        self.process = subprocess.Popen(
            [*command, *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        )
        line = self.process.stderr.readline()
        assert "waiting for a viewer at ws://127.0.0.1:" in line, line
        self.url = line.split(" at ")[1].split()[0]

    def viewer(self) -> Viewer:
        """A viewer that was told of all topics."""
        viewer = Viewer.open(self.url)
        viewer.until(lambda viewer: len(viewer.channels) == 8)
        return viewer

    def end(self) -> dict:
        """The summary, once the run has ended."""
        out, messages = self.process.communicate(timeout=60)
        assert self.process.returncode in (0, 1), messages
        return json.loads(out)


Serve = Callable[..., Served]


@pytest.fixture
def served() -> Iterator[Serve]:
    """Starts runs, and kills what is left of them."""
    runs: list[Served] = []

    def serve(*arguments: str, out: str | None = None) -> Served:
        runs.append(Served(*arguments, out=out))
        return runs[-1]

    yield serve
    for run in runs:
        run.process.kill()


def watch_to_the_end(viewer: Viewer) -> None:
    """Takes everything until the server goes."""
    try:
        while True:
            viewer.take(20.0)
    except ConnectionClosed:
        return


def test_a_viewer_sees_what_the_log_holds(served: Serve, tmp_path: Path) -> None:
    """Every message is that of the log, byte for byte, and what is sent once comes to who came later."""
    run = served("--set", "simulation.duration_s=2.0", "--live-speed", "4", out=str(tmp_path))
    viewer = run.viewer()
    assert viewer.info["name"].startswith("mmsim ")
    viewer.subscribe()
    watch_to_the_end(viewer)
    summary = run.end()
    assert summary["ended"] == "finished"
    with open(summary["log"], "rb") as log:
        logged = [(c.topic, m.log_time, m.data) for _, c, m in make_reader(log).iter_messages(log_time_order=False)]
    moving = [message for message in viewer.messages if message[0] not in ONCE]
    assert moving == [message for message in logged if message[0] not in ONCE]
    once = {topic: data for topic, _, data in logged if topic in ONCE}
    assert {topic: data for topic, _, data in viewer.messages if topic in ONCE} == once
    assert viewer.times == sorted(viewer.times)
    assert len(viewer.times) > 10


def test_watching_changes_nothing(served: Serve) -> None:
    """The digest is that of a run nobody watches."""
    run = served("--set", "simulation.duration_s=1.0", "--live-speed", "inf")
    run.viewer().subscribe()
    alone = [MMSIM, "--scenario", "square", "--set", "simulation.duration_s=1.0", "--no-log", "--json"]
    expected = json.loads(subprocess.run(alone, capture_output=True, text=True, check=True).stdout)
    assert run.end()["digest"] == expected["digest"]


def test_time_passes_as_asked(served: Serve) -> None:
    """At twice the speed of time, three seconds take one and a half."""
    run = served("--set", "simulation.duration_s=3.0", "--live-speed", "2")
    viewer = run.viewer()
    viewer.subscribe()
    viewer.until(lambda viewer: viewer.times)
    begin = time.monotonic()
    watch_to_the_end(viewer)
    # A machine may be late, but no run is early.
    assert time.monotonic() - begin > 1.3
    assert run.end()["ended"] == "finished"


def test_gains_are_turned_and_said(served: Serve) -> None:
    """A viewer reads the gains, changes one, and the summary says what it was changed to, and when."""
    run = served("--set", "simulation.duration_s=4.0")
    viewer = run.viewer()
    viewer.send(op="getParameters", parameterNames=[], id="all")
    viewer.until(lambda viewer: GAIN in viewer.parameters)
    gains = {name.removeprefix("controller.gains.") for name in viewer.parameters if ".gains." in name}
    # Those of the law bfsmc: no other acts.
    assert gains == BFSMC
    assert viewer.parameters[GAIN] == [18.0, 18.0, 18.0]
    viewer.subscribe()
    viewer.until(lambda viewer: len(viewer.times) > 20)
    change = {"name": GAIN, "value": [6, 6, 6.5]}
    viewer.send(op="setParameters", parameters=[change], id="turn")
    viewer.until(lambda viewer: viewer.parameters[GAIN] != [18.0, 18.0, 18.0])
    assert viewer.parameters[GAIN] == [6.0, 6.0, 6.5]
    watch_to_the_end(viewer)
    warning = run.end()["warnings"][0]
    assert warning.startswith(f"changed by a viewer: {GAIN} = [6.0, 6.0, 6.5] from t = ")


@pytest.mark.parametrize(
    ("name", "value", "why"),
    [
        (GAIN, -3.0, "position_gain"),
        (GAIN, [1.0, 2.0], "position_gain_1_s"),
        ("controller.gains.nonsense", 1.0, "nonsense is no gain"),
        ("simulation.seed", 5, "is no gain that acts here"),
        ("controller.gains.twisting_gain", [1.0] * 5, "is no gain that acts here"),
        ("controller.outer.minimum_norm", True, "is no gain that acts here"),
        ("controller.gains.learning_limit.0", 1.0, "is no gain that acts here"),
        ("controller.outer.sliding_gain_1_s", 5000.0, "documented range"),
    ],
)
def test_a_gain_that_cannot_be_is_refused_in_words(served: Serve, name: str, value: object, why: str) -> None:
    """What the controller cannot work with, or is no gain, is refused with the message of `--set`."""
    run = served("--set", "simulation.duration_s=3.0")
    viewer = run.viewer()
    viewer.subscribe()
    viewer.send(op="setParameters", parameters=[{"name": name, "value": value}], id="wrong")
    viewer.until(lambda viewer: viewer.statuses)
    assert why in viewer.statuses[0]["message"]
    run.process.send_signal(signal.SIGINT)
    assert run.end()["warnings"][0].startswith("changed by a viewer") is False


def test_a_refusal_is_said_before_the_run_begins(served: Serve) -> None:
    """Whoever turns a gain before anybody watches is told in words, without the places of a text that viewers do not see."""
    run = served("--set", "simulation.duration_s=1.0")
    viewer = run.viewer()
    name = "controller.gains.learning_limit"
    viewer.send(op="setParameters", parameters=[{"name": name, "value": [-1.0] * 5}], id="wrong")
    viewer.until(lambda viewer: viewer.statuses)
    message = viewer.statuses[0]["message"]
    assert message.startswith(f"`{name}"), message
    assert "-->" not in message
    assert "\n" not in message
    assert not viewer.times
    run.process.send_signal(signal.SIGINT)
    run.end()


def test_the_log_of_a_killed_run_says_what_was_changed(served: Serve, tmp_path: Path) -> None:
    """Changes stand in the log when they are made: `log info` and what `log recover` brings back have them."""
    run = served("--set", "simulation.duration_s=60.0", out=str(tmp_path))
    viewer = run.viewer()
    viewer.subscribe()
    viewer.until(lambda viewer: len(viewer.times) > 20)
    for value in (6.0, 7.0):
        viewer.send(op="setParameters", parameters=[{"name": GAIN, "value": [value] * 3}], id="turn")
        viewer.until(lambda viewer, value=value: viewer.parameters.get(GAIN) == [value] * 3)
    seen = len(viewer.times)
    viewer.until(lambda viewer: len(viewer.times) > seen + 20)
    run.process.kill()
    run.process.wait()
    (log,) = tmp_path.glob("*.mcap")
    recovered = tmp_path / "recovered.mcap"
    subprocess.run([MMSIM, "log", "recover", str(log), "-o", str(recovered)], capture_output=True)
    for path in (log, recovered):
        info = subprocess.run([MMSIM, "log", "info", str(path), "--json"], capture_output=True, text=True)
        first, second = json.loads(info.stdout)["changes"]
        assert first.startswith(f"{GAIN} = [6.0, 6.0, 6.0] from t = "), first
        assert second.startswith(f"{GAIN} = [7.0, 7.0, 7.0] from t = "), second


def test_a_change_that_is_none_is_not_said(served: Serve) -> None:
    """A gain set to what it is leaves the run that of its scenario."""
    run = served("--set", "simulation.duration_s=1.0")
    viewer = run.viewer()
    viewer.subscribe()
    viewer.send(op="setParameters", parameters=[{"name": GAIN, "value": [18, 18, 18]}], id="same")
    viewer.until(lambda viewer: GAIN in viewer.parameters)
    watch_to_the_end(viewer)
    assert not any("changed by a viewer" in warning for warning in run.end()["warnings"])


def test_only_what_differs_is_a_change(served: Serve) -> None:
    """A viewer that sends back all that it was shown, with one gain turned, has turned one gain."""
    run = served("--set", "simulation.duration_s=2.0")
    viewer = run.viewer()
    viewer.send(op="getParameters", parameterNames=[], id="all")
    viewer.until(lambda viewer: GAIN in viewer.parameters)
    viewer.subscribe()
    turned = {**viewer.parameters, GAIN: [6.0, 6.0, 6.0]}
    parameters = [{"name": name, "value": value} for name, value in turned.items()]
    viewer.send(op="setParameters", parameters=parameters, id="turn")
    viewer.until(lambda viewer: viewer.parameters[GAIN] == [6.0, 6.0, 6.0])
    watch_to_the_end(viewer)
    changes = [warning for warning in run.end()["warnings"] if warning.startswith("changed by a viewer")]
    assert len(changes) == 1, changes
    assert changes[0].startswith(f"changed by a viewer: {GAIN} = [6.0, 6.0, 6.0]")


def test_the_wait_for_a_viewer_is_no_part_of_the_run(served: Serve) -> None:
    """The wall time of the summary begins when the run does."""
    run = served("--set", "simulation.duration_s=0.2", "--live-speed", "inf")
    time.sleep(3.0)
    run.viewer().subscribe()
    assert run.end()["wall_s"] < 2.5


def test_a_gain_of_a_file_can_be_turned(served: Serve, tmp_path: Path) -> None:
    """What a file of gains gives is not what a viewer is held to."""
    (tmp_path / "gains.toml").write_text("[bfsmc]\nlearning_limit = [40.0, 10.0, 9.0, 9.0, 9.0]\n")
    run = served("--set", "simulation.duration_s=2.0", "--set", f"controller.gains_file={tmp_path / 'gains.toml'}")
    viewer = run.viewer()
    viewer.subscribe()
    name, value = "controller.gains.learning_limit", [50.0, 20.0, 8.0, 8.0, 8.0]
    viewer.send(op="setParameters", parameters=[{"name": name, "value": value}], id="turn")
    viewer.until(lambda viewer: viewer.parameters.get(name) == value)
    watch_to_the_end(viewer)
    assert run.end()["warnings"][0].startswith(f"changed by a viewer: {name} = ")


def test_somebody_who_only_connects_does_not_hold_the_end(served: Serve) -> None:
    """A connection without a word is cut when the run ends."""
    run = served("--set", "simulation.duration_s=0.5", "--live-speed", "inf")
    host, port = run.url.removeprefix("ws://").split(":")
    with socket.create_connection((host, int(port))):
        run.viewer().subscribe()
        assert run.end()["ended"] == "finished"


def test_ctrl_c_ends_a_run_that_waits(served: Serve) -> None:
    """A run that nobody came to watch can be ended."""
    run = served("--set", "simulation.duration_s=3.0")
    run.process.send_signal(signal.SIGINT)
    summary = run.end()
    assert summary["ended"] == "interrupted"
    assert summary["simulated_s"] == 0.0


def test_an_address_that_is_taken_is_said(served: Serve) -> None:
    """An address that cannot be had is an error that names it."""
    run = served()
    address = run.url.removeprefix("ws://")
    second = [MMSIM, "--scenario", "square", "--live", "--live-address", address, "--no-log"]
    ended = subprocess.run(second, capture_output=True, text=True, timeout=20)
    assert ended.returncode == 1
    assert f"cannot serve at {address}: " in ended.stderr
