"""Sensors and rules, of which no text says what they do."""

from __future__ import annotations

from mdlgen.errors import RefusedError
from mdlgen.model.tables import Model


def refuse_rules(model: Model, who: str) -> None:
    """Raises RefusedError, by path, for a scene with rules: no form is documented in which an event that a
    solver finds changes a motion from then on."""
    for k, rule in enumerate(model.reactions.rules):
        raise RefusedError(
            f"{who}: rules.{k} (when {rule.when}) acts on what the sheets do, and no documented statement "
            "changes a motion so; run it with lattice or exudyn, or leave the rules out",
            ("rules", k),
        )


def sensor_note(model: Model) -> list[str]:
    """A line of the head that names sensors, which are left out; none without any."""
    names = ", ".join(sensor.name for sensor in model.reactions.sensors)
    return [f"Left out : sensors, which act on nothing ({names})"] if names else []
