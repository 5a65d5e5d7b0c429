"""Lints about the parameters that a user named."""

from __future__ import annotations

from collections.abc import Iterator

from mdlgen.altair.axles import refuse_axles
from mdlgen.altair.moving import refuse_moving
from mdlgen.altair.reactions import refuse_rules
from mdlgen.altair.streams import refuse_passing
from mdlgen.conditions import condition
from mdlgen.errors import RefusedError
from mdlgen.formulas import names
from mdlgen.lints.lint import Lint
from mdlgen.model.parameters.names import OF_USER
from mdlgen.model.tables import Model


def parameters(model: Model) -> Iterator[Lint]:
    """Those that nothing follows from, and values that follow them here and not in a text."""
    own = [p for p in model.parameters if p.data_set == OF_USER]
    texts = [p.formula for p in model.parameters if p.formula]
    texts += [text for anchor in (*model.probes, *model.supports) for text in anchor.formulas if text]
    texts += [formula for _, formula in model.unfollowed]
    used = {name for text in texts for name in names(text)}
    used |= {name for rule in model.reactions.rules for name in condition(rule.when).expression.names}
    for p in own:
        if p.member not in used:
            yield Lint(
                "W127",
                f"{OF_USER}.{p.member}",
                "no value of the scene follows from this parameter",
                f"use it in a formula, as 2*{p.member}, or leave it out",
            )
    if not _written(model):
        return
    for where, formula in model.unfollowed:
        if names(formula) and not where.startswith("sensors."):  # which texts leave out
            yield Lint(
                "W128",
                where,
                f"MotionView text has this as a number: there it does not follow {', '.join(names(formula))}",
                "write the text again after a change of them",
            )


def _written(model: Model) -> bool:
    """Whether MotionView text has a machine of this kind at all."""
    try:
        for refuse in (refuse_rules, refuse_passing, refuse_axles, refuse_moving):
            refuse(model, "MotionView text")
    except RefusedError:
        return False
    return True
