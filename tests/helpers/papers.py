"""The paper of most scenes in tests: moduli of a bank note, as in the paper's Table 2, and its bending."""

from __future__ import annotations

MODULI = "E_md: 3530 MPa, E_cd: 1113 MPa"
HINGED_PAPER = f"{{{MODULI}, k_tx: 0.15 N*mm/rad, k_ty: 0.185 N*mm/rad, k_tz: 5 N*mm/rad}}"
PLATE_PAPER = f"{{{MODULI}, D_md: 0.4 N*mm, D_cd: 0.24 N*mm}}"


def on_paper(scene: str, template: bool = False) -> str:
    """A scene's text with these names as what they stand for; `template`: with the braces of a format."""
    for name, material in (("HINGED_PAPER", HINGED_PAPER), ("PLATE_PAPER", PLATE_PAPER)):
        scene = scene.replace(name, material.replace("{", "{{").replace("}", "}}") if template else material)
    return scene
