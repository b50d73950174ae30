"""A campaign on two worker processes of this machine: shards on disk, and a second call that only reads them."""

import sys
import tempfile
import time
from pathlib import Path

import ahv


def main() -> None:
    """Fly a campaign twice; the second time its shards are read."""
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else tempfile.mkdtemp()) / "campaign"
    flights = {"members": 20_000, "t_end": 0.5, "dt": 0.01, "limit": {"alpha": (-0.02, 0.06)}, "shard_members": 4096}
    for what in ("flown", "read"):
        start = time.perf_counter()
        flown = ahv.campaign(ahv.sdcom, out=folder, workers=2, progress=False, **flights)
        print(f"{what} in {time.perf_counter() - start:.1f} s: {flown.members} members, digest {flown.digest[:16]}")
    print(flown)
    size = sum(file.stat().st_size for file in (folder / "shards").iterdir())
    print(f"{len(list((folder / 'shards').iterdir()))} shards, {size / flown.members:.0f} bytes a member")


if __name__ == "__main__":
    main()
