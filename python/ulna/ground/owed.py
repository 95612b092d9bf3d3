"""What a class owes that stands for one kind of a thing, and has not got."""

from __future__ import annotations

from collections.abc import Mapping


def missing(what: str, one: type, owed: Mapping[str, str]) -> list[str]:
    """What `one`, a `what` ("kind", "effect"), lacks of what it owes, in words; owed: attribute → what it is."""
    name = getattr(one, "name", one.__name__)
    abstract: frozenset[str] = getattr(one, "__abstractmethods__", frozenset())
    return [
        f"{what} '{name}' lacks {attribute}: {said}"
        for attribute, said in owed.items()
        if not hasattr(one, attribute) or attribute in abstract
    ]
