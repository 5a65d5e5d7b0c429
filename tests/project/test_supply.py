"""What is installed: each dependency has a range, a pin for CI that lies in it, a reason in the manual."""

from __future__ import annotations

import re
import tomllib

import pytest
from packaging.requirements import Requirement
from places import ROOT

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
EXTRAS = PROJECT["optional-dependencies"]
NEEDED = [Requirement(text) for text in (*PROJECT["dependencies"], *EXTRAS["test"], *EXTRAS["docs"])]
ALL = [*NEEDED, *(Requirement(text) for text in EXTRAS["peers"])]


def name(text: str) -> str:
    return re.sub(r"[-_.]+", "-", text).lower()


def pins() -> dict[str, str]:
    lines = (ROOT / ".ci" / "constraints.txt").read_text("utf-8").splitlines()
    return dict(line.split("==") for line in lines if line and not line.startswith("#"))


@pytest.mark.parametrize("needed", NEEDED, ids=str)
def test_each_dependency_has_a_pin_in_its_range(needed: Requirement) -> None:
    assert pins()[name(needed.name)] in needed.specifier


@pytest.mark.parametrize("needed", ALL, ids=str)
def test_each_dependency_has_a_range(needed: Requirement) -> None:
    signs = sorted(part.operator for part in needed.specifier)
    assert signs == ["<", ">="]


def test_the_manual_says_what_each_is_for() -> None:
    page = ROOT / "docs" / "developers" / "dependencies.md"
    table = page.read_text("utf-8").partition("| dependency |")[2].partition("\n\n")[0]
    first = re.findall(r"^\| ([^|]+) \|", table, re.M)
    record = {name(word) for cell in first for word in re.findall(r"[\w.-]+", cell)}
    assert not {name(needed.name) for needed in ALL} - record


def test_pins_are_exact() -> None:
    assert all(re.fullmatch(r"[0-9][0-9a-z.]*", version) for version in pins().values())
