"""What of a MotionView text no file shows, from the writer's own rows."""

from __future__ import annotations

from collections.abc import Iterator

from markdown import NOTE, table

from mdlgen.backends.motionview.writer import forms

HEAD = """# What is unverified

No MotionView was at hand when mdlgen was made. Most forms of a text are those of files that MotionView
saved and MotionSolve ran. These are all the others; each text lists at its head the ones that are in it.

## In no file and on no page

What a form is concluded from stands beside it. `htm` names a page of Altair's help.

"""
PAGES = f"""
## In Altair's help, in no file

Read as far as public copies of the pages go. A page without an address is in `{forms.MOTIONVIEW}`.

"""
TAIL = """
Where a file shows a form that says the same, the text has that one: axes by vectors, run settings in a
system, clutches as torques by formula.
"""


def page() -> str:
    """motionview/unverified.md."""
    rows = (*forms.UNVERIFIED, forms.OF_SCRIPTS, forms.OF_SYSTEMS)
    doubtful = table(("form", "why it is doubtful", "look at"), ((r.form, r.why, r.look) for r in rows))
    known = table(("form", "page"), _known())
    return f"{NOTE}{HEAD}{doubtful}{PAGES}{known}{TAIL}"


def _known() -> Iterator[tuple[str, str]]:
    for row in (*forms.DOCUMENTED, forms.OF_ATTACHMENTS):
        yield row.form, ", ".join(f"`{page}`" for page in row.pages)
