"""Recorded scenes for the 3D view: positions as 16-bit steps of the box that holds them, too coarse to read strains off."""

from __future__ import annotations

import base64
import json
from pathlib import Path

import numpy as np

from parts.result_file import Json, ResultError

STEPS = 65535


def recorded(folder: Path) -> Json:
    """A folder that `bench film` fills (harness/film/recording.h)."""
    try:
        header = json.loads((folder / "film.json").read_text(encoding="utf-8"))
        x = np.fromfile(folder / "film.f32", dtype="<f4").reshape(-1, 3)
        strains = (folder / "film.u8").read_bytes()
    except (OSError, ValueError) as error:
        raise ResultError(f"{folder} holds no recording: {error}") from error
    low, high = x.min(axis=0), x.max(axis=0)
    span = np.where(high > low, high - low, 1)
    whole = np.rint((x - low) / span * STEPS).astype("<u2")
    kept = ("scene", "frames_per_second", "vertices", "triangles", "edges", "strain_unit", "body", "body_triangles", "body_poses")
    return {**{key: header[key] for key in kept},
            "takes": [{key: take[key] for key in ("solver", "label", "strain_limit", "frames", "detail")} for take in header["takes"]],
            "low": low.tolist(), "span": span.tolist(), "positions": base64.b64encode(whole.tobytes()).decode(),
            "strains": base64.b64encode(strains).decode()}
