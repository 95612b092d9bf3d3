"""Values that are made when somebody first asks for them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, Self


class OnDemand:
    """A dataclass some of whose fields may come as functions, each called when its field is first read.

    So a caller who wants three numbers of a result pays for three. To whoever reads them the fields are ordinary ones:
    `dataclasses.replace`, comparison and pickling make them all.
    """

    @classmethod
    def on_demand(cls, parts: Mapping[str, Callable[[], Any]]) -> Self:
        """An instance with a function for each of its fields."""
        made = cls.__new__(cls)
        made.__dict__["_parts"] = dict(parts)
        return made

    def __getstate__(self) -> dict[str, Any]:
        """Every field, made; the functions stay here, with whatever they hold."""
        for name in list(self.__dict__.get("_parts", {})):
            getattr(self, name)
        return {name: value for name, value in self.__dict__.items() if name != "_parts"}

    if not TYPE_CHECKING:  # a checker would take any name for a field

        def __getattr__(self, name: str) -> Any:
            """Called only for what is not there yet."""
            make = self.__dict__.get("_parts", {}).get(name)
            if make is None:
                raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}")
            value = self.__dict__[name] = make()
            self.__dict__["_parts"].pop(name, None)
            return value
