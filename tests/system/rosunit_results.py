"""rosunit knows neither skips nor subtests. In its result file a skipped case is a passed one, and a failed subtest is
counted without its name and text. `record` adds both: the reason of the skip in the form of pytest and gtest, the
failure of the subtest to its case.
"""

import unittest
import xml.etree.ElementTree as ET
from typing import Any

from rosunit import xmlrunner


def record() -> None:
    """Acts on all result files that this process writes; a second call does nothing."""
    result: Any = xmlrunner._XMLTestResult
    if result.addSkip is not unittest.TestResult.addSkip:
        return
    stop_test = result.stopTest

    def add_skip(self: Any, test: unittest.TestCase, reason: str) -> None:
        unittest.TestResult.addSkip(self, test, reason)
        self.skip_reason = reason

    def add_subtest(self: Any, test: unittest.TestCase, subtest: unittest.TestCase, error: Any) -> None:
        unittest.TestResult.addSubTest(self, test, subtest, error)
        if error is not None:
            self._failure = (error[0], f"{subtest}: {error[1]}", error[2])

    def stop_and_note(self: Any, test: unittest.TestCase) -> None:
        stop_test(self, test)
        reason = self.__dict__.pop("skip_reason", None)
        if reason is not None:
            note_skip(self._tests[-1], reason)

    result.addSkip = add_skip
    result.addSubTest = add_subtest
    result.stopTest = stop_and_note


def note_skip(info: Any, reason: str) -> None:
    """`info`: rosunit's record of one case, which its method `xml` writes."""
    write = info.xml

    def write_skipped() -> ET.Element:
        case: ET.Element = write()
        ET.SubElement(case, "skipped", message=reason)
        return case

    info.xml = write_skipped
