"""Solver commands that set the numbers of contacts by keyword, from the values of their data sets."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from mdlgen.backends.motionview.writer.contact_rows import ContactView, LawView, Pair


def contact_laws(contacts: Sequence[ContactView], pairs: Iterable[Pair]) -> list[LawView]:
    """Contacts that have the same numbers, entry by entry of the spec's list."""
    labels = {contact.data_set: contact.label for contact in contacts}
    found: dict[tuple[str, ...], list[str]] = {}
    for pair in pairs:
        key = (pair.data_set, pair.friction, pair.rough, pair.stiff, pair.bouncy, pair.master)
        found.setdefault(key, []).append(pair.name)
    return [
        LawView(labels[data_set], master, _numbers(data_set, *numbers), names)
        for (data_set, *numbers, master), names in found.items()
    ]


def _numbers(data_set: str, friction: str, rough: str, stiff: str, bouncy: str) -> list[tuple[str, str, str]]:
    """Variable, attribute of the command Force_Contact, and formula of each number."""

    def own(member: str, times: str = "") -> str:
        return f"ds_{data_set}.real_{member}.value" + (f"*{times}" if times else "")

    numbers = [
        ("penalty", "penalty", own("k", stiff)),
        ("restitution", "restitution_coeff", bouncy or own("c_R")),
        ("normal_vel", "normal_trans_vel", own("v_n")),
    ]
    if friction == "OFF":
        return numbers
    return [
        *numbers,
        ("mu_static", "mu_static", own("mu_s", rough)),
        ("mu_dynamic", "mu_dynamic", own("mu_d", rough)),
        ("stiction_vel", "stiction_trans_vel", own("v_s")),
        ("friction_vel", "friction_trans_vel", own("v_d")),
    ]
