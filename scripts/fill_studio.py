"""Fill a data folder with one of everything, and an admin with a token, for schemathesis against a served studio.

    python scripts/fill_studio.py FOLDER

`FOLDER/data` is the data folder, `FOLDER/token` the token, `FOLDER/schemathesis.toml` the settings with the ids of what
is there. docs/development.md says what to do with them.
"""

from __future__ import annotations

import argparse
import json
import secrets
import sys
from pathlib import Path

from fastapi.testclient import TestClient

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from server.access.logins import set_password  # noqa: E402
from server.access.models import Account, TokenRow  # noqa: E402
from server.access.secrets import hash_secret  # noqa: E402
from server.app import create_app  # noqa: E402
from server.settings import Settings  # noqa: E402
from tests.server.app.full_studio import LEFT_OUT, Sender, fill  # noqa: E402
from tests.server.conftest import BASE_URL, RENDERED_FRAMES, GeneratedHand  # noqa: E402
from tracker import (  # noqa: E402
    Registrar,
    TrackOptions,
    add_commands,
    join_chunks,
    load_annotations,
    load_sequence,
    save_registration,
    start_tracking,
    track_frames,
    untrained_hand,
)
from tracker.capture.scan import load_scan  # noqa: E402

PASSWORD = "four words in a row"
"""Of the account Admin."""
NAMES = ("content_key", "camera", "frame")


def run_tracker(*command: str) -> None:
    parser = argparse.ArgumentParser()
    add_commands(parser.add_subparsers(required=True))
    args = parser.parse_args(command)
    assert args.run(args) == 0


def make_track(recording: Path, folder: Path) -> Path:
    run_tracker("synthesize", "--motion", "open-close", "--frames", f"0:{RENDERED_FRAMES}", "--out", str(recording))
    sequence, frames = load_sequence(recording), range(12)
    options = TrackOptions(calibrate=False, last_frame=frames[-1])
    setup, state = start_tracking(sequence, options, None, load_annotations(recording / "annotations.json"))
    join_chunks(sequence, setup, [track_frames(sequence, setup, state, frames)[1]]).save(folder)
    return folder


def make_hand(folder: Path) -> GeneratedHand:
    made = ("--subjects", "1", "--poses", "flat_spread", "--sides", "right", "--points", "3000", "--forearm", "no")
    run_tracker("synthesize-scans", *made, "--out", str(folder))
    path = next(folder.rglob("*.ply")).rename(folder / "hand.ply")
    scan = load_scan(path)
    found = Registrar(untrained_hand("right")).register(scan)
    save_registration(found, folder)
    return GeneratedHand(scan, found, folder)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, help="a folder that is not there yet")
    folder = parser.parse_args().folder.absolute()
    if folder.exists():
        parser.error(f"{folder} is there already; give a folder that is not there yet, or delete it")
    folder.mkdir(parents=True)
    track, hand = make_track(folder / "recording", folder / "track"), make_hand(folder / "hand")
    app = create_app(Settings(data_dir=folder / "data"))
    with TestClient(app, base_url=BASE_URL) as client:
        known = fill(app, Sender(client, lambda *_: None), folder / "recording", track, hand).parameters
        secret = secrets.token_urlsafe(24)
        with app.state.database.writing() as session:
            admin = Account(name="Admin", role="admin")
            session.add(admin)
            session.flush()
            hashed = hash_secret("token", secret)
            session.add(TokenRow(account_id=admin.id, name="schemathesis", secret_hash=hashed, may_write=True))
        set_password(app.state.database, admin.id, "Admin", PASSWORD)
    ids = {name: value for name, value in known.items() if name.endswith("_id") or name in NAMES}
    lines = [f"{name} = {json.dumps(value)}" for name, value in ids.items() if value is not LEFT_OUT]
    (folder / "token").write_text(secret)
    settings = (ROOT / "schemathesis.toml").read_text()
    (folder / "schemathesis.toml").write_text("\n".join(["[parameters]", *lines, "", settings]))


if __name__ == "__main__":
    main()
