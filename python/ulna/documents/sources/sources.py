"""All sources: a new one is its file and a row here."""

from __future__ import annotations

from typing import Any

from ulna.documents.sources.cross_validation import CROSS_VALIDATION
from ulna.documents.sources.evaluation import EVALUATION
from ulna.documents.sources.laboratory import LABORATORY
from ulna.documents.sources.source import Source
from ulna.documents.sources.study import STUDY
from ulna.documents.sources.verification import VERIFICATION

#: name → source, in the order in which documents name their files
SOURCES: dict[str, Source[Any]] = {
    each.name: each for each in (STUDY, LABORATORY, VERIFICATION, CROSS_VALIDATION, EVALUATION)
}
