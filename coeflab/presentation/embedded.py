"""Numbers and scenes of figures as JSON that may stand inside an HTML page."""

from __future__ import annotations

import base64
import json
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coeflab.presentation.document import Axis, Figure, Layer, Panel, Scene, Series
from coeflab.presentation.lettering import label, unit_label
from coeflab.presentation.printable import visible

STEPS = 65535
KINDS = {1: "points", 2: "lines", 3: "triangles"}


def panels_json(figure: Figure) -> str:
    """What a page needs to tell the values of a drawing; empty where there is nothing to tell."""
    told = [p for p in figure.panels if p.series]
    return _inside_a_page({"title": visible(figure.title), "panels": [_panel(p) for p in told]}) if told else ""


def scene_json(scene: Scene) -> str:
    """What a page needs to draw a scene.

    Places are whole numbers of two bytes between the ends of the axes, little-endian, in base64.
    """
    content = {
        "body": scene.is_body,
        "axes": [_axis(a) for a in scene.axes],
        "layers": [_layer(layer, scene.axes) for layer in scene.layers],
    }
    return _inside_a_page(content)


def _inside_a_page(content: dict[str, Any]) -> str:
    """JSON without the characters that could end a script element."""
    text = json.dumps(content, separators=(",", ":"), ensure_ascii=False, allow_nan=False)
    return text.replace("&", "\\u0026").replace("<", "\\u003c").replace(">", "\\u003e")


def _panel(panel: Panel) -> dict[str, Any]:
    out: dict[str, Any] = {
        "frame": panel.frame,
        "across": panel.across,
        "up": panel.up,
        "names": [label(panel.name_across), label(panel.name_up)],
        "units": [unit_label(panel.unit_across), unit_label(panel.unit_up)],
        "grouped": panel.grouped_by,
        "series": [_series(s) for s in panel.series],
    }
    if panel.bars:
        out["bars"] = panel.bars
    return out


def _series(series: Series) -> dict[str, Any]:
    out: dict[str, Any] = {"key": series.key, "name": label(series.name), "x": series.x, "y": series.y}
    if series.notes:
        out["notes"] = [label(n) for n in series.notes]
    if series.groups:
        out["groups"] = series.groups
    if series.is_curve:
        out["curve"] = True
    return out


def _axis(axis: Axis) -> dict[str, Any]:
    return {
        "name": label(axis.name),
        "unit": unit_label(axis.unit),
        "ends": axis.ends,
        "marks": axis.marks,
        "texts": [label(t) for t in axis.texts],
    }


def _layer(layer: Layer, axes: tuple[Axis, ...]) -> dict[str, Any]:
    low, high = np.array([a.ends for a in axes]).T
    share = np.clip((np.asarray(layer.places) - low) / (high - low), 0.0, 1.0)
    wide = "<u2" if len(layer.places) <= STEPS else "<u4"
    corners = layer.index.shape[1] if layer.index.ndim == 2 else 1
    return {
        "name": label(layer.name),
        "kind": KINDS[corners],
        "colour": layer.colour,
        "opacity": layer.opacity,
        "label": label(layer.label),
        "notes": [label(n) for n in layer.notes],
        "wide": wide[-1],
        "places": _packed(np.rint(share * STEPS).astype("<u2")),
        "index": _packed(layer.index.astype(wide)),
    }


def _packed(values: NDArray[Any]) -> str:
    return base64.b64encode(values.tobytes()).decode()
