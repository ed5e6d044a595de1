"""The sheet of real photos and rendered beds."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest

from fairyring.app.bench import sheet
from fairyring.model.errors import FairyringError


def test_photos_come_first_and_whole_then_rows_of_beds(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sheet, "_beds", lambda: [np.full((72, 128, 3), 90, np.uint8)] * 4)
    (tmp_path / "images").mkdir()
    cv2.imwrite(str(tmp_path / "images" / "upright.png"), np.full((128, 72, 3), 200, np.uint8))
    sheet.draw_sheet(tmp_path / "sheet.png", real=tmp_path)
    drawn = np.asarray(cv2.imread(str(tmp_path / "sheet.png")))[..., 0]
    assert drawn.shape == (720, 2560)
    # 128 rows become 360, so the photo's 72 columns 202.5, in the middle of the first 640.
    assert (drawn[:360] == 200).sum(axis=1).min() in {202, 203}
    assert drawn[180, [210, 430, 700]].tolist() == [0, 0, 0]
    assert (drawn[360:] == 90).all()


def test_a_folder_without_photos_is_refused_with_a_sentence(tmp_path: Path) -> None:
    with pytest.raises(
        FairyringError, match=r"There are no photos in .*images; give a folder with images/\."
    ):
        sheet.draw_sheet(tmp_path / "sheet.png", real=tmp_path)


def test_a_sheet_that_cannot_be_written_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sheet, "_beds", lambda: [np.zeros((72, 128, 3), np.uint8)] * 4)
    with pytest.raises(FairyringError, match=r"cannot be written"):
        sheet.draw_sheet(tmp_path / "missing" / "sheet.png", real=None)
