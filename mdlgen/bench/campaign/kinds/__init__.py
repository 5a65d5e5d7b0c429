"""Kinds of scenes: a function draws a scene of each kind. The manual shows its docstring and its share."""

from __future__ import annotations

from collections.abc import Callable

from mdlgen.bench.campaign.draw import Data, Draw
from mdlgen.bench.campaign.kinds import channels, falls, moves, nips, piles, shapes

Kind = Callable[[Draw], Data]

# Shares in percent.
KINDS: dict[str, tuple[float, Kind]] = {
    "fall_flat": (8.0, falls.flat),
    "fall_tilted": (6.0, falls.tilted),
    "fall_edge": (6.0, falls.edge),
    "fall_mesh": (6.0, falls.mesh),
    "fall_roller": (3.0, falls.roller),
    "thrown": (8.0, moves.thrown),
    "slide": (6.0, moves.slide),
    "wall": (5.0, moves.wall),
    "slip_off": (4.0, moves.slip),
    "nip": (8.0, nips.single),
    "nips": (8.0, nips.several),
    "nip_arm": (4.0, nips.arms),
    "pick_arm": (4.0, nips.pick),
    "gate": (3.0, nips.gate),
    "arc": (5.0, channels.arc),
    "channel": (4.0, channels.channel),
    "funnel": (2.0, channels.funnel),
    "pile_feed": (3.0, piles.feed),
    "retard": (2.0, piles.retard),
    "stack": (2.0, piles.stack),
    "curled": (1.0, shapes.curled),
    "folded": (1.0, shapes.folded),
    "worn": (1.0, shapes.worn),
}
