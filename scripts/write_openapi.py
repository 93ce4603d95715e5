"""Write the server's OpenAPI document to web/src/api/openapi.json, from which the browser's types are made.

With --check nothing is written; the exit code is 1 if the committed document is not what the server now offers.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from server.app.openapi import write_document

DOCUMENT = Path(__file__).resolve().parents[1] / "web" / "src" / "api" / "openapi.json"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true", help="only say whether the document is stale")
    args = parser.parse_args()
    text = write_document()
    if not args.check:
        DOCUMENT.write_text(text)
        print(f"{DOCUMENT}: {len(text)} characters")
        return 0
    if not DOCUMENT.is_file() or DOCUMENT.read_text() != text:
        print(f"{DOCUMENT} is not what the server offers: run `make api`, commit what it writes.", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
