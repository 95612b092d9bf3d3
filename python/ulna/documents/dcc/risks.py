"""What a decision risks, beside its statement of conformity: probabilities as quantities of their own."""

from __future__ import annotations

from collections.abc import Mapping

from ulna.documents.dcc.quantities import quantity, real, real_list
from ulna.documents.dcc.sheet import Element, Sheet
from ulna.documents.sections.risk import process
from ulna.verification.result_file import GlobalRiskTable, RiskTable


def risks(sheet: Sheet, data: Element, risk: RiskTable) -> None:
    """In the manner of JCGM 106:2012; global ones only where it was stated what is made."""
    specific = {
        "dcc.conformity-probability": risk.conformity,
        "dcc.specific-risk": risk.specific,
        "dcc.consumer-at-most": risk.consumer_at_most,
        "dcc.producer-at-most": risk.producer_at_most,
    }
    _probabilities(sheet, data, specific)
    if risk.of_all is not None:
        _of_all(sheet, data, risk.of_all)


def _probabilities(sheet: Sheet, data: Element, values: Mapping[str, float | None]) -> None:
    """By the keys of their names; those that there are."""
    for key, value in values.items():
        if value is not None:
            real(sheet, quantity(sheet, data, sheet.own(key)), value, "1")


def _of_all(sheet: Sheet, data: Element, of_all: GlobalRiskTable) -> None:
    shares = {
        "dcc.global-consumer": of_all.consumer,
        "dcc.global-producer": of_all.producer,
        "dcc.global-withheld": of_all.withheld,
        "dcc.global-undecided": of_all.undecided,
    }
    _probabilities(sheet, data, shares)
    made = of_all.process
    said = sheet.spoken(lambda words, _: process(made, words))
    one = quantity(sheet, data, sheet.own("dcc.process"), description=said)
    real_list(sheet, one, ["mean", "deviation"], [made.mean, made.deviation], ["mm", "mm"])
