# SPDX-License-Identifier: BSD-3-Clause
"""Puts measured tables and plots into the documentation: python3 -m ipia_benchmarks.document FOLDER

FOLDER is that of compare.sh and scaling.sh. Sections of Documentation/Benchmarks.md between
<!-- name --> and <!-- end of name --> become the tables of that name.
"""
import pathlib
import re
import shutil
import sys

DOCUMENTATION = pathlib.Path(__file__).resolve().parents[3] / "Documentation"


def renew(text, name, tables):
    """The text with the section of that name replaced; headings go one level down."""
    body = re.sub(r"^#", "##", tables.split("\n", 1)[1].strip(), flags=re.M)
    return re.sub(rf"(<!-- {name} -->\n).*?(<!-- end of {name} -->)",
                  lambda found: f"{found[1]}\n{body}\n\n{found[2]}", text, flags=re.S)


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    page = DOCUMENTATION / "Benchmarks.md"
    for name in ("comparison", "scaling"):
        results = pathlib.Path(sys.argv[1]) / name
        if results.is_dir():
            page.write_text(renew(page.read_text(), name, (results / f"{name}.md").read_text()))
            for picture in results.glob("*.png"):
                shutil.copy(picture, DOCUMENTATION / "Images")


if __name__ == "__main__":
    main()
