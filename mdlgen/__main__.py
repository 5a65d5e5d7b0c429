"""`python -m mdlgen`, and the command `mdlgen`."""

from __future__ import annotations

import gc
import os
import sys

INTERRUPTED = 130
# Objects that a command loads and reads live to its end. Python would search them for garbage after each few
# hundred new objects, which takes up to a tenth of the time.
MANY = 100_000
# A run makes little garbage of this kind, and has more objects than that once it is loaded and read.
MANY_IN_A_RUN = 1_000_000
# Commands that hold much at their end: the tables of the compiler, or all things of a large text.
LARGE = ("run", "lint", "mdl", "deck", "verify")


def main() -> None:
    """Entry point: an interrupt while the command line itself is loaded ends as one later does."""
    gc.set_threshold(MANY_IN_A_RUN if sys.argv[1:2] == ["run"] else MANY)
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")  # else it looks into each installed package
    try:
        from mdlgen.cli import main as run

        run()
    except KeyboardInterrupt:
        sys.exit(INTERRUPTED)
    except SystemExit as end:
        if len(sys.argv) > 1 and sys.argv[1] in LARGE:
            leave(end.code)
        raise


def leave(code: str | int | None) -> None:
    """Ends this process at once. It has written all that it has to, and taking what it holds apart one by one
    would take up to another third of a second."""
    if isinstance(code, str):
        return
    try:
        sys.stdout.flush()
        sys.stderr.flush()
    except OSError:  # nobody reads: that ends as it does elsewhere
        return
    os._exit(code or 0)


if __name__ == "__main__":
    main()
