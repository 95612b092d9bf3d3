"""The tables of `ulna-source/1`: where readings come from, how they are written, and what an arm cannot do."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from ulna.arm.stated import PositiveEach
from ulna.formats.models import OneOf, Strict
from ulna.formats.numbers import Amount, Positive
from ulna.live.samples import MOST_CHANNELS

Names = Annotated[list[Annotated[str, Field(min_length=1, max_length=80)]], Field(min_length=1)]
TimeUnit = Literal["s", "ms", "us", "ns"]


class DecodeTable(Strict):
    """What all ways of writing have."""

    kind: str
    names: Names | None = None
    """Of all numbers in the order in which they are sent; "-" is not read."""
    time: Annotated[str, Field(min_length=1)] | None = None
    """The name (JSON: the path) of the device's clock."""
    time_unit: TimeUnit = "ms"
    """Of that clock."""
    button: Annotated[str, Field(min_length=1)] | None = None
    """The name (JSON: the path) of the arm's button; anything but 0 is down."""


class FieldsTable(DecodeTable):
    """Lines of numbers."""

    kind: Literal["fields"] = "fields"
    separator: Annotated[str, Field(min_length=1, max_length=8)] | None = None
    """Between the fields; any comma, semicolon, tab or blanks where it is not given."""
    prefix: Annotated[str, Field(min_length=1, max_length=80)] | None = None
    """The first field of the lines that are read; lines without it are no readings."""


class JsonTable(DecodeTable):
    """JSON objects."""

    kind: Literal["json"]
    values: Names
    """Paths of the numbers, or of lists of them: "msg.position", "axes.0.angle"."""
    joints: Annotated[str, Field(min_length=1)] | None = None
    """Path of a list that names them, in any order."""


class BinaryTable(DecodeTable):
    """Packets."""

    kind: Literal["binary"]
    struct: Annotated[str, Field(min_length=1, max_length=80)]
    """The numbers, as Python's struct writes it: "<I7f" is a counter and seven floats, lowest byte first."""
    sync: Annotated[str, Field(pattern=r"^([0-9A-Fa-f]{2}){1,8}$")] | None = None
    """Bytes before each packet, hexadecimal: "AA55"; not needed where each message is a packet."""
    checksum: Literal["sum8", "xor8", "crc16-modbus", "crc16-ccitt"] | None = None
    """Behind the numbers, made of them."""


DECODERS: dict[str, type[DecodeTable]] = {"fields": FieldsTable, "json": JsonTable, "binary": BinaryTable}
"""Kind → its table."""
AnyDecode = Annotated[DecodeTable, OneOf(DECODERS)]


class MapTable(Strict):
    """Which channel is which joint. Signs and zeros stay in the arm file."""

    channels: Names | None = None
    """The channels of q1, q2, …, from the base to the probe; all, as they come, where it is not given."""
    unit: Literal["deg", "rad", "counts"] | None = None
    """Of the channels; needed where the source does not say it."""
    counts_per_turn: (
        Annotated[float, Field(ge=2)]
        | Annotated[list[Annotated[float, Field(ge=2)]], Field(min_length=1, max_length=MOST_CHANNELS)]
        | None
    ) = None
    """Of each encoder, or of all."""
    wraps: bool = True
    """Whether encoders begin again after a turn (4095 → 0) and turns are counted."""


class LimitsTable(Strict):
    """What a stream does not do, unless something is wrong."""

    speed: Positive = 10.0
    """rad/s: the fastest that a hand turns a joint."""
    gap: Positive | None = None
    """s without a reading; five periods, and at least 0.05 s, where it is not given."""


class StillTable(Strict):
    """When the tip stands still."""

    seconds: Annotated[float, Field(gt=0, le=60)] | None = None
    """How long it must; where it is not given, as long as it takes to tell a slow hand from one that rests, by the
    arm's noise and the stream's rate."""
    spread: Positive | None = None
    """mm: standard deviation of the tip; from the arm's noise where it is not given."""
    drift: Positive | None = None
    """mm from the first to the last; from the arm's noise where it is not given."""
    noise: PositiveEach | None = None
    """Standard deviation of one sample of each encoder, held still, in `map.unit`; as the plan or the calibration has
    that of a reading where it is not given."""
    rearm: Amount = 2.0
    """mm that the tip must have moved before it may be still anew."""


class TriggerTable(Strict):
    """What takes a touch."""

    by: Literal["key", "button", "still"] = "key"
    """A key (a pedal is one), the arm's button, or that the tip stands still."""


class SourceFile(Strict):
    """A source: `ulna-source/1`."""

    format: Literal["ulna-source/1"]
    url: Annotated[str, Field(min_length=1, max_length=2000)]
    """Where readings come from: serial:/dev/ttyACM0?baud=115200, tcp://host:port, … (docs/live.md)."""
    decode: AnyDecode | None = None
    """How they are written; lines of numbers, or what the url's kind says, where it is not given."""
    map: MapTable = Field(default_factory=MapTable)
    limits: LimitsTable = Field(default_factory=LimitsTable)
    still: StillTable = Field(default_factory=StillTable)
    trigger: TriggerTable = Field(default_factory=TriggerTable)
