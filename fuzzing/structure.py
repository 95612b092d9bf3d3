"""Documents spoilt where it matters: keys dropped, named otherwise, given twice; values of other kinds and shapes."""

from __future__ import annotations

import copy
from collections.abc import Callable
from random import Random
from typing import Any

from fuzzing.values import Raw, any_value, deep, number, text

Path = tuple[str | int, ...]


def spoilt(document: Any, source: Random, dates: bool = False) -> Any:
    """The same with one to three things wrong, or none that is seen."""
    found = copy.deepcopy(document)
    for _ in range(source.choice([1, 1, 1, 2, 3])):
        places = list(_places(found, ()))
        if not places:
            return any_value(source, dates)
        # half of the time first a depth, then a place in it: long lists would take it all
        if source.random() < 0.6:
            depth = source.choice(sorted({len(place) for place in places}))
            places = [place for place in places if len(place) == depth]
        place = source.choice(places)
        owner = _at(found, place[:-1])
        source.choice(_WAYS)(found, owner, place[-1], source, dates)
    return found


def _places(value: Any, path: Path) -> Any:
    children = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for name, child in children:
        yield (*path, name)
        yield from _places(child, (*path, name))


def _at(document: Any, path: Path) -> Any:
    for step in path:
        document = document[step]
    return document


def _drop(_all: Any, owner: Any, name: Any, _source: Random, _dates: bool) -> None:
    del owner[name]


def _any(_all: Any, owner: Any, name: Any, source: Random, dates: bool) -> None:
    owner[name] = any_value(source, dates)


def _alike(_all: Any, owner: Any, name: Any, source: Random, _dates: bool) -> None:
    """Of its own kind, and strange."""
    value = owner[name]
    if isinstance(value, bool) or value is None:
        owner[name] = source.choice([not value, 0, 1, "true", None])
    elif isinstance(value, int | float):
        owner[name] = source.choice(
            [number(source), -value, value * 1000, value / 1000, str(value), bool(value), [value]]
        )
    elif isinstance(value, str):
        owner[name] = source.choice(
            [text(source), value.upper(), value + " ", value[:-1], value + text(source), [value]]
        )
    elif isinstance(value, list):
        owner[name] = _list(value, source)
    elif isinstance(value, dict):
        owner[name] = source.choice([{}, [value], [], text(source), list(value.values())])
    else:
        owner[name] = source.choice([[value], str(value), any_value(source)])


def _list(value: list[Any], source: Random) -> Any:
    if not value:
        return [any_value(source)]
    at = source.randrange(len(value))
    ways: list[Callable[[], Any]] = [
        lambda: [],
        lambda: value[:at],
        lambda: value + value,
        lambda: [*value[:at], value[at], *value[at:]],
        lambda: [*value, number(source)],
        lambda: value[::-1],
        lambda: [value],
        lambda: [[each] for each in value],
        lambda: value[0],
        lambda: {str(k): each for k, each in enumerate(value)},
        lambda: value * 50 if len(value) < 50 else value,
    ]
    return source.choice(ways)()


def _rename(_all: Any, owner: Any, name: Any, source: Random, dates: bool) -> None:
    if isinstance(owner, list):
        _any(_all, owner, name, source, dates)
        return
    other = source.choice([text(source), name.upper(), f"{name}s", name[:-1], f"{name}.{name}", name[::-1]])
    owner[other] = owner.pop(name)


def _more(_all: Any, owner: Any, _name: Any, source: Random, dates: bool) -> None:
    if isinstance(owner, list):
        owner.insert(source.randrange(len(owner) + 1), any_value(source, dates))
    else:
        owner[text(source)] = any_value(source, dates)


def _swap(document: Any, owner: Any, name: Any, source: Random, _dates: bool) -> None:
    """With another place, wherever it is, unless one lies in the other."""
    places = list(_places(document, ()))
    other = source.choice(places)
    there = _at(document, other[:-1])
    mine, theirs = owner[name], there[other[-1]]
    if isinstance(mine, dict | list) or isinstance(theirs, dict | list):
        owner[name] = copy.deepcopy(theirs)
    else:
        owner[name], there[other[-1]] = theirs, mine


def _deep(_all: Any, owner: Any, name: Any, source: Random, _dates: bool) -> None:
    owner[name] = deep(source)


def _everywhere(document: Any, owner: Any, name: Any, source: Random, _dates: bool) -> None:
    """A text that names something, everywhere: documents that agree with themselves and with nothing else."""
    old = owner[name]
    if isinstance(old, str) and old:
        _replace(document, old, text(source))
    else:
        _alike(document, owner, name, source, _dates)


def _replace(value: Any, old: str, new: str) -> None:
    items: list[Any] = list(value.items()) if isinstance(value, dict) else list(enumerate(value))
    for name, child in items:
        if isinstance(child, dict | list):
            _replace(child, old, new)
        elif child == old and not isinstance(child, Raw):
            value[name] = new
        if name == old:
            value[new] = value.pop(name)


_Way = Callable[[Any, Any, Any, Random, bool], None]
_WAYS: list[_Way] = [
    _drop,
    _drop,
    _any,
    _any,
    _alike,
    _alike,
    _alike,
    _alike,
    _rename,
    _more,
    _swap,
    _deep,
    _everywhere,
]
