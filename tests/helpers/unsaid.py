"""What samples have that no text can say, and the values without it."""

from __future__ import annotations

UNSAID: dict[str, tuple[str, ...]] = {
    "landing": ("contacts.landing.air=null",),
    "crease": ("materials.eur10.yield=null",),
    "saddle": ("materials.film.poisson=0",),
}
