"""The command line, from its own help."""

from __future__ import annotations

import inspect
from typing import Any

import typer
from markdown import NOTE, table

from mdlgen.cli import app

HEAD = f"""{NOTE}# The command line

`mdlgen COMMAND ...`, also `python -m mdlgen COMMAND ...`. Progress and remarks go to standard error, results
to standard output. [Exit codes](codes.md#exit-codes) are the same for all commands.

Every command that takes `SPEC` takes `--set PATH=VALUE`, more than once: any value of the scene by its dotted
path, written as in the file. An index counts from 0.

    mdlgen check scene.yaml --set sheets.note.boxes=[20,30] --set contacts.0.friction=0.4

"""


def page() -> str:
    """reference/commands.md."""
    group: Any = typer.main.get_command(app)
    context = group.make_context("mdlgen", ["schema"], resilient_parsing=True)
    names = group.list_commands(context)
    rows = [(f"[`{n}`](#mdlgen-{n})", _first(group.commands[n])) for n in names]
    general = [_option(p) for p in group.get_params(context) if p.param_type_name == "option"]
    own = table(("option of mdlgen itself", "meaning"), general)
    return f"{HEAD}{table(('command', 'does'), rows)}\n{own}\n" + "\n".join(
        _section(name, group.commands[name], context) for name in names
    )


def _paragraphs(command: Any) -> list[str]:
    return [" ".join(p.split()) for p in inspect.cleandoc(command.help or "").split("\n\n")]


def _first(command: Any) -> str:
    return _paragraphs(command)[0]


def _section(name: str, command: Any, parent: Any) -> str:
    context = command.context_class(command, info_name=name, parent=parent)
    params = command.get_params(context)
    arguments = [p for p in params if p.param_type_name == "argument"]
    options = [p for p in params if p.param_type_name == "option" and not p.hidden]
    words = _paragraphs(command)
    plain = [p for p in words if not p.startswith("Example: ")]
    examples = "\n".join("    " + p.removeprefix("Example: ") for p in words if p.startswith("Example: "))
    used = " ".join(["mdlgen", name, *(_placed(a) for a in arguments), "[OPTIONS]"])
    rows = [(f"`{_metavar(a)}`", a.help or "") for a in arguments] + [_option(p) for p in options]
    head = f"## mdlgen {name}\n\n" + "\n\n".join(plain) + f"\n\n    {used}\n\n"
    shown = f"Examples:\n\n{examples}\n" if examples else ""
    return f"{head}{table(('argument, option', 'meaning'), rows)}\n{shown}"


def _metavar(param: Any) -> str:
    return param.metavar or (param.name or "").upper()


def _placed(argument: Any) -> str:
    shown = _metavar(argument)
    return shown if argument.required else f"[{shown}]"


def _option(param: Any) -> tuple[str, str]:
    # click keeps the names of help in a set
    opts = sorted(param.opts, key=lambda name: name.startswith("--"))
    names = ", ".join(f"`{name}`" for name in (*opts, *param.secondary_opts))
    if not param.is_flag and not param.count:
        names += f" `{_metavar(param)}`"
    default = param.default
    words = param.help or ""
    if default not in (None, False, "", ()) and not param.is_flag and not callable(default):
        words = f"{words.rstrip('.')} (default `{default}`)."
    return names, words
