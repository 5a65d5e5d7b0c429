"""Values in a Python script that are read without running it: assignments of literals, with their places."""

from __future__ import annotations

import ast
from typing import Any

from mdlgen.errors import Place, SpecError


def name_of(statement: ast.stmt) -> str:
    """The one name that a statement assigns to, "" where it is another statement."""
    if isinstance(statement, ast.Assign) and len(statement.targets) == 1:
        target = statement.targets[0]
        return target.id if isinstance(target, ast.Name) else ""
    return ""


def literal(statement: ast.Assign, file: str) -> Any:
    """The value of an assignment. Raises SpecError where it is no literal."""
    try:
        return ast.literal_eval(statement.value)
    except (ValueError, TypeError, RecursionError, MemoryError, SyntaxError):
        message = "only plain numbers, texts, lists and tables are due here"
        raise wrong(message, statement.value, file) from None


def wrong(message: str, node: ast.AST, file: str) -> SpecError:
    """An error at the place of a node."""
    place = Place(file, getattr(node, "lineno", 1), getattr(node, "col_offset", 0) + 1)
    return SpecError(message, place=place)


def without_notes(statements: list[ast.stmt]) -> list[ast.stmt]:
    """Statements without the text at the head, which is for people."""
    if statements and isinstance(statements[0], ast.Expr) and isinstance(statements[0].value, ast.Constant):
        return statements[1:]
    return statements
