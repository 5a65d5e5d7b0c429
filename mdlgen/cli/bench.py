"""Run time against error."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from types import ModuleType
from typing import Annotated, Any

import typer

from mdlgen import paths
from mdlgen.cli import completion
from mdlgen.cli.shell import (
    SOLVER_FAILED,
    Json,
    Quiet,
    Verbose,
    app,
    echo_json,
    reports_errors,
    say,
)
from mdlgen.errors import AccuracyError, SpecError

CAMPAIGN, TUNING, AUTO = "campaign", "tuning", "auto"


@app.command()
@reports_errors
def bench(
    suites: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="SUITE ...",
            help="transport, elastica, impact, friction, flight, scaling, skip, feeder, piles, streams, "
            "stability, validation, core: all if left out; or campaign, scenes drawn at random; or tuning, "
            "the numbers of the solver lattice halved and doubled.",
            autocompletion=completion.suites,
        ),
    ] = None,
    output: Annotated[Path, typer.Option("-o", "--output", metavar="DIR", help="Where the files go.")] = Path(
        "out/bench"
    ),
    solver: Annotated[
        list[str] | None,
        typer.Option(
            "--solver",
            metavar="NAME",
            help="One of the solvers: all if left out.",
            autocompletion=completion.every_solver,
        ),
    ] = None,
    quick: Annotated[bool, typer.Option("--quick", help="A few short cases of each suite.")] = False,
    repeat: Annotated[int, typer.Option("--repeat", min=1, help="Runs whose median is the wall time.")] = 3,
    peers: Annotated[
        bool | None,
        typer.Option(
            "--peers/--no-peers",
            help="Run MuJoCo and a plain Exudyn script in transport too; if left out, where the extra "
            "`peers` is installed and no solver is chosen.",
        ),
    ] = None,
    beside: Annotated[
        Path | None,
        typer.Option(
            "--beside",
            metavar="FOLDER",
            help="A checkout of another state of mdlgen, which runs each case, too, right after this one, "
            "with its own samples and measures.",
        ),
    ] = None,
    page: Annotated[
        Path | None,
        typer.Option(
            "--page",
            metavar="FILE",
            help="Write the page of one suite too: stability, validation, campaign or tuning.",
        ),
    ] = None,
    count: Annotated[int, typer.Option("--count", min=1, help="campaign: how many scenes.")] = 100,
    seed: Annotated[int, typer.Option("--seed", min=0, help="campaign: seed of the generator.")] = 1,
    only: Annotated[
        list[int] | None,
        typer.Option("--only", metavar="N", min=1, help="campaign: only the scene of this number."),
    ] = None,
    kind: Annotated[
        list[str] | None,
        typer.Option("--kind", metavar="KIND", help="campaign: only scenes of this kind."),
    ] = None,
    workers: Annotated[
        int | None,
        typer.Option("--workers", min=1, help="campaign: processes; one for each processor if left out."),
    ] = None,
    finer: Annotated[
        bool,
        typer.Option(
            "--finer/--no-finer", help="campaign: compare one scene in ten with an eighth of its step."
        ),
    ] = True,
    sticking: Annotated[
        bool, typer.Option("--sticking", help="campaign: friction sticks in every second contact.")
    ] = False,
    as_json: Json = False,
    quiet: Quiet = False,
    verbose: Verbose = False,
) -> None:
    """Measure run time against error.

    Writes bench.json, bench.md and bench.png into DIR.

    Example: mdlgen bench impact friction --solver exudyn

    Example: mdlgen bench stability --repeat 1 --page samples/stability.md

    Example: mdlgen bench campaign --count 1000 --seed 1

    Example: mdlgen bench tuning -o out/tuning

    Example: mdlgen bench core --solver lattice --beside ../before
    """
    if TUNING in (suites or ()):
        _check_alone(TUNING, suites or ())
        if quick or peers or beside or solver or only or kind or workers or sticking:
            raise SpecError("tuning takes the options -o, --page, --json, --quiet and --verbose alone")
        _tuning(output, page, as_json, quiet)
        return
    if CAMPAIGN in (suites or ()):
        _check_alone(CAMPAIGN, suites or ())
        if quick or peers or beside or len(solver or ()) > 1:
            raise SpecError("campaign takes one --solver, and none of --quick, --peers and --beside")
        chosen = {"only": only or (), "kinds": kind or (), "solver": (solver or [AUTO])[0]}
        options = {**chosen, "workers": workers, "finer": finer, "sticking": sticking}
        _campaign(count, seed, output, options, page, as_json, quiet)
        return
    from mdlgen.bench import page as pages
    from mdlgen.bench.run import bench as run_bench
    from mdlgen.bench.table import markdown
    from mdlgen.extras import require
    from mdlgen.paths import check_folder

    shown = "" if page is None else pages.check_page(suites or ())
    require("matplotlib")
    check_folder(output)
    heard = (lambda _: None) if quiet else say
    found = run_bench(suites or (), output, solver or (), quick, repeat, heard, peers, beside)
    if as_json:
        echo_json(found.json())
    elif not quiet:
        typer.echo(markdown(found), nl=False)
        typer.echo(f"wrote {output}")
    if page is not None:
        paths.write_atomic(page, pages.page(shown, found))
        if not quiet:
            say(f"wrote {page}")
    if found.wrong:
        row = found.wrong[0]
        raise AccuracyError(f"{len(found.wrong)} wrong: {row.case}, {row.solver}: {row.reason}")
    if found.failed:
        row = found.failed[0]
        say(f"{len(found.failed)} failed: {row.case}, {row.solver}: {row.reason}")
        raise typer.Exit(SOLVER_FAILED)


def _check_alone(name: str, suites: Sequence[str]) -> None:
    """Raises SpecError where this suite is asked for with other ones."""
    if list(suites) != [name]:
        raise SpecError(f"{name} runs alone: mdlgen bench {name}")


def _shown(
    found: Any, report: ModuleType, output: Path, page: Path | None, as_json: bool, quiet: bool
) -> None:
    """Prints the result of a suite that runs alone, and writes its page. `report` has `table` and `page`."""
    if as_json:
        echo_json(found.json())
    elif not quiet:
        typer.echo(report.table(found), nl=False)
        typer.echo(f"wrote {output}")
    if page is not None:
        paths.write_atomic(page, report.page(found))
        if not quiet:
            say(f"wrote {page}")


def _tuning(output: Path, page: Path | None, as_json: bool, quiet: bool) -> None:
    """Halves and doubles each number of the solver lattice."""
    from mdlgen.bench.tuning import report
    from mdlgen.bench.tuning.run import tuning
    from mdlgen.paths import check_folder

    check_folder(output)
    found = tuning(output, (lambda _: None) if quiet else say)
    _shown(found, report, output, page, as_json, quiet)


def _campaign(
    count: int,
    seed: int,
    output: Path,
    options: dict[str, Any],
    page: Path | None,
    as_json: bool,
    quiet: bool,
) -> None:
    """Runs scenes drawn at random. Exit code 5: an error is far above its estimate; 4: a scene has no
    result."""
    from mdlgen.bench.campaign import report
    from mdlgen.bench.campaign.counts import counts
    from mdlgen.bench.campaign.finer import FAR
    from mdlgen.bench.campaign.run import campaign
    from mdlgen.paths import check_folder

    check_folder(output)
    heard = (lambda _: None) if quiet else say
    found = campaign(count, seed, output, say=heard, **options)
    _shown(found, report, output, page, as_json, quiet)
    made = counts(found.rows)
    if made.wrong:
        raise AccuracyError(f"{made.wrong} quantities are above {FAR:g} times their estimate")
    if made.none:
        say(f"{made.none} of {made.scenes} scenes have no result")
        raise typer.Exit(SOLVER_FAILED)
