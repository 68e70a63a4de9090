"""How long the report of SUBOFF is before its appendix."""

from __future__ import annotations

import html
import re

import pytest

from coeflab.report.content import core
from coeflab.report.document import Document
from coeflab.report.formats import REPORTERS
from coeflab.report.tables.results import sources_of_numbers
from coeflab.study.study import Study


@pytest.mark.slow
def test_words_of_the_core(suboff: Study, suboff_document: Document) -> None:
    """At most 5,000 words on the page, and 6,000 with its numbers; pictures are not counted."""
    page = REPORTERS.load("html").render(core(suboff_document, sources_of_numbers(suboff)))["report.html"].decode()
    page = re.sub(r"<(script|style|svg|head)\b.*?</\1>", " ", page, flags=re.DOTALL)
    page = re.sub(r"</(?:p|li|tr|td|th|h\d|caption|dt|dd|summary|figcaption|div)>", " ", page)
    words = html.unescape(re.sub(r"<[^>]+>", "", page)).split()
    assert len(words) <= 6_000
    assert sum(any(map(str.isalpha, word)) for word in words) <= 5_000
