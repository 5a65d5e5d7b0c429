"""Notes on the use of the sheets in a user's model, which is allowed but worth a note."""

from __future__ import annotations

from collections.abc import Iterator

from mdlgen.verify.inputs.subject import Read

_MOST = 5


def host_notes(mine: Read, given: Read) -> Iterator[str]:
    """Notes on one instance of the sheets; `mine` is the text that mdlgen writes."""
    yield from _attachments(mine, given)
    acting, instance = given.reading.acting_on(given.prefix), given.prefix
    for statement in acting[:_MOST]:
        what = f"*{statement.name}( {statement.arg(0)}, ... )"
        yield f"{statement.place()}: {what} of the model acts on the sheets {instance[:-1]}"
    if len(acting) > _MOST:
        yield f"and {len(acting) - _MOST} more statements of the model act on the sheets {instance[:-1]}"


def _attachments(mine: Read, given: Read) -> Iterator[str]:
    """Attachments that share what they are given, or have what another one is by the names of the scene."""
    instance = given.prefix
    found = [a for a in given.reading.attachments(instance) if a.given is not None]
    usual = {a.default.removeprefix("MODEL."): a.name for a in mine.reading.attachments(mine.prefix)}
    users: dict[str, list[str]] = {}
    for attached in found:
        users.setdefault(attached.given, []).append(attached.name)
    for name, attached in users.items():
        if len(attached) > 1:
            shown = ", ".join(attached[:4]) + (", ..." if len(attached) > 4 else "")
            yield f"{instance[:-1]} is given {name} for {len(attached)} attachments: {shown}"
        elif usual.get(name, attached[0]) != attached[0]:
            yield f"{instance}{attached[0]} is given {name}, which {usual[name]} is in the scene"
