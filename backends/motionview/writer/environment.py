"""The Jinja environment of the MDL templates.

Delimiters are `<< >>`, `<% %>` and `<# #>`, because MDL uses braces. Inside `<% filter values("note") %>`
a short `$L_x` stands for `ds_note.real_L_x.value`: the formulas can be read.
"""

from __future__ import annotations

import re
from functools import lru_cache
from textwrap import dedent

from jinja2 import Environment

from mdlgen import templating
from mdlgen.altair.refinement import GRAPHICS
from mdlgen.backends.motionview.writer.units import number

_DEFINITION = re.compile(r"^ *\*DefineDataSet\(.*?^ *\*EndDefine\(\)\n", re.M | re.S)
_NAMED = re.compile(r"(?<=[(,] )def_ds_")
_MEMBER = re.compile(r"\$([A-Za-z][A-Za-z0-9_]*)")


def values(text: str, data_set: str) -> str:
    """`text` with every `$member` written out as the value of that member of a data set."""
    return _MEMBER.sub(lambda member: f"ds_{data_set}.real_{member[1]}.value", text)  # a template is slower


def own_definitions(text: str, system: str) -> str:
    """`text` with the name of a system in its definitions of data sets: they stand in the user's model."""
    return _NAMED.sub(f"def_ds_{system}_", text)


def without_definitions(body: str) -> str:
    """`body` without the definitions of data sets, which must not be in a system definition."""
    return _DEFINITION.sub("", body)


def definitions(body: str) -> str:
    """The definitions of data sets that `body` holds, one step further out."""
    return "\n".join(dedent(text) for text in _DEFINITION.findall(body))


@lru_cache(maxsize=1)
def environment() -> Environment:
    """One environment for all texts."""
    made = templating.environment(
        "motionview",
        autoescape=False,  # MDL is not HTML; names and labels pass the allow-list instead
        variable_start_string="<<",
        variable_end_string=">>",
        block_start_string="<%",
        block_end_string="%>",
        comment_start_string="<#",
        comment_end_string="#>",
    )
    made.filters["values"] = values
    made.filters["number"] = number
    made.filters["own_definitions"] = own_definitions
    made.filters["without_definitions"] = without_definitions
    made.filters["definitions"] = definitions
    made.globals.update(GRAPHICS)
    return made
