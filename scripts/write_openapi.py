"""Write what the API says of itself: its OpenAPI document, from which the browser's types are made, and all requests.

The files are web/src/api/openapi.json and web/src/api/requests.md. With --check nothing is written; the exit code is 1
if a committed file is not what the server now offers.
"""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

from server.app.openapi import write_document
from server.app.requests_page import write_requests_page

FOLDER = Path(__file__).resolve().parents[1] / "web" / "src" / "api"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true", help="only say whether a file is stale")
    args = parser.parse_args()
    document = write_document()
    files = {FOLDER / "openapi.json": document, FOLDER / "requests.md": write_requests_page(json.loads(document))}
    stale = [path for path, text in files.items() if not path.is_file() or path.read_text() != text]
    for path in stale:
        if args.check:
            print(f"{path} is not what the server offers: run `make api`, commit what it writes.", file=sys.stderr)
        else:
            path.write_text(files[path])
            print(f"{path}: {len(files[path])} characters")
    return 1 if args.check and stale else 0


if __name__ == "__main__":
    sys.exit(main())
