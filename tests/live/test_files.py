"""Recordings: journals and CSV files, at their speed, faster, or as fast as can be."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
import pytest
from tests.live.parts import collected

from ulna.ground.errors import UlnaInputError
from ulna.live.faults import ENDED, GARBAGE
from ulna.live.journal import Journal
from ulna.live.registry import opened
from ulna.live.samples import Hello, Samples
from ulna.live.stream import streaming

HELLO = Hello(("a", "b"), "deg", "a double")


def walk(n: int) -> Samples:
    t = 1000.0 + np.arange(n) / 100
    return Samples(t, t - 990, np.stack([10 * np.sin(t), 20 * np.cos(t)], axis=1), np.arange(n) % 50 == 0)


@pytest.fixture
def journal(tmp_path: Path) -> Path:
    path = tmp_path / "run.journal"
    with Journal.create(path, HELLO) as out:
        for k in range(0, 6000, 100):
            out.samples(walk(6000)[k : k + 100])
            out.event({"kind": "none", "text": "between"})
    return path


def test_a_journal_comes_back_bit_for_bit(journal: Path) -> None:
    with opened(f"file:{journal}?speed=max") as source:
        samples, faults, why = collected(source, 6001)
    assert source.hello == HELLO
    for mine, its in zip(vars(samples).values(), vars(walk(6000)).values(), strict=True):
        assert mine.tobytes() == its.tobytes()
    assert why is not None
    assert "end of the recording" in why
    assert [fault.kind for fault in faults] == [ENDED]


def test_speed_is_kept(journal: Path) -> None:
    """Ten times as fast: 60 s in 6 s; looked at after half a second, with much room for a busy machine."""
    with opened(f"file:{journal}?speed=10") as source:
        begin = time.monotonic()
        samples, _, _ = collected(source, 500)
        took = time.monotonic() - begin
    assert len(samples) < 3000
    assert took >= 0.49


def test_a_cut_journal_says_so_at_its_end(journal: Path) -> None:
    journal.write_bytes(journal.read_bytes()[:-2])
    with opened(f"file:{journal}?speed=max") as source:
        samples, faults, _ = collected(source, 6001)
    assert len(samples) == 6000  # the cut record was an event
    assert any("left out" in fault.text for fault in faults)


@pytest.mark.parametrize("separator", [",", ";", "\t"])
def test_csv_with_names(tmp_path: Path, separator: str) -> None:
    path = tmp_path / "run.csv"
    rows = [
        ["t_host_s", "elbow", "wrist", "button"],
        *[[str(5 + k / 10), str(k), str(-k), str(k % 2)] for k in range(20)],
    ]
    rows.insert(8, ["not", "a", "reading", "!"])
    path.write_text("\n".join(separator.join(row) for row in rows))
    with opened(f"file:{path}?speed=max") as source:
        samples, faults, _ = collected(source, 21)
    assert source.hello.channels == ("elbow", "wrist")
    np.testing.assert_array_equal(samples.raw, [[k, -k] for k in range(20)])
    np.testing.assert_array_equal(samples.t_host_s, 5 + np.arange(20) / 10)
    assert samples.button is not None
    assert list(samples.button) == [k % 2 == 1 for k in range(20)]
    assert [fault.kind for fault in faults] == [GARBAGE, ENDED]


def test_csv_without_names_at_a_rate(tmp_path: Path) -> None:
    path = tmp_path / "run.csv"
    path.write_text("".join(f"{k} {2 * k}\n" for k in range(5000)))
    with opened(f"file:{path}?speed=max&rate=50") as source:
        samples, _, _ = collected(source, 5001)
    assert source.hello == Hello(("c1", "c2"), None, str(path), 50.0)
    np.testing.assert_array_equal(samples.raw[:, 1], 2 * np.arange(5000))
    np.testing.assert_allclose(samples.t_host_s, np.arange(5000) / 50)


def test_a_journal_keeps_how_its_source_was_mapped(tmp_path: Path) -> None:
    path = tmp_path / "run.journal"
    source = {"format": "ulna-source/1", "url": "tcp://arm:1", "map": {"channels": ["b"], "unit": "deg"}}
    with Journal.create(path, HELLO, source=source) as out:
        out.samples(walk(10))
    with streaming(path) as stream:
        frames = stream.read(1.0)
    assert stream.mapping.names == ("b",)
    np.testing.assert_allclose(frames.q_rad[:, 0], np.radians(walk(10).raw[: len(frames.q_rad), 1]))


@pytest.mark.parametrize(
    ("content", "words"),
    [("", "line 1 is empty"), (",".join("abcdefghij" * 4), "twice"), ("t_host_s\n1\n", "0 channels")],
)
def test_csv_that_is_none(tmp_path: Path, content: str, words: str) -> None:
    path = tmp_path / "x.csv"
    path.write_text(content)
    with pytest.raises(UlnaInputError, match=words), opened(path):
        pass


def test_no_file(tmp_path: Path) -> None:
    with pytest.raises(UlnaInputError, match="no such file"), opened(tmp_path / "nothing.csv"):
        pass
