"""Moduli of the paper that damping is tested with."""

from __future__ import annotations

E_MD = 3530.0  # [MPa]
