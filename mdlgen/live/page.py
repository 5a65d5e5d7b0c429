"""The page of `mdlgen live`: one text, which asks its own server for all else."""

from __future__ import annotations

from mdlgen.report.html.environment import environment, library, licences, scripts, style

_SCRIPTS = ("drawing.js", "charts.js", "labels.js", "player.js", "play.js", "live.js")


def page(title: str, nonce: str) -> str:
    """The page; `nonce` marks the scripts and styles that may run."""
    return (
        environment()
        .get_template("live.html.j2")
        .render(
            title=title,
            runs=[],  # they come later
            nonce=nonce,
            style=style("live.css"),
            library=library(),
            licences=licences(),
            scripts=scripts(_SCRIPTS),
        )
    )


def policy(nonce: str) -> str:
    """Content-Security-Policy: scripts and styles of the page itself, and questions to its own server."""
    return (
        f"default-src 'none'; script-src 'nonce-{nonce}' blob:; style-src 'nonce-{nonce}'; img-src data:; "
        "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
    )
