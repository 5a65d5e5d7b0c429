"""All generated pages of the manual, by their path below docs/."""

from __future__ import annotations

import codes
import commands
import gallery
import outputs
import scene


def pages() -> dict[str, str]:
    """Path below docs/ -> Markdown. The same code gives the same bytes."""
    return {
        "reference/keys.md": scene.page(),
        "reference/commands.md": commands.page(),
        "reference/codes.md": codes.page(),
        "reference/summary.md": outputs.summary_page(),
        "gallery/index.md": gallery.page(),
    }
