"""Writes the generated pages of the manual: `python docs/_generate`; with `--check` it only compares."""

from __future__ import annotations

import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

import pages  # noqa: E402  needs the folder on the path


def main() -> int:
    docs, check = HERE.parent, "--check" in sys.argv[1:]
    stale = []
    for name, text in pages.pages().items():
        path = docs / name
        if not path.is_file() or path.read_text("utf-8") != text:
            stale.append(name)
            if not check:
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text, "utf-8")
    for name in stale:
        print(f"docs/{name} {'is out of date: python docs/_generate' if check else 'written'}")
    return 1 if check and stale else 0


sys.exit(main())
