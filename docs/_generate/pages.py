"""What is generated from the code, by its path from docs/: pages of the manual, the stub of the package."""

from __future__ import annotations

import codes
import commands
import forms
import gallery
import outputs
import scene
import stub


def pages() -> dict[str, str]:
    """Path from docs/ -> text. The same code gives the same bytes."""
    return {
        "reference/keys.md": scene.page(),
        "reference/commands.md": commands.page(),
        "reference/codes.md": codes.page(),
        "reference/summary.md": outputs.summary_page(),
        "motionview/unverified.md": forms.page(),
        "gallery/index.md": gallery.page(),
        "../mdlgen/__init__.pyi": stub.stub(),
    }
