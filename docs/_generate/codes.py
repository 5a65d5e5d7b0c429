"""What the codes of check and lint mean."""

from __future__ import annotations

from markdown import NOTE, table

from mdlgen.explain import SCENE, TEXT

EXITS = (
    ("0", "done"),
    ("1", "an internal error; `-v` shows the traceback. Please report it"),
    ("2", "a mistake in a scene, a value or a call; a MotionView text with errors (`lint`)"),
    ("3", "a file that cannot be read or written"),
    (
        "4",
        "no usable result: a run ended early, or its energies do not balance; what there is up to then is "
        "written and marked",
    ),
    (
        "5",
        "a result whose error is above `run.tolerance`, or is not known: it is written, with status "
        "`inaccurate`; or `verify` found a difference, or `compare --within` a larger one",
    ),
    (
        "6",
        "a run misses what its scene requires; its results are written. An inaccurate run that misses it "
        "within its error ends with 5",
    ),
    ("130", "interrupted by Ctrl-C"),
)


def page() -> str:
    """reference/codes.md."""
    return (
        f"{NOTE}# Exit codes, and codes of check and lint\n\n## Exit codes\n\n"
        f"{table(('code', 'meaning'), EXITS)}\n"
        "## Codes of `mdlgen check`\n\nA code names a value that is allowed and looks wrong. It does not "
        "stop a run. `mdlgen explain W104` prints the same text.\n\n"
        f"{table(('code', 'meaning and remedy'), ((f'`{k}`', v) for k, v in SCENE.items()))}\n"
        "## Codes of `mdlgen lint`\n\nA finding about a MotionView text is an error or a warning. Errors "
        "end `lint` with exit code 2.\n\n"
        f"{table(('code', 'meaning'), ((f'`{k}`', v) for k, v in TEXT.items()))}"
    )
