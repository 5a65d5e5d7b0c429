"""What stands in a page."""

from __future__ import annotations

import json
from typing import Any

from lxml import html


def embedded(text: str) -> list[dict[str, Any]]:
    """What the scripts of a page draw from."""
    return json.loads(html.fromstring(text).get_element_by_id("data").text)
