"""The project's prose is plain: a subject first, words of the field, at most 32 words in a sentence."""

from __future__ import annotations

import ast
from pathlib import Path

import prose
import pytest
from places import ROOT

MOST = 0.01  # of all sentences
# Sentences that may stay, by a part of each, with the reason.
ALLOWED: dict[str, str] = {}


def written() -> list[Path]:
    """The manual, the README and all modules; what a generator writes has its sentences from there."""
    files = [ROOT / "README.md", ROOT / "CHANGELOG.md", *(ROOT / "docs").rglob("*.md")]
    for folder in ("mdlgen", "backends"):
        files += (ROOT / folder).rglob("*.py")
    link = ROOT / "mdlgen" / "backends"
    return sorted(f for f in files if link not in f.parents and "_build" not in f.parts)


def found(files: list[Path]) -> list[prose.Fault]:
    return [
        fault
        for file in files
        for fault in prose.faults(file, ROOT)
        if not any(part in fault.sentence for part in ALLOWED)
    ]


def test_at_most_one_sentence_of_a_hundred_must_be_read_twice() -> None:
    files = written()
    many = sum(len(prose.sentences(text)) for file in files for _, text in prose.paragraphs(file))
    hard = found(files)
    assert many > 10_000
    assert len(hard) <= MOST * many, "\n".join(f"{f.place}: {f.kind}: {f.sentence[:100]}" for f in hard)


def test_the_readme_and_the_tutorials_have_no_such_sentence() -> None:
    assert found([ROOT / "README.md", *sorted((ROOT / "docs" / "tutorials").glob("*.md"))]) == []


def test_messages_have_words_of_the_field() -> None:
    """Texts of more than three words in the code, docstrings aside, of which most are messages."""
    hard = []
    for file in written():
        if file.suffix != ".py":
            continue
        tree = ast.parse(file.read_text("utf-8"))
        documented = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
        hard += [
            f"{file.relative_to(ROOT)}:{node.lineno}: {node.value[:100]}"
            for node in ast.walk(tree)
            if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in documented
            if len(node.value.split()) > prose.SHORT and prose.PHRASE.search(node.value)
            if not any(part in node.value for part in (*ALLOWED, "--beside"))  # an option
        ]
    assert hard == []


@pytest.mark.parametrize(
    ("sentence", "kind"),
    [
        ("What is kept still is what two boxes have.", "opening"),
        ("The factor is made anew after so many solves.", "phrase"),
        ("The step and " * 12 + "the factor are one.", "long"),
        ("Why does a step fail?", None),
        ("The factor is recomputed.", None),
    ],
)
def test_a_hard_sentence_is_found(tmp_path: Path, sentence: str, kind: str | None) -> None:
    page = tmp_path / "page.md"
    page.write_text(f"# Title\n\n{sentence}\n")
    assert [fault.kind for fault in prose.faults(page, tmp_path)] == ([kind] if kind else [])
