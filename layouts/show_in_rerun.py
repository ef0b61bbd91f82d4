"""Shows a log in Rerun, with the paths as lines and the disturbances as arrows, which Rerun does not draw by itself.

    pip install rerun-sdk mcap-ros2-support
    python layouts/show_in_rerun.py out/square.mcap                    opens the viewer
    python layouts/show_in_rerun.py out/square.mcap -o square.rrd      writes a recording for `rerun square.rrd`
"""

import argparse

import rerun as rr
import rerun.blueprint as rrb
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory

COLORS = {"/reference": (78, 152, 226), "/path": (245, 119, 77)}
ARROW_COLOR = (230, 51, 26)
ADD = 0


def blueprint() -> rrb.Blueprint:
    """The robot on the left, error, torques and disturbance on the right."""

    def plot(name: str, prefix: str, names: list[str], suffix: str) -> rrb.TimeSeriesView:
        return rrb.TimeSeriesView(name=name, contents=[f"/plots/{prefix}{n}{suffix}" for n in names])

    five = ["right", "left", "joint1", "joint2", "joint3"]
    return rrb.Blueprint(
        rrb.Horizontal(
            rrb.Spatial3DView(
                name="Robot",
                contents=["/**", "- /mmsim/collision_geometries/**", "- /plots/**"],
                spatial_information=rrb.SpatialInformation(target_frame="world"),
            ),
            rrb.Vertical(
                plot("Error of the tip, m", "error_", ["x", "y", "z"], "_m"),
                plot("Torque at the plant, N m", "torque_applied_", five, "_n_m"),
                plot("Disturbance, N m", "disturbance_", five, "_n_m"),
            ),
        )
    )


PLOTTED = ("error_", "torque_applied_", "disturbance_")


def log_message(topic: str, message: object) -> None:
    """Logs what Rerun leaves as numbers."""
    if topic == "/control":
        for name in message.__slots__:
            if name.startswith(PLOTTED):
                rr.log(f"/plots/{name}", rr.Scalars(getattr(message, name)))
    elif topic == "/disturbance":
        for marker in message.markers:
            entity = f"/lines/disturbance/{marker.id}"
            if marker.action != ADD:
                rr.log(entity, rr.Clear(recursive=False))
                continue
            origin, end = ((p.x, p.y, p.z) for p in marker.points)
            rr.log(
                entity,
                rr.CoordinateFrame(marker.header.frame_id),
                rr.Arrows3D(origins=[origin], vectors=[end], colors=[ARROW_COLOR], radii=[marker.scale.x / 2]),
            )
    else:
        points = [(p.pose.position.x, p.pose.position.y, p.pose.position.z) for p in message.poses]
        rr.log(
            f"/lines{topic}",
            rr.CoordinateFrame(message.header.frame_id),
            rr.LineStrips3D([points], colors=[COLORS[topic]], radii=[0.006]),
        )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("log", help="a log of mmsim")
    parser.add_argument("-o", "--output", help="write a recording instead of opening the viewer")
    arguments = parser.parse_args()
    rr.init("mmsim", spawn=arguments.output is None, default_blueprint=blueprint())
    if arguments.output:
        rr.save(arguments.output, default_blueprint=blueprint())
    rr.log_file_from_path(arguments.log)
    with open(arguments.log, "rb") as stream:
        reader = make_reader(stream, decoder_factories=[DecoderFactory()])
        topics = ["/reference", "/path", "/disturbance", "/control"]
        for _, channel, record, message in reader.iter_decoded_messages(topics=topics):
            rr.set_time("message_log_time", timestamp=record.log_time / 1e9)
            log_message(channel.topic, message)


if __name__ == "__main__":
    main()
