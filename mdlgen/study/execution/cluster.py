"""Cases on a Dask cluster: its scheduler spreads them, runs those of a dead worker again, and sends rows back
as they are done. The same function runs here as in a process of this machine."""

from __future__ import annotations

import logging
import re
from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import cache
from typing import Any

from mdlgen.errors import OutputError, RefusedError, SpecError
from mdlgen.study.design.case import Case
from mdlgen.study.design.task import Task
from mdlgen.study.execution.perform import perform
from mdlgen.study.execution.row import LOST, CaseRow

MISSING = "--scheduler needs dask.distributed, which is not installed: pip install 'mdlgen[cluster]'"
# How long a scheduler and its first worker are waited for [s].
PATIENCE = 20.0
# Cases under way at once, for each thread of the cluster: enough that none waits, few enough to hold.
AHEAD = 4
_ADDRESS = re.compile(r"(tcp|tls)://[^\s/]+:[0-9]{1,5}")

Versions = dict[str, str]


@cache
def versions() -> Versions:
    """All versions that determine the bits of a row, of this process; equal on all machines of a cluster."""
    from mdlgen import registry
    from mdlgen.runs.provenance import provenance

    return provenance(registry.packages("auto"))


def _here() -> Versions:
    """Versions of the process that asks."""
    return versions()


def checked(task: Task, case: Case, here: Versions) -> CaseRow:
    """The row of a case, on a worker; one that came later with other versions gives none.

    Raises RuntimeError.
    """
    if message := differences(versions(), here):
        raise RuntimeError(f"the worker has {message}")
    from distributed import get_worker

    return replace(perform(task, case), worker=str(get_worker().address))


def differences(there: Versions, here: Versions) -> str:
    """Differences in words, as `numpy 1.26.4, here 2.4.6`; empty where there are none."""
    words = {"code": "other code of the solver"}
    return "; ".join(
        words.get(name, f"{name} {there.get(name)}, here {value}")
        for name, value in here.items()
        if there.get(name) != value
    )


class Cluster:
    """The workers of the scheduler at `address` (tcp://host:port).

    Raises SpecError for what is no address, RefusedError where dask.distributed is not installed or a worker
    has other versions, OutputError where no scheduler answers or it has no workers.
    """

    def __init__(self, address: str):
        if not _ADDRESS.fullmatch(address):
            raise SpecError(f"--scheduler {address[:80]!r}: is no address; write like tcp://127.0.0.1:8786")
        try:
            from distributed import Client
        except ImportError:
            raise RefusedError(MISSING) from None
        self.address = address
        for name in list(logging.root.manager.loggerDict):
            if name.partition(".")[0] == "distributed":  # errors are reported in one line
                logging.getLogger(name).setLevel(logging.CRITICAL)
        try:
            self._client: Any = Client(address, timeout=PATIENCE, set_as_default=False)
        except (OSError, TimeoutError, ValueError) as error:
            message = str(error).partition("\n")[0][:200]
            raise OutputError(f"{address}: no scheduler answers there ({message})") from None
        try:
            self._check()
        except BaseException:
            self.close()
            raise

    def _check(self) -> None:
        try:
            self._client.wait_for_workers(1, timeout=PATIENCE)
        except TimeoutError:
            raise OutputError(f"{self.address}: the scheduler has no workers; start dask worker") from None
        self._here = _here()
        for worker, there in self._client.run(versions, on_error="return").items():
            if isinstance(there, ImportError):
                raise RefusedError(f"{worker}: this worker cannot import mdlgen ({there})"[:300])
            if isinstance(there, BaseException):
                raise OutputError(f"{worker}: does not report its versions ({there})"[:300])
            if message := differences(there, self._here):
                raise RefusedError(f"{worker}: this worker has {message}; install the same on all")

    def rows(self, task: Task, cases: Sequence[Case]) -> Iterator[CaseRow]:
        """The rows of the cases, as they are done. Raises OutputError where the scheduler is gone."""
        from distributed import as_completed

        todo = iter(cases)
        threads = sum(self._client.nthreads().values())
        under_way = as_completed(loop=self._client.loop)
        waiting: dict[Any, Case] = {}

        def submit() -> None:
            case = next(todo, None)
            if case is not None:
                future = self._client.submit(checked, task, case, self._here, pure=False)
                waiting[future] = case
                under_way.add(future)

        try:
            for _ in range(max(1, AHEAD * threads)):
                submit()
            for future in under_way:
                yield self._row(future, waiting.pop(future))
                submit()
        finally:
            if waiting and self._client.status == "running":
                self._client.cancel(list(waiting), force=True)

    def _row(self, future: Any, case: Case) -> CaseRow:
        """The row of a case that is done; lost where its workers died, or could not run it at all."""
        from distributed import CancelledError, KilledWorker

        try:
            return future.result()
        except CancelledError:
            raise OutputError(f"{self.address}: the scheduler is gone") from None
        except KilledWorker as error:
            message = f"its worker died, {error.allowed_failures + 1} times"
        except Exception as error:  # whatever its worker could not do is no end of the sweep
            message = f"its worker: {type(error).__name__}: {error}"[:300]
        return CaseRow(case.index, case.values, LOST, message)

    def close(self) -> None:
        self._client.close()
