"""What samples have that no text can say, and the values without it."""

from __future__ import annotations

_MU = ("contacts.0.friction=0.25",)
# by what a sample is called: its path below samples/, and its file
UNSAID: dict[str, tuple[str, ...]] = {
    "landing": ("contacts.landing.air=null",),
    "duplex": ("rules=[]", "require=[]"),
    "crease": ("materials.eur10.yield=null",),
    "recycler": (
        *("rules=[]", "sheets.note.out=[]", "guides.gate.pivot=null", "rollers.retard.limiter=null"),
        *("piles.cassette.contact.friction=0.3", "sheets.note.boxes=[4,1]"),
        "shafts.main={rollers: {lower_1: 1, lower_2: 1}, drive: {speed: 200 rad/s}}",
    ),
    "register": ("rules=[]",),
    "sorter": (
        "rules=[]",
        "streams={}",
        "require=[]",
        "contacts.guides.between.0=note",
        "contacts.nip.between.0=note",
    ),
    "stream": ("streams={}", "require=[]"),
    "saddle": ("materials.film.poisson=0",),
    "rubber_nip": ("nips.feed.lower.cover=null", "nips.feed.lower.contact.stiffness=1000 N/mm^1.5"),
    **dict.fromkeys(("verify/aslant", "aslant"), _MU),
}
