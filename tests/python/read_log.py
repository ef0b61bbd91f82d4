"""Decode every message of a log with an independent reader and print how many there are.

Usage: python read_log.py RUN.mcap        (needs: pip install mcap mcap-ros2-support)

Exit code 1, with the reason on stderr, if a message cannot be decoded, a topic is missing or empty, or a number
is not what its neighbours say.
"""

import collections
import json
import math
import sys

from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory

TOPICS = {
    "/robot_description": "std_msgs/msg/String",
    "/reference": "nav_msgs/msg/Path",
    "/tf": "tf2_msgs/msg/TFMessage",
    "/joint_states": "sensor_msgs/msg/JointState",
    "/odom": "nav_msgs/msg/Odometry",
    "/control": "mmsim_msgs/msg/Control",
    "/path": "nav_msgs/msg/Path",
}


def turned(quaternion, vector):
    """The vector turned by a quaternion: v + 2 w (u x v) + 2 u x (u x v)."""

    def cross(a, b):
        return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])

    axis = (quaternion.x, quaternion.y, quaternion.z)
    once = cross(axis, vector)
    twice = cross(axis, once)
    return tuple(v + 2 * (quaternion.w * o + t) for v, o, t in zip(vector, once, twice))


def position(transforms, frame):
    """World position of a frame's origin, through its parents."""
    by_child = {t.child_frame_id: t for t in transforms}
    point = (0.0, 0.0, 0.0)
    while frame != "world":
        link = by_child[frame]
        origin = link.transform.translation
        point = turned(link.transform.rotation, point)
        point = (point[0] + origin.x, point[1] + origin.y, point[2] + origin.z)
        frame = link.header.frame_id
    return point


def check(path):
    """Read the file; return the number of messages of each topic."""
    counts = collections.Counter()
    tips = {}
    with open(path, "rb") as stream:
        reader = make_reader(stream, decoder_factories=[DecoderFactory()])
        assert reader.get_header().profile == "ros2", "profile"
        for schema, channel, message, decoded in reader.iter_decoded_messages():
            topic = channel.topic
            assert TOPICS.get(topic) == schema.name, f"{topic} has type {schema.name}"
            counts[topic] += 1
            if topic == "/tf":
                tips[message.log_time] = position(decoded.transforms, "tip")
            elif topic == "/control":
                stamp = decoded.header.stamp
                assert stamp.sec * 10**9 + stamp.nanosec == message.log_time, "stamp and log time"
                assert abs(decoded.t_s * 1e9 - message.log_time) <= 1, "t_s and log time"
                tip = (decoded.tip_x_m, decoded.tip_y_m, decoded.tip_z_m)
                assert math.dist(tip, tips[message.log_time]) < 1e-9, f"/tf and /control at {decoded.t_s} s"
            elif topic == "/joint_states":
                widths = {len(decoded.name), len(decoded.position), len(decoded.velocity), len(decoded.effort)}
                assert widths == {5}, "five joints"
            elif topic == "/path":
                assert 1 <= len(decoded.poses) <= 256, "bounded trail"
            elif topic == "/robot_description":
                assert decoded.data.startswith("<?xml"), "URDF"
        missing = set(TOPICS) - set(counts)
        assert not missing, f"nothing on {sorted(missing)}"
        names = {a.name: a for a in reader.iter_attachments()}
        assert "scenario.toml" in names, "scenario"
        if "summary.json" in names:
            json.loads(names["summary.json"].data)
        records = {m.name: m.metadata for m in reader.iter_metadata()}
        assert {"version", "scenario", "controller", "seed"} <= set(records["mmsim"]), "metadata"
    return counts, records


def main():
    """Check the file named on the command line."""
    if len(sys.argv) != 2:
        sys.exit(f"usage: {sys.argv[0]} RUN.mcap")
    try:
        counts, records = check(sys.argv[1])
    except Exception as error:  # whatever a reader stumbles over is a failure of the file
        sys.exit(f"{sys.argv[1]}: {type(error).__name__}: {error}")
    for topic, count in sorted(counts.items()):
        print(f"{topic} {count}")
    print("outcome", records.get("mmsim.result", {}).get("outcome", "unfinished"))


if __name__ == "__main__":
    main()
