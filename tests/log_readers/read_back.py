"""Reads a recovered log with the readers of others, and what the killed run left with one of them; prints the number of messages.

    python read_back.py TORN RECOVERED

Fails if a message cannot be read, or if one that was complete in the torn log is not in the recovered one. Every message is counted and
compared, every 50th is taken apart by each reader.
"""

import hashlib
import sys
from collections import Counter
from pathlib import Path

from mcap.exceptions import McapError
from mcap.reader import make_reader
from mcap.records import Message
from mcap.stream_reader import StreamReader
from mcap_ros2.decoder import DecoderFactory
from rosbags.highlevel import AnyReader
from rosbags.typesys import Stores, get_typestore

EVERY = 50


def torn_messages(path: Path) -> tuple[int, str]:
    """Number and hash of the messages that are complete in a torn log."""
    count, digest = 0, hashlib.sha256()
    with path.open("rb") as stream:
        try:
            for record in StreamReader(stream, validate_crcs=True).records:
                if isinstance(record, Message):
                    count += 1
                    digest.update(record.log_time.to_bytes(8, "little") + record.data)
        except (McapError, EOFError):
            pass
    return count, digest.hexdigest()


def recovered_messages(path: Path) -> tuple[int, str]:
    """The same of a whole log, read by its index; some are decoded."""
    count, digest, factory, decoders = 0, hashlib.sha256(), DecoderFactory(), {}
    with path.open("rb") as stream:
        for schema, channel, message in make_reader(stream, validate_crcs=True).iter_messages(log_time_order=False):
            if count % EVERY == 0:
                if channel.id not in decoders:
                    decoders[channel.id] = factory.decoder_for(channel.message_encoding, schema)
                decoders[channel.id](message.data)
            count += 1
            digest.update(message.log_time.to_bytes(8, "little") + message.data)
    return count, digest.hexdigest()


def rosbags_messages(path: Path) -> Counter[str]:
    """Messages by topic, as rosbags reads a whole log."""
    counts: Counter[str] = Counter()
    with AnyReader([path], default_typestore=get_typestore(Stores.ROS2_HUMBLE)) as reader:
        for connection, _, raw in reader.messages():
            if counts[connection.topic] % EVERY == 0:
                reader.deserialize(raw, connection.msgtype)
            counts[connection.topic] += 1
    return counts


def main() -> None:
    torn, recovered = map(Path, sys.argv[1:3])
    before, after = torn_messages(torn), recovered_messages(recovered)
    if before != after:
        sys.exit(f"{before} in the torn log, {after} in the recovered one")
    counts = rosbags_messages(recovered)
    if sum(counts.values()) != after[0]:
        sys.exit(f"rosbags reads {counts}, mcap {after[0]} messages")
    for topic in ("/robot_description", "/reference", "/tf", "/joint_states", "/odom", "/control", "/path"):
        if not counts[topic]:
            sys.exit(f"nothing on {topic}")
    print(after[0])


if __name__ == "__main__":
    main()
