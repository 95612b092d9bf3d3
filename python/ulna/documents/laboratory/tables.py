"""The tables of a laboratory file, `ulna-lab/1`."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from ulna.documents.laboratory.texts import Country, Day, Language, Line, Link, Text
from ulna.formats.models import Strict
from ulna.formats.units import LengthUnit
from ulna.verification.limits import LimitValue

Issuer = Literal["manufacturer", "calibrationLaboratory", "customer", "owner", "other"]


class ReplacedTable(Strict):
    """An earlier certificate that this one takes the place of."""

    identifier: Line
    """Of the earlier certificate."""
    change: Literal["amended", "substituted"]


class CertificateTable(Strict):
    """The certificate itself."""

    identifier: Line
    """Unique, given by the laboratory; never given twice."""
    country: Country
    """Where it is issued."""
    begin: Day
    """First day of the calibration."""
    end: Day
    """Last day of the calibration."""
    location: Literal["laboratory", "customer", "laboratoryBranch", "customerBranch", "other"]
    """Where the calibration was done."""
    issued: Day | None = None
    """Day of issue."""
    received: Day | None = None
    """Day on which the item was received."""
    order: Line | None = None
    """The laboratory's number of the order."""
    replaces: ReplacedTable | None = None


class Address(Strict):
    """Where somebody is; the country and at least the city."""

    country: Country
    city: Line
    street: Line | None = None
    """With the number of the house."""
    postcode: Line | None = None
    state: Line | None = None


class ContactTable(Strict):
    """Somebody who can be written to."""

    name: Text
    address: Address
    email: Line | None = None
    phone: Line | None = None
    web: Link | None = None


class AccreditationTable(Strict):
    """By whom the laboratory is accredited, where it is."""

    body: Line
    """Who accredits."""
    number: Line
    """Of the accreditation."""
    standard: Line | None = None
    """After which the laboratory is accredited, such as "ISO/IEC 17025:2017"."""


class LaboratoryTable(ContactTable):
    """The calibration laboratory."""

    code: Line | None = None
    """The laboratory's own code, where it has one."""
    accreditation: AccreditationTable | None = None
    logo: Line | None = None
    """Path of a picture (PNG, JPEG, SVG) for the letterhead, relative to this file; printed certificates only."""


class PersonTable(Strict):
    """Somebody who answers for the certificate."""

    name: Line
    role: Text
    main_signer: bool = False
    """One signs first."""
    email: Line | None = None
    phone: Line | None = None


class CapabilityTable(Strict):
    """What the laboratory is accredited to state: its calibration and measurement capability (CMC)."""

    unit: LengthUnit
    """Of the lengths below."""
    figure: Annotated[dict[str, LimitValue], Field(min_length=1)]
    """The smallest expanded uncertainty, with a coverage probability of about 95 %, of a figure of a test by its short
    name: U, or { a, b } of one that grows with the length."""


class IdentificationTable(Strict):
    """A number by which somebody knows a thing."""

    issuer: Issuer
    """Who gave it."""
    value: Line
    name: Text | None = None
    """What kind of number it is."""


class ItemTable(Strict):
    """The arm that was calibrated."""

    name: Text
    """What kind of thing it is."""
    manufacturer: Line
    model: Line
    serial: Line
    """The manufacturer's serial number."""
    description: Text | None = None
    condition: Text | None = None
    """In what condition it was received."""
    identifications: list[IdentificationTable] = Field(default_factory=list)
    """Further numbers."""
    scanner: Line | None = None
    """What the arm carries beside its probe, such as a laser line scanner: certificates say that it was not tested."""


class EquipmentTable(Strict):
    """A standard that the calibration leans on, such as the ball bar."""

    name: Text
    serial: Line
    manufacturer: Line | None = None
    model: Line | None = None
    certificate: Line | None = None
    """Identifier of its own calibration certificate."""
    certified_by: Line | None = None
    """Who issued that."""
    artefacts: list[Line] = Field(default_factory=list)
    """What it is called in the study and in the verify file: certificates say with which u it was used."""


class TemperatureCondition(Strict):
    """How warm it was: value and u, or low and high."""

    unit: Literal["°C", "K"]
    value: float | None = None
    u: Annotated[float, Field(ge=0)] | None = None
    """Standard uncertainty of value."""
    low: float | None = None
    high: float | None = None


class HumidityCondition(Strict):
    """Relative humidity: value and u, or low and high."""

    unit: Literal["%"]
    value: Annotated[float, Field(ge=0, le=100)] | None = None
    u: Annotated[float, Field(ge=0)] | None = None
    """Standard uncertainty of value."""
    low: Annotated[float, Field(ge=0, le=100)] | None = None
    high: Annotated[float, Field(ge=0, le=100)] | None = None


class EnvironmentTable(Strict):
    """Under what conditions was measured."""

    temperature: TemperatureCondition
    humidity: HumidityCondition | None = None
    remark: Text | None = None


class TraceabilityTable(Strict):
    """How the results are traceable to the SI."""

    statement: Text


class MethodTable(Strict):
    """A procedure that the laboratory followed."""

    name: Text
    description: Text | None = None
    norms: list[Line] = Field(default_factory=list)
    """Standards, each with its year."""
    references: list[Line] = Field(default_factory=list)
    """Other documents, such as the laboratory's own instruction."""


class LaboratoryFile(Strict):
    """A laboratory, its customer, the item and the conditions: `ulna-lab/1`."""

    format: Literal["ulna-lab/1"]
    languages: Annotated[list[Language], Field(min_length=1)]
    """Of the certificate, the main one first. A text is a string, or a table with every one of these languages."""
    certificate: CertificateTable
    laboratory: LaboratoryTable
    person: Annotated[list[PersonTable], Field(min_length=1)]
    """Who answers for it; exactly one has main_signer = true."""
    customer: ContactTable
    item: ItemTable
    environment: EnvironmentTable
    equipment: list[EquipmentTable] = Field(default_factory=list)
    traceability: TraceabilityTable | None = None
    cmc: CapabilityTable | None = None
    method: list[MethodTable] = Field(default_factory=list)
    remarks: list[Text] = Field(default_factory=list)
