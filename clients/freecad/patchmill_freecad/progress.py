"""The progress of a call, and its end when the user wants it.

While a document is recomputed, FreeCAD shows the progress bar of the recomputation alone, and passes over
all others and their Esc (Base::SequencerLauncher). So the window has a dialog of its own.
"""
from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, Protocol

import FreeCAD as App
import patchmill as pm

from .problem import Cancelled

STEPS = 1000
SHOWN_AFTER_S = 0.5
CANCELLED = "The job was cancelled. Nothing of it is valid."


class Bar(Protocol):
    def __call__(self, progress: pm.Progress) -> None: ...

    def close(self) -> None: ...


class Dialog:
    """A dialog with a bar and a button. Esc presses the button."""

    def __init__(self, text: str) -> None:
        import FreeCADGui as Gui
        from PySide import QtCore, QtGui

        self._application, self._began = QtGui.QApplication, time.monotonic()
        self._dialog = QtGui.QProgressDialog(f"{text}...", "Cancel", 0, STEPS, Gui.getMainWindow())
        self._dialog.setWindowTitle("Patchmill")
        # Nothing else takes input meanwhile: the document must not change.
        self._dialog.setWindowModality(QtCore.Qt.ApplicationModal)
        self._dialog.setAutoClose(False)
        self._dialog.setAutoReset(False)
        self._dialog.setMinimumDuration(24 * 3600 * 1000)  # this class shows it
        self._text = text

    def __call__(self, progress: pm.Progress) -> None:
        if time.monotonic() - self._began < SHOWN_AFTER_S:
            return
        left = "" if progress.remaining_s is None else f", {progress.remaining_s:.0f} s left"
        self._dialog.setLabelText(f"{self._text}: {progress.stage}{left}")
        self._dialog.show()
        self._dialog.setValue(int(progress.fraction * STEPS))
        self._application.processEvents()
        if self._dialog.wasCanceled():
            raise Cancelled(CANCELLED)

    def close(self) -> None:
        self._dialog.reset()
        self._dialog.close()
        self._dialog.deleteLater()


class Indicator:
    """FreeCAD's own bar, where there is no window."""

    def __init__(self, text: str) -> None:
        self._indicator: Any = App.Base.ProgressIndicator()
        self._indicator.start(f"{text}...", STEPS)
        self._step, self._stage = 0, ""

    def __call__(self, progress: pm.Progress) -> None:
        if progress.stage != self._stage:
            self._stage, self._step = progress.stage, 0
            self._indicator.stop()
            self._indicator.start(f"Patchmill: {progress.stage}...", STEPS)
        # One step each time at least: only a step looks whether the user wants to stop.
        target = max(self._step + 1, int(progress.fraction * STEPS))
        while self._step < min(target, STEPS):
            self._step += 1
            try:
                self._indicator.next(True)
            except (App.Base.FreeCADAbort, Exception) as stop:
                raise Cancelled(CANCELLED) from stop

    def close(self) -> None:
        self._indicator.stop()


@contextmanager
def progress_bar(text: str) -> Iterator[Bar]:
    bar: Bar = Dialog(text) if App.GuiUp else Indicator(text)
    try:
        yield bar
    finally:
        bar.close()
