# SPDX-License-Identifier: BSD-3-Clause
"""Every message of the filters is in Documentation/Troubleshooting.md, word for word.

TestTroubleshooting.py <source folder>
"""
from pathlib import Path
import re
import sys
import unittest

SOURCE = Path(sys.argv.pop(1))
COMMENT = re.compile(r"//.*")
BETWEEN_PARTS = re.compile(r'"\s*\n\s*"')
LITERAL = re.compile(r'"((?:[^"\\\n]|\\.)*)"')
FEWEST_WORDS = 3  # shorter texts are names, or parts without a meaning of their own


def one_line(text):
    return " ".join(text.replace('\\"', '"').split())


def messages():
    """The texts of the filters' sources, with the file each is from."""
    for folder in ("Filters", "Plugin/Filters"):
        for path in sorted((SOURCE / folder).glob("*.cxx")):
            code = BETWEEN_PARTS.sub("", COMMENT.sub("", path.read_text(encoding="utf-8")))
            for literal in LITERAL.findall(code):
                text = one_line(literal)
                if len(text.split()) >= FEWEST_WORDS:
                    yield path.name, text


class TestTroubleshooting(unittest.TestCase):
    def test_has_every_message(self):
        page = one_line((SOURCE / "Documentation" / "Troubleshooting.md").read_text("utf-8"))
        found = list(messages())
        self.assertGreater(len(found), 150)
        self.assertEqual([f"{file}: {text}" for file, text in found if text not in page], [])


if __name__ == "__main__":
    unittest.main()
