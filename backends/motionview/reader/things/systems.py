"""Systems, data sets, compound graphics and analyses: things that hold others."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from mdlgen.backends.motionview.reader.pair import Pair, Unmade
from mdlgen.backends.motionview.reader.report import Trouble
from mdlgen.backends.motionview.reader.things.external import External
from mdlgen.backends.motionview.reader.things.thing import Thing

if TYPE_CHECKING:
    from mdlgen.backends.motionview.reader.scope import Declaration, Scope
    from mdlgen.backends.motionview.reader.world import World


class System(Thing):
    """An instance of a definition."""

    kind = "System"

    def __init__(self, world: World, declaration: Declaration | None, inner: Scope | None):
        if declaration is not None:
            super().__init__(world, declaration, "")
        else:
            self.world = world
            self.side = ""
            self.memo = {}
        self.inner = inner
        if inner is not None:
            self.call(inner.path[:-1] or "MODEL")

    def __str__(self) -> str:
        return f"system {self.name}" if self.inner and self.inner.path else "the model"

    def compute(self, key: str) -> Any:
        if key.startswith("argument "):
            return self._argument(key.removeprefix("argument "))
        if self.inner is not None and self.inner.parent is None:
            begin = self.world.program.begin
            if key == "label" and begin is not None:
                return self.world.value(begin, 1, self.inner) if begin.arg(1) else ""
        return super().compute(key)

    def attribute(self, key: str, name: str, shift: int) -> Any:
        if self.inner is None:
            if key in ("label", "state", "id", "idstring", "l", "r", "full_varname", "varname"):
                return super().attribute(key, name, shift)
            definition = self.statement.arg(2)
            message = f"{self.name}.{name} is not known: {definition} is defined in no text that was read"
            raise Trouble("external", message, shift, "warning")
        found = self.inner.member(name)
        if found is not None:
            return found
        if key in ("label", "id", "idstring", "l", "r", "full_varname", "varname", "state"):
            return super().attribute(key, name, shift)
        if key == "parent":
            return self.world.system(self.inner.parent or self.inner)
        built_in = self.world.built_in(name) if self.inner.parent is None else None
        if built_in is not None:
            return built_in
        if self.inner.parent is None and name.startswith("mat_"):
            return Unmade(name, "the standard include")
        if self.inner.standard:
            return Unmade(f"{self.name}.{name}", "the standard include")
        raise Trouble("dangling", f"{self} has no {name}", shift)

    def _argument(self, name: str) -> Any:
        """Value given in the scope of the instance; else the default of the attachment."""
        assert self.inner is not None
        parameter = self.inner.parameters[name]
        outside = self.inner.parent
        assert outside is not None
        attachment = parameter.attachment
        pair = attachment is not None and attachment.arg(2).lower().endswith("pair")
        if parameter.external and attachment is None:
            return Unmade(parameter.external, "the model that this text is made for")
        if parameter.external and pair:
            return Pair(*(External(parameter, parameter.external, side) for side in "lr"))
        if parameter.external:
            return External(parameter, parameter.external)
        if parameter.instance.arg(parameter.at):
            value = self.world.value(parameter.instance, parameter.at, outside)
        elif attachment is not None and attachment.arg(4):
            value = self.world.value(attachment, 4, outside)
        else:
            message = f"{self} is given nothing for its attachment {name}"
            trouble = Trouble("attachment", message, severity="warning")
            trouble.place = parameter.instance.place()
            raise trouble
        if pair and value.__class__ not in (Pair, Unmade):
            return Pair(value, value)
        return value


class DataSet(System):
    """An instance of a data set definition."""

    kind = "DataSet"

    def __str__(self) -> str:
        return f"data set {self.name}"
