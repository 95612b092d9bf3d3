"""What goes into the record, and whether it is what was written."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from ulna.serve.contract.model import Asked, Name, Said, Sentence, Sha256
from ulna.serve.contract.records import Day, IssuedInfo, Long


class AddAsked(Asked):
    """Files of the desk, all or none; what each is, is found out."""

    files: Annotated[list[Sha256], Field(min_length=1, max_length=50)]
    arm: Name | None = None
    """As registered; None: as the file says."""
    at: Day | None = None
    """When it was measured."""
    artefacts: Annotated[list[Name], Field(max_length=50, default_factory=list)]
    """Of the record, on which it rests."""
    register_arm: bool = False
    """An arm that is not registered yet is registered first."""


class FiledInfo(Said):
    """What became of a file."""

    sha256: Sha256
    name: str
    arm: str
    kind: str
    new: bool
    """False: it was there already."""


class Added(Said):
    """All of them."""

    filed: list[FiledInfo]


class CertifiedAsked(Asked):
    """One value of a certificate."""

    quantity: Name
    """As studies call it: length, diameter."""
    value_mm: Annotated[float, Field(gt=0, le=1e6)]
    u_mm: Annotated[float, Field(ge=0, le=1e6)]
    """Standard uncertainty."""


class CertifyAsked(Asked):
    """What a certificate says of an artefact, which is registered where it is not yet."""

    artefact: Name
    values: Annotated[list[CertifiedAsked], Field(min_length=1, max_length=50)]
    number: Name | None = None
    by: Name | None = None
    valid_from: Day | None = None
    valid_to: Day | None = None
    temperature_c: Annotated[float, Field(ge=-100, le=200)] | None = None
    expansion_per_k: Annotated[float, Field(ge=-1e-3, le=1e-3)] | None = None
    expansion_u_per_k: Annotated[float, Field(ge=0, le=1e-3)] | None = None
    certificate: Sha256 | None = None
    """The file, on the desk."""


class WithdrawAsked(Asked):
    """What shall count no longer: it is kept."""

    subject: Annotated[str, Field(min_length=1, max_length=200)]
    """The number of a certificate, or the SHA-256 of a filed file."""
    reason: Long


class Entry(Said):
    """What was entered."""

    number: int
    subject: str


class Entries(Said):
    """All of them."""

    entries: list[Entry]


class Verified(Said):
    """Whether the record is what was written."""

    good: bool
    entries: int
    files: int
    rows: int
    head: str
    """Of the chain, to be noted elsewhere."""
    wrong: list[Sentence]
    remarks: list[Sentence]


class IssueAsked(Asked):
    """A certificate of a filed calibration."""

    result: Annotated[str, Field(min_length=1, max_length=200)]
    """Its SHA-256; or an arm, whose last calibration is meant."""
    laboratory: Sha256
    """A laboratory file of the desk."""
    beside: Annotated[list[Sha256], Field(max_length=20, default_factory=list)]
    """What it names: its logo."""
    verification: Annotated[list[Sha256], Field(max_length=20, default_factory=list)]
    """Filed tests."""
    number: Name | None = None
    """None: the next of the record's series."""
    form: Literal["pdf", "dcc"] = "pdf"
    language: Literal["en", "de", "zh"] = "en"
    approved_by: Name | None = None
    supersedes: Name | None = None
    reason: Long | None = None
    """Why the earlier one is superseded."""


class IssuedNow(Said):
    """What was issued."""

    number: str
    arm: str
    sha256: Sha256
    """On the desk."""
    name: str
    head: str
    """Of the record, as it stands on the certificate."""


class Certificates(Said):
    """The newest first."""

    certificates: list[IssuedInfo]
