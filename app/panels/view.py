"""What is drawn over the photo, and how the photo looks."""

from __future__ import annotations

from app.gateway.messages import Layers
from app.panels.callbacks import Redraw, person_did
from app.session import LAYERS, Session
from app.workspace import Workspace

LABELS = {
    "photo": "Photo",
    "outline": "Visible outlines",
    "fill": "Filled masks",
    "whole": "Whole outlines",
    "centre": "Centres",
    "label": "Labels",
    "prediction": "Predictions",
}


def build(_workspace: Workspace, session: Session) -> Redraw:
    """Check boxes for the layers, sliders for the photo."""
    gui = session.client.gui
    boxes = {
        name: gui.add_checkbox(f"{number}  {LABELS[name]}", shown, hint=f"Key {number}")
        for number, (name, shown) in enumerate(LAYERS.items(), start=1)
    }
    brightness = gui.add_slider("Brightness", 0.2, 3.0, 0.05, 1.0)
    contrast = gui.add_slider("Contrast", 0.2, 3.0, 0.05, 1.0)
    reset = gui.add_button("Reset brightness and contrast")

    async def changed() -> None:
        visible = {name: box.value for name, box in boxes.items()}
        session.layers = Layers(visible=visible, brightness=brightness.value, contrast=contrast.value)
        session.send(session.layers)

    async def put_back() -> None:
        brightness.value = contrast.value = 1.0
        await changed()

    async def redraw() -> None:
        for name, box in boxes.items():
            box.value = session.layers.visible[name]

    for control in (*boxes.values(), brightness, contrast):
        control.on_update(person_did(session, changed))
    reset.on_click(person_did(session, put_back))
    return redraw


def toggle(session: Session, layer: str) -> None:
    """Shows or hides a layer, as a key in the editor asks."""
    if layer in LAYERS:
        shown = session.layers.visible
        session.layers = Layers(
            visible=shown | {layer: not shown[layer]},
            brightness=session.layers.brightness,
            contrast=session.layers.contrast,
        )
        session.send(session.layers)
        session.refresh("layers")
