"""Journals: read back bit for bit; of a cut tail all whole records come back, and what was cut is said."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from ulna.ground.errors import UlnaInputError
from ulna.live.journal import EVENT, HEAD, MAGIC, SAMPLES, TOUCH, WITHDRAWAL, Journal, Reading, packed, unpacked
from ulna.live.samples import Hello, Samples

HELLO = Hello(("a", "b", "c"), "counts", "a double", 100.0)
ANY = st.floats(allow_nan=True, allow_infinity=True, width=64)


def same(one: Samples, other: Samples) -> None:
    """To the last bit."""
    assert one.t_host_s.tobytes() == other.t_host_s.tobytes()
    assert one.raw.tobytes() == other.raw.tobytes()
    assert one.raw.shape == other.raw.shape
    for mine, its in ((one.t_device_s, other.t_device_s), (one.button, other.button)):
        assert (mine is None) == (its is None)
        assert mine is None or its is None or mine.tobytes() == its.tobytes()


@st.composite
def some_samples(draw: st.DrawFn) -> Samples:
    n, channels = draw(st.integers(0, 20)), draw(st.integers(0, 8))
    return Samples(
        draw(arrays(np.float64, n, elements=ANY)),
        draw(st.none() | arrays(np.float64, n, elements=ANY)),
        draw(arrays(np.float64, (n, channels), elements=ANY)),
        draw(st.none() | arrays(np.bool_, n)),
    )


@given(samples=some_samples())
def test_a_block_is_exact(samples: Samples) -> None:
    same(unpacked(packed(samples)), samples)


@given(block=st.binary(max_size=200))
def test_a_block_of_anything_is_refused_or_read(block: bytes) -> None:
    with suppress(ValueError):
        unpacked(block)


def walk(n: int, begin_s: float = 0.0) -> Samples:
    rng = np.random.default_rng(n)
    t = begin_s + np.arange(n) / 100.0
    return Samples(t, t * 1.000001, rng.normal(size=(n, 3)), rng.random(n) < 0.1)


def write(path: Path) -> list[Any]:
    with Journal.create(path, HELLO, study="study.toml") as journal:
        journal.samples(walk(50))
        journal.touch({"number": 1, "q_rad": [0.1, 0.2, 1 / 3]})
        journal.samples(walk(30, 0.5))
        journal.event({"kind": "gap", "text": "a gap of 80 ms in the stream."})
        journal.withdraw({"number": 1, "reason": "ball not seated"})
    return [record.content for record in Reading(path)]


def test_it_comes_back_in_order(tmp_path: Path) -> None:
    path = tmp_path / "j"
    write(path)
    reading = Reading(path)
    records = list(reading)
    assert [record.kind for record in records] == [HEAD, SAMPLES, TOUCH, SAMPLES, EVENT, WITHDRAWAL]
    same(records[1].content, walk(50))
    same(records[3].content, walk(30, 0.5))
    assert records[2].content == {"number": 1, "q_rad": [0.1, 0.2, 1 / 3]}
    assert (reading.hello, reading.cut, reading.head["study"]) == (HELLO, None, "study.toml")


def test_cut_at_every_byte_of_its_tail(tmp_path: Path) -> None:
    path = tmp_path / "j"
    write(path)
    content = path.read_bytes()
    begins = [record.at for record in Reading(path)]
    cut = tmp_path / "cut"
    for size in range(begins[1], len(content)):
        cut.write_bytes(content[:size])
        reading = Reading(cut)
        found = list(reading)
        whole = [at for at, end in zip(begins, [*begins[1:], len(content)], strict=True) if end <= size]
        assert [record.at for record in found] == whole
        assert (reading.cut is None) == (size in begins)
        assert reading.cut is None or f"the last {size - begins[len(whole)]} bytes" in reading.cut


def test_one_goes_on_from_a_cut_tail(tmp_path: Path) -> None:
    path = tmp_path / "j"
    write(path)
    path.write_bytes(path.read_bytes()[:-3])
    journal, cut = Journal.open(path)
    assert cut is not None
    assert "left out" in cut
    with journal:
        journal.touch({"number": 2})
    reading = Reading(path)
    assert [record.kind for record in reading] == [HEAD, SAMPLES, TOUCH, SAMPLES, EVENT, TOUCH]
    assert reading.cut is None


def test_damage_before_the_end_is_no_cut_tail(tmp_path: Path) -> None:
    path = tmp_path / "j"
    write(path)
    content = bytearray(path.read_bytes())
    begins = [record.at for record in Reading(path)]
    for at in (begins[1], begins[1] + 3, begins[1] + 4, begins[2] + 20):  # a length (longer than the file), a kind, …
        spoilt = content.copy()
        spoilt[at] ^= 0x7F
        path.write_bytes(spoilt)
        with pytest.raises(UlnaInputError, match="damaged at byte"):
            list(Reading(path))
        with pytest.raises(UlnaInputError, match="damaged at byte"):
            Journal.open(path)
        assert path.read_bytes() == spoilt


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=50)
@given(rest=st.binary(max_size=300))
def test_what_is_no_journal_is_said(tmp_path: Path, rest: bytes) -> None:
    path = tmp_path / "x"
    path.write_bytes(MAGIC + rest)
    with pytest.raises(UlnaInputError, match="journal"):
        Reading(path)
    path.write_bytes(b"x" + rest)
    with pytest.raises(UlnaInputError, match="not a journal"):
        Reading(path)


def test_a_journal_is_never_overwritten(tmp_path: Path) -> None:
    path = tmp_path / "j"
    write(path)
    with pytest.raises(UlnaInputError, match="never overwritten"):
        Journal.create(path, HELLO)


def test_a_touch_is_on_the_disk_when_it_is_taken(tmp_path: Path) -> None:
    path = tmp_path / "j"
    journal = Journal.create(path, HELLO)
    journal.samples(walk(5))
    journal.touch({"number": 1})
    assert [record.kind for record in Reading(path)] == [HEAD, SAMPLES, TOUCH]  # nobody closed it
    journal.close()
