"""All compiled code of this solver, imported in one place so that it is cached by its content."""

from __future__ import annotations

from pathlib import Path

from mdlgen.mechanics import keep_compiled_code

keep_compiled_code(Path(__file__).resolve().parent)

from backends.lattice import balance, band, forces, observe, step, tangent  # noqa: E402

keep_compiled_code()

__all__ = ["balance", "band", "forces", "observe", "step", "tangent"]
