"""Guesses: what is proposed of arms of known kinds, with reasons; and a source file that reads what was guessed at."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from ulna.live.guessing import guess
from ulna.live.source_file import load_source
from ulna.live.tables import FieldsTable


def pieces(lines: list[str], hz: float = 100.0) -> list[tuple[float, bytes]]:
    """As a serial line gives them: one begun before, the others cut."""
    stream = ("cut,1\n" + "".join(f"{line}\r\n" for line in lines)).encode()
    total = len(lines) / hz
    size = 37
    return [(total * at / len(stream), stream[at : at + size]) for at in range(0, len(stream), size)]


def test_an_arm_that_sends_counts_with_a_clock_and_a_prefix(tmp_path: Path) -> None:
    k = np.arange(300)
    lines = [f"POS,{10 * j},{1000 + j * j // 50},{(3900 + j) % 4096},{2048},{int(j > 250)}" for j in k]
    lines.insert(50, "# temperature 21.5")
    found = guess(pieces(lines), messages=False)
    assert found.decode == {
        "kind": "fields",
        "separator": ",",
        "prefix": "POS",
        "names": ["c1", "c2", "c3", "c4", "c5"],
        "time": "c1",
        "time_unit": "ms",
        "button": "c5",
    }
    assert found.map == {"channels": ["c2", "c3", "c4"], "unit": "counts", "counts_per_turn": 4096.0}
    assert all(each.why for each in found.fields)
    assert any("1 of 301 lines are something else" in reason for reason in found.reasons)
    path = tmp_path / "source.toml"
    path.write_text(found.toml("serial:/dev/ttyACM0"))
    file = load_source(path).file
    assert isinstance(file.decode, FieldsTable)
    assert file.map.counts_per_turn == 4096.0


@pytest.mark.parametrize(("scale", "unit"), [(1.0, "rad"), (57.3, "deg")])
@pytest.mark.parametrize("separator", ["  ", ";", "\t", ", "])
def test_decimals_by_any_separator(scale: float, unit: str, separator: str) -> None:
    q = scale * np.random.default_rng(1).uniform(-3, 3, (100, 6))
    found = guess(pieces([separator.join(f"{value:.5f}" for value in row) for row in q]), messages=False)
    assert (found.kind, found.map["unit"], len(found.fields)) == ("fields", unit, 6)
    assert {each.role for each in found.fields} == {"channel"}
    assert found.decode.get("separator", " ") == (separator.strip(" ") or " ")


def test_joint_states_as_messages() -> None:
    names = ["base", "elbow", "wrist"]
    heard = [
        (k / 50, json.dumps({"name": names, "position": [k / 100, -k / 90, 0.5], "header": {"seq": k}}).encode())
        for k in range(50)
    ]
    found = guess(heard, messages=True)
    assert found.decode == {"kind": "json", "values": ["position"], "joints": "name"}
    assert found.map == {"channels": names, "unit": "rad"}


@pytest.mark.parametrize(
    ("stream", "kind"),
    [(b"", "nothing"), (bytes(range(256)) * 20, "binary"), (b"hello\nworld\nagain\n", "nothing"), (b"12\n", "fields")],
)
def test_what_cannot_be_guessed_is_said(stream: bytes, kind: str) -> None:
    found = guess([(0.0, stream)], messages=False)
    assert found.kind == kind
    assert found.reasons


def test_random_bytes_never_raise() -> None:
    rng = np.random.default_rng(4)
    letters = np.frombuffer(b'0123456789,.;-+eE "{}[]:\r\nqPOS', dtype=np.uint8)
    for k in range(400):
        n = int(rng.integers(1, 200))
        data = rng.bytes(n) if k % 2 else bytes(rng.choice(letters, n))
        for messages in (False, True):
            found = guess([(0.0, data[: n // 2]), (1.0, data[n // 2 :])], messages)
            assert found.reasons
