"""Lints about the parameters that a user named."""

from __future__ import annotations

from collections.abc import Iterator

from mdlgen.conditions import condition
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
    for where, formula in model.unfollowed:
        # texts refuse rules, and leave sensors out
        if names(formula) and not where.startswith(("rules.", "sensors.")):
            yield Lint(
                "W128",
                where,
                f"MotionView text has this as a number: there it does not follow {', '.join(names(formula))}",
                "write the text again after a change of them",
            )
