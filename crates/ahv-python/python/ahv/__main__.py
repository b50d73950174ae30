"""The command ``ahv``, in this process."""

import signal
import sys


def main() -> int:
    """Run the command line of this process, and give its exit code."""
    from ahv import _models

    # The program obeys signals itself, as it does without Python around it.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return _models.main(["ahv", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
