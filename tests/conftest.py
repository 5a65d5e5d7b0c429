"""Random tests are the same every time, and never fail for a machine that is slow."""

from __future__ import annotations

from hypothesis import settings

settings.register_profile("mdlgen", deadline=None, derandomize=True)
settings.load_profile("mdlgen")
