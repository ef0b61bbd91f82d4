"""The command ``mmsim``: ``python -m mmsim`` and the script of that name."""

import signal
import sys

from . import _mmsim


def main() -> None:
    """Runs the command with the arguments of the process."""
    # A reader that goes away ends the command quietly, as it does without Python.
    if hasattr(signal, "SIGPIPE"):
        signal.signal(signal.SIGPIPE, signal.SIG_IGN)
    sys.exit(_mmsim.main(["mmsim", *sys.argv[1:]]))


if __name__ == "__main__":
    main()
