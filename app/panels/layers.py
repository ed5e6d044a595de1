"""The view: which layers are drawn over the photo, and its brightness and contrast."""

from __future__ import annotations

from typing import Any

import msgspec
import viser

from fairyring.app.editor_commands import LAYERS
from fairyring.app.live.session import Session
from fairyring.app.live.workspace import Workspace
from fairyring.app.panels.callbacks import Redraw, person_did


def build(_workspace: Workspace, session: Session) -> Redraw:
    """Builds check boxes for the layers and sliders for the photo."""
    gui = session.client.gui
    boxes = {
        layer.name: gui.add_checkbox(f"{layer.key}  {layer.words}", layer.shown, hint=f"Key {layer.key}")
        for layer in LAYERS.values()
    }
    brightness = gui.add_slider("Brightness", 0.2, 3.0, 0.05, 1.0)
    contrast = gui.add_slider("Contrast", 0.2, 3.0, 0.05, 1.0)
    reset = gui.add_button("Reset brightness and contrast")

    def follow(name: str, box: viser.GuiCheckboxHandle) -> None:
        async def changed() -> None:
            _show(session, visible=session.layers.visible | {name: box.value})

        box.on_update(person_did(session, changed))

    async def slid() -> None:
        _show(session, brightness=brightness.value, contrast=contrast.value)

    async def put_back() -> None:
        brightness.value = contrast.value = 1.0
        await slid()

    async def redraw() -> None:
        for name, box in boxes.items():
            box.value = session.layers.visible[name]

    for name, box in boxes.items():
        follow(name, box)
    for slider in (brightness, contrast):
        slider.on_update(person_did(session, slid))
    reset.on_click(person_did(session, put_back))
    return redraw


def toggle(session: Session, layer: str) -> None:
    """Shows or hides a layer, as a key in the editor asks."""
    shown = session.layers.visible
    if layer in shown:
        _show(session, visible=shown | {layer: not shown[layer]})
        session.refresh("layers")


def _show(session: Session, **changes: Any) -> None:
    """Sends the editor the layers with these changes."""
    session.layers = msgspec.structs.replace(session.layers, **changes)
    session.send(session.layers)
