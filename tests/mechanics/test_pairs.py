"""Kinds of contact pairs: what each has, and what chooses among them."""

from __future__ import annotations

from inspect import signature
from pathlib import Path
from types import ModuleType

import pytest

from mdlgen.mechanics import pair
from mdlgen.mechanics.by_kind import KINDS
from mdlgen.mechanics.solved import WITH_LAW
from mdlgen.model.tables import contacts
from mdlgen.program.digests import sources_digest, statements_digest
from mdlgen.program.kernel import LAWS, Kernel


def named(kind: ModuleType) -> str:
    return kind.__name__.rpartition(".")[2]


def test_a_kind_with_a_law_is_a_module_called_as_its_number() -> None:
    called = {kind: named(module).upper() for kind, module in KINDS.items()}
    assert called == {getattr(contacts, name): name for name in called.values()}
    assert KINDS.keys() == WITH_LAW


@pytest.mark.parametrize("kind", KINDS.values(), ids=named)
def test_a_kind_has_what_every_kind_must_have(kind: ModuleType) -> None:
    """Each with the parameters that its function has in all kinds."""
    plane = KINDS[contacts.BOX_PLANE]
    for name in ("force", "near", "apart", "deepest", "closing"):
        assert signature(getattr(kind, name).py_func) == signature(getattr(plane, name).py_func)
    assert hasattr(kind, "buried") == getattr(kind, "SOLID", False)
    assert hasattr(kind, "plate") == getattr(kind, "ON_PLATE", False)


def test_what_chooses_among_kinds_counts_in_the_digest_of_sources(monkeypatch: pytest.MonkeyPatch) -> None:
    """It holds the numbers of the kinds, and no file has its text."""
    digest = sources_digest.__wrapped__
    before = digest((LAWS,))
    monkeypatch.setattr(pair.near, "text", pair.near.text.replace("kind == 0", "kind == 10"))
    assert digest((LAWS,)) != before


def test_comments_and_docstrings_are_no_statements(monkeypatch: pytest.MonkeyPatch) -> None:
    """A program fits kernels whose comments alone are new; any other change makes it unfit."""
    digest, read = statements_digest.__wrapped__, Path.read_text

    def after(old: str, new: str) -> str:
        def changed(path: Path, *args: str) -> str:
            text = read(path, *args)
            assert path.name != "laws.py" or old in text
            return text.replace(old, new, 1) if path.name == "laws.py" else text

        monkeypatch.setattr(Path, "read_text", changed)
        return digest((LAWS,))

    before = digest((LAWS,))
    assert after('"""', '"""Once more. ') == before
    assert after('):\n    """', '):\n    """Once more. ') == before
    assert after("\n\n\n@njit", "\n\n\n# Another one.\n@njit") == before
    assert after("0.5 *", "0.6 *") != before


@pytest.mark.parametrize("kind", KINDS.values(), ids=named)
def test_what_a_kind_calls_says_whether_it_is_put_into_its_callers(kind: ModuleType) -> None:
    """Else numba puts it there or not by who calls it first, and sums are rounded by that."""
    kernels = {name: each for name, each in vars(kind).items() if isinstance(each, Kernel)}
    own = [each for each in kernels.values() if each.__module__ == kind.__name__]
    called = {kernels[name] for each in own for name in each.py_func.__code__.co_names if name in kernels}
    assert called
    assert {each for each in called if "forceinline" not in each.options} == set()
