"""A sheet of two boxes on which nothing acts, which tests add to."""

from __future__ import annotations

BASE = {
    "name": "small",
    "materials": {
        "paper": {
            "E_md": "3530 MPa",
            "E_cd": "1113 MPa",
            "k_tx": "0.15 N*mm/rad",
            "k_ty": "0.185 N*mm/rad",
            "k_tz": "5 N*mm/rad",
            "damping": {"ratio": 0.12, "ratio_ty": 0.04},
        }
    },
    "sheets": {
        "note": {
            "material": "paper",
            "size": ["60 mm", "40 mm"],
            "thickness": "0.1 mm",
            "mass": "0.6 g",
            "boxes": [2, 1],
        }
    },
    "run": {"duration": "50 ms"},
}
