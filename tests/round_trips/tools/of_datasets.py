"""Loads an export with HF datasets, saves it as Arrow, loads that: ``of_datasets.py EXPORT OUT``."""

import json
import sys
from pathlib import Path

from datasets import load_dataset, load_from_disk

export, out = map(Path, sys.argv[1:])
written = {}
for part in ("images", "categories", "annotations"):
    file = str(export / "instances.json")
    loaded = load_dataset("json", data_files=file, field=part, split="train", cache_dir=str(out / "cache"))
    loaded.save_to_disk(str(out / part))
    rows = load_from_disk(str(out / part)).to_list()
    # Arrow has every key in every row.
    written[part] = [{key: value for key, value in row.items() if value is not None} for row in rows]
# Texts that look like times have become times.
(out / "labels.json").write_text(json.dumps(written, default=str))
