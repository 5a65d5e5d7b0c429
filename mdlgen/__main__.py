"""`python -m mdlgen`, and the command `mdlgen`."""

from __future__ import annotations

import sys

INTERRUPTED = 130


def main() -> None:
    """Entry point: an interrupt while the command line itself is loaded ends as one later does."""
    try:
        from mdlgen.cli import main as run

        run()
    except KeyboardInterrupt:
        sys.exit(INTERRUPTED)


if __name__ == "__main__":
    main()
