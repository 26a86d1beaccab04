# SPDX-License-Identifier: Apache-2.0
"""Writes the result of a calibration as one HTML page without links to anything else."""
from __future__ import annotations

import html
import os
from typing import TYPE_CHECKING, Sequence

import numpy as np

if TYPE_CHECKING:
    from ._calibrate import Calibration

_STYLE = (
    "body{font:15px sans-serif;max-width:60em;margin:2em auto}"
    "td,th{padding:.2em 1em;text-align:right;border-bottom:1px solid #ccc}"
    "td:first-child,th:first-child{text-align:left}svg text{font:12px sans-serif}"
)
_WIDTH, _HEIGHT, _LEFT, _FOOT, _EDGE = 640, 260, 80, 36, 12


class _Plot:
    """A plot as SVG: axes with five marks each, lines and points."""

    def __init__(self, x: Sequence[float], y: Sequence[float], below: str, title: str) -> None:
        self._x, self._y = self._range(x), self._range(y)
        self._parts = [
            '<svg viewBox="0 0 %d %d" role="img"><title>%s</title>'
            % (_WIDTH, _HEIGHT, html.escape(title)),
            '<rect x="%d" y="%d" width="%d" height="%d" fill="none" stroke="#888"/>'
            % (_LEFT, _EDGE, _WIDTH - _LEFT - _EDGE, _HEIGHT - _FOOT - _EDGE),
        ]
        for value in np.linspace(*self._x, 5):
            self._text(*self.place(value, self._y[0]), "%.4g" % value, "middle", 0, 16)
        for value in np.linspace(*self._y, 5):
            self._text(*self.place(self._x[0], value), "%.4g" % value, "end", -6, 4)
        self._text((_WIDTH + _LEFT) / 2, _HEIGHT - 4, below, "middle")

    @staticmethod
    def _range(values: Sequence[float]) -> tuple[float, float]:
        low, high = float(np.min(values)), float(np.max(values))
        return (low, high) if high > low else (low - 1, high + 1)

    def place(self, x: float, y: float) -> tuple[float, float]:
        """Returns the place of a value on the page."""
        across = (x - self._x[0]) / (self._x[1] - self._x[0])
        up = (y - self._y[0]) / (self._y[1] - self._y[0])
        return (
            _LEFT + across * (_WIDTH - _LEFT - _EDGE),
            _HEIGHT - _FOOT - up * (_HEIGHT - _FOOT - _EDGE),
        )

    def _text(self, x, y, text, anchor, right=0, down=0):
        self._parts.append(
            '<text x="%.1f" y="%.1f" text-anchor="%s">%s</text>'
            % (x + right, y + down, anchor, html.escape(text))
        )

    def line(self, x: Sequence[float], y: Sequence[float], color: str, width: float) -> None:
        """Adds a line through points."""
        points = " ".join("%.1f,%.1f" % self.place(*one) for one in zip(x, y))
        self._parts.append(
            '<polyline points="%s" fill="none" stroke="%s" stroke-width="%.1f"/>'
            % (points, color, width)
        )

    def dots(self, x: Sequence[float], y: Sequence[float], color: str, size: float) -> None:
        """Adds a point for each pair."""
        for one in zip(x, y):
            self._parts.append(
                '<circle cx="%.1f" cy="%.1f" r="%.1f" fill="%s"/>'
                % (*self.place(*one), size, color)
            )

    def text(self) -> str:
        """Returns the SVG element."""
        return "".join(self._parts) + "</svg>"


def _table(result: Calibration) -> str:
    rows = "".join(
        "<tr><td>%s</td><td>%.4g</td><td>%.4g to %.4g</td></tr>"
        % (html.escape(name), best, low, high)
        for name, best, low, high in zip(result.names, result.best, result.low, result.high)
    )
    return "<table><tr><th>parameter</th><th>fitted</th><th>%d %% interval</th></tr>%s</table>" % (
        round(100 * result.level),
        rows,
    )


def _spread(result: Calibration) -> str:
    """Returns plots of each pair of parameters: simulated scenes and likely values."""
    out = []
    for i in range(len(result.names)):
        for j in range(i + 1, len(result.names)):
            x, y = result.points[:, i], result.points[:, j]
            title = "%s over %s" % (result.names[j], result.names[i])
            plot = _Plot(x, y, result.names[i], title)
            plot.dots(x, y, "#999", 3)
            plot.dots(result.likely[:, i], result.likely[:, j], "#1f77b4", 1.5)
            plot.dots([result.best[i]], [result.best[j]], "#d62728", 5)
            out.append("<h2>%s</h2>%s" % (html.escape(title), plot.text()))
    if not out:
        return ""
    legend = "Grey: simulated scenes in the last box. Blue: values drawn by their likelihood."
    return "".join(out) + "<p>%s Red: fitted values.</p>" % legend


def write_page(
    path: str | os.PathLike, result: Calibration, scene: str, bounds: np.ndarray
) -> None:
    """Writes the page of a calibration of `scene`; `bounds` is the box that was searched."""
    title = "Calibration of %s" % html.escape(scene)
    parts = [
        '<!DOCTYPE html><html lang="en"><meta charset="utf-8"><title>%s</title>' % title,
        "<style>%s</style><h1>%s</h1>%s" % (_STYLE, title, _table(result)),
        "<p>Misfit %.2g (about 1 for a good fit); %d simulated scenes.</p>"
        % (result.misfit, result.runs),
    ]
    for name, low, high, (least, most) in zip(result.names, result.low, result.high, bounds):
        # A likelihood that the box cuts off ends close to its edge.
        close = max(0.01 * (most - least), 0.1 * (high - low))
        if low - least < close or most - high < close:
            parts.append(
                "<p><b>%s reaches the edge of the searched box, %.4g to %.4g: widen it.</b></p>"
                % (html.escape(name), least, most)
            )
    for name, values in result.measured.items():
        fitted = result.fitted[name]
        plot = _Plot(result.times, np.concatenate([values, fitted]), "time [s]", name)
        plot.line(result.times, values, "#222", 1.0)
        plot.line(result.times, fitted, "#d62728", 1.5)
        parts.append("<h2>%s</h2>%s" % (html.escape(name), plot.text()))
    parts.append("<p>Black: measured. Red: the scene with the fitted values.</p>")
    parts.append(_spread(result))
    with open(path, "w", encoding="utf-8") as file:
        file.write("".join(parts) + "</html>\n")
