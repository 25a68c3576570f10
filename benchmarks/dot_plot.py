"""Durations as dots on a logarithmic axis, in SVG, without packages."""
import math
from html import escape
from typing import NamedTuple, Optional

LABELS, PLOT, NOTES = 190, 460, 110  # widths
ROW, TITLE = 20, 34                  # heights
TOP, BOTTOM = 34, 30
INK, FAINT, GRID, ACCENT = "#333333", "#999999", "#e4e4e4", "#0b62a4"


class Dot(NamedTuple):
    label: str
    value: Optional[float]  # None: nothing to draw but the note
    note: str
    at_least: bool = False  # the value is only a lower bound


def text(x, y, words, colour=INK, anchor="start", weight="normal"):
    return (f'<text x="{x:.1f}" y="{y:.1f}" fill="{colour}" text-anchor="{anchor}" '
            f'font-weight="{weight}">{escape(words)}</text>')


def line(x0, y0, x1, y1, colour):
    return f'<line x1="{x0:.1f}" y1="{y0:.1f}" x2="{x1:.1f}" y2="{y1:.1f}" stroke="{colour}"/>'


def mark(x, y, colour, at_least):
    if at_least:
        return f'<path d="M{x - 4:.1f} {y - 5:.1f}l9 5l-9 5z" fill="white" stroke="{colour}"/>'
    return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="4.5" fill="{colour}"/>'


def decades(groups):
    """Powers of ten around all values."""
    values = [dot.value for _, dots in groups for dot in dots if dot.value]
    lowest, highest = min(values, default=1.0), max(values, default=1.0)
    first = math.floor(math.log10(lowest))
    return first, max(first + 1, math.ceil(math.log10(highest)))


def draw_row(dot, reference, x_of, y, accent):
    """One dot, with a line to it from the reference's: on this axis its length is the ratio."""
    colour = ACCENT if accent else FAINT
    yield text(LABELS - 12, y + 4, dot.label, ACCENT if accent else INK, "end",
               "bold" if accent else "normal")
    if not dot.value:
        yield text(LABELS + 6, y + 4, dot.note)
        return
    x = x_of(dot.value)
    if reference:
        yield line(x_of(reference), y, x, y, colour)
    yield mark(x, y, colour, dot.at_least)
    yield text(x + 10, y + 4, dot.note)


def draw_axis(first, last, x_of, bottom, unit):
    for power in range(first, last + 1):
        x = x_of(10.0 ** power)
        yield line(x, TOP, x, bottom, GRID)
        yield text(x, bottom + 16, f"{10.0 ** power:g} {unit}", anchor="middle")


def dot_plot(heading, groups, unit):
    """`groups`: pairs of a title and its Dots, of which the first is the one to compare with."""
    first, last = decades(groups)

    def x_of(value):
        return LABELS + PLOT * (math.log10(value) - first) / (last - first)

    rows, y = [], TOP
    for title, dots in groups:
        rows.append(text(12, y + 20, title, weight="bold"))
        y += TITLE
        for dot in dots:
            rows += draw_row(dot, dots[0].value, x_of, y + ROW / 2, dot is dots[0])
            y += ROW
    width, height = LABELS + PLOT + NOTES, y + BOTTOM
    return "\n".join([
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
        f'viewBox="0 0 {width} {height}" font-family="sans-serif" font-size="12">',
        "<style>text { paint-order: stroke; stroke: white; stroke-width: 3px }</style>",
        f'<rect width="{width}" height="{height}" fill="white"/>',
        text(12, 20, heading, weight="bold"),
        *draw_axis(first, last, x_of, y + 4, unit), *rows, "</svg>", ""])
