"""Where tests find what is no module: the checkout, texts that a reviewer has read, scenes of their own."""

from __future__ import annotations

from pathlib import Path

TESTS = Path(__file__).resolve().parents[1]
ROOT = TESTS.parent
GOLDEN = TESTS / "golden"
RICH = TESTS / "helpers" / "rich.yaml"  # one of everything that a scene can have
REAL = ROOT.parent / "shared" / "mdl" / "samples"  # a pair of files that Altair's programs wrote
